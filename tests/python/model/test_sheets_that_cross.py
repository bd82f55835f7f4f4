"""Sheets that overlap, are turned the wrong way, or go through each other."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform import _core
from umform.errors import InvalidValue, ModelError
from umform.model.contact.sheets import SheetContact


def strip(x=0.0, z=0.0, cells=(5, 2), length=10.0, thickness=1.0, turn=0.0, cell="hex8"):
    c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    flat = uf.mesh.strip(length, 4.0, thickness, cells, cell=cell)
    Q = np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]])
    return flat.transformed(lambda X: X @ Q.T + [x, 0.0, z])


def model_of(a, b, one="upper of a", other="lower of b", **options):
    mesh = uf.mesh.together(a=a, b=b)
    model = uf.Model(mesh, "ANS3DEAS", material=uf.SVK(E=210e3, nu=0.0))
    model.sheet_contact(one, other, name="stack", **options)
    return model


def check(model):
    """Hold both sheets, and check the model as a run does."""
    for sheet in "ab":
        model.fix(f"x0 of {sheet}")
    model.system.check()


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("turn", [0.0, 30.0])
def test_the_translation_in_the_message_removes_the_overlap(turn, turned):
    c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    b = strip(-0.8 * s, 0.8 * c, turn=turn)
    faces = ("lower of b", "upper of a") if turned else ("upper of a", "lower of b")
    with pytest.raises(ModelError, match="overlap at the start") as caught:
        check(model_of(strip(turn=turn), b, *faces))
    assert "0.2 deep" in str(caught.value)
    way = 0.2 * np.array([-s, 0.0, c]) * (-1.0 if turned else 1.0)
    assert f"move the second sheet by ({', '.join(f'{x:.4g}' for x in way + 0.0)})" in str(caught.value)


def test_a_sheet_that_goes_through_another_at_the_start_is_refused():
    crossed = strip(2.0, -4.0, turn=60.0)
    with pytest.raises(ModelError, match="goes through another at the start"):
        check(model_of(strip(), crossed))
    check(model_of(strip(), strip(2.0, 2.0, turn=60.0)))


def folded(radius, turn):
    """A strip with its upper face inside, bent by an angle in degrees about a radius of its mid-surface."""

    def bent(X):
        s, y, z = X.T
        angle = np.clip((s - 8.0) / radius, 0.0, np.radians(turn))
        beyond = np.maximum(s - 8.0 - radius * np.radians(turn), 0.0)
        x = np.minimum(s, 8.0) + (radius - z) * np.sin(angle) + beyond * np.cos(angle)
        return np.column_stack([x, y, z + (radius - z) * (1.0 - np.cos(angle)) + beyond * np.sin(angle)])

    return uf.mesh.strip(24.0, 2.0, 1.0, (48, 1)).transformed(bent)


@pytest.mark.parametrize("turn", [180.0, 215.0])
def test_a_sheet_folded_through_itself_is_refused(turn):
    mesh = folded(1.6, turn)
    model = uf.Model(mesh, "ANS3DEAS", material=uf.SVK(E=210e3, nu=0.3))
    model.self_contact("upper", name="inside")
    model.fix("x0")
    if turn < 200.0:
        model.system.check()
    else:
        with pytest.raises(ModelError, match="at the start") as caught:
            model.system.check()
        assert "inside" in str(caught.value)


def test_the_drift_of_a_closing_fold_falls_with_the_square_of_the_increments():
    drifts, of_touch = [], []
    for steps in (30, 60):
        mesh = folded(2.0, 180.0)
        steel = uf.J2(E=210e3, nu=0.3, hardening=uf.Swift(500.0, 0.01, 0.2))
        model = uf.Model(mesh, "ANS3DEAS", material=steel)
        model.self_contact("upper", name="inside", cells=3)
        model.fix("x0")
        model.fix("x1", "y")
        end = model.prescribe("x1", "z", "end")
        result = uf.solve(model, uf.Move(end, -3.3, steps=steps), progress=False)
        drift, touch = result.balance().drift, int(np.argmax(result["inside_active"] > 0))
        drifts.append(abs(drift[-1]))
        of_touch.append(abs(drift[touch] - drift[touch - 1]))
    assert 0 < drifts[1] < 0.45 * drifts[0] < 0.005
    assert 0 < of_touch[1] < 0.35 * of_touch[0] < 0.0005  # the increment of the first touch


def test_outer_faces_of_a_stack_are_refused():
    with pytest.raises(InvalidValue, match="look away from each other"):
        model_of(strip(), strip(z=1.0), "lower of a", "upper of b")
    with pytest.raises(InvalidValue, match="look away from each other"):
        model_of(strip(), strip(z=-1.2))  # the sheets in the wrong order
    coil = uf.Model(strip(), "ANS3DEAS", material=uf.SVK(E=210e3, nu=0.0))
    coil.sheet_contact("lower", "upper")  # a sheet that is wound up touches itself so


def crossings(facet, other, x, y, deepest=0.5):
    ids = [np.array([one], dtype=np.int32) for one in (facet, other)]
    x, y = (tuple(np.ascontiguousarray(one, dtype=float).ravel() for one in pair) for pair in (x, y))
    return _core.sheet_crossings(ids[0], x, ids[1], y, deepest)


@pytest.mark.parametrize("nodes", [4, 9])
def test_a_place_crosses_a_facet_that_it_is_over(nodes):
    half = uf.mesh.mesh.FACE_NODES[:nodes]
    facet = np.column_stack([half, np.zeros(nodes)])  # looks up
    above = facet[:, [0, 1, 2]] * 0.2
    points = np.concatenate([above, facet])
    mine, its = np.arange(nodes), np.arange(nodes, 2 * nodes)

    def moved(way):
        x = points.copy()
        x[:nodes] += way
        return x

    def found(before, now, deepest=0.5):
        return crossings(mine, its, (moved(before), moved(now)), (points, points), deepest)

    places, depths = found([0.0, 0.0, 0.3], [0.0, 0.0, -1.7])
    assert depths == pytest.approx([1.7])
    assert places[0, 2] == pytest.approx(-1.7)
    assert len(found([0.0, 0.0, 0.3], [0.0, 0.0, -0.4])[1]) == 0  # contact finds it
    lowered = points - [0.0, 0.0, 1.0]  # through where the place was
    behind = crossings(mine, its, (moved([0.0, 0.0, -0.6]), moved([0.0, 0.0, -1.7])), (points, lowered), 0.5)
    assert len(behind[1]) == 0  # it was behind
    assert len(found([5.0, 0.0, 0.3], [5.0, 0.0, -1.7])[1]) == 0  # beside
    assert len(found([5.0, 0.0, 0.3], [0.0, 0.0, -1.7])[1]) == 0  # around the edge: over it only when it is below
    assert len(found([1.5, 0.0, 2.0], [0.0, 0.0, -0.7])[1]) == 1  # it came from the side, from above
    still, going = moved([0.0, 0.0, 0.3]), moved([0.0, 0.0, 0.3])
    going[nodes:] += [0.0, 0.0, 2.0]
    assert crossings(mine, its, (still, going), (still, going))[1] == pytest.approx([1.7])  # the facet moves


def pressed_down(steps, **options):
    """A strip that is clamped at one end; a force would bend the other through a block, which lies 0.3 below it."""
    model = model_of(strip(7.0, -1.3, cells=(5, 2), length=5.0), strip(cells=(10, 2)), **options)
    model.fix("a")
    model.fix("x0 of b")
    force = model.force("x1 of b", (0.0, 0.0, -1.0), "force")
    return uf.solve(model, uf.Move(force, 600.0, steps=steps), progress=False)


@pytest.mark.parametrize("options", [{"points": 3}, {"cells": 3}], ids=str)
def test_a_sheet_does_not_pass_through_another_in_one_increment(options, monkeypatch):
    result = pressed_down(1, **options)
    assert len(result) > 2  # the increment was cut
    assert result["stack_active"][-1] > 0
    assert any("through" in cause for cause in result.timing.attempts.causes)
    fine = pressed_down(24, **options)
    assert result["stack_fz"][-1] == pytest.approx(fine["stack_fz"][-1], rel=1e-5)
    monkeypatch.setattr(SheetContact, "through", lambda self, u: None)
    passed = pressed_down(1, **options)
    assert len(passed) == 2
    assert passed["stack_active"][-1] == 0

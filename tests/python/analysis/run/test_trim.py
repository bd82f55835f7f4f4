"""Trimming between two stages: what is left keeps its state, and the forces of what was cut off go to zero."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.analysis.run.stages import continued
from umform.errors import EmptySet, InvalidValue, MeshError
from umform.mesh import strip

STEEL = uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(yield_stress=160.0, modulus=500.0))
BEYOND_13 = [(13.0, -1.0), (13.0, 3.0)]


def bend(before=None):
    """A cantilever that is bent beyond yielding and let go."""
    model = uf.Model(strip(20.0, 2.0, 1.0, (10, 1)), material=STEEL)
    model.fix("x0")
    load = model.force("x1", (0.0, 0.0, -1.0), "load")
    return model, [uf.Move(load, 1.25, steps=4), uf.Move(load, 0.0, steps=1)]


def trim(before):
    """Its free end is cut off."""
    part = uf.Trim(BEYOND_13, formed=False).of(before)
    part.model.fix("x0", here=True)
    return part.model, uf.Move(part.model.unbalanced("cut"), 0.0, steps=2)


@pytest.fixture(scope="module")
def bent():
    return uf.solve(*bend(), frames=0)


def test_a_part_on_which_nothing_acts_stays_as_it_was(bent):
    part = uf.Trim(BEYOND_13, formed=False, edge="elements").of(bent)
    whole = bent.model
    np.testing.assert_array_equal(part.model.bodies.only.block.state, whole.bodies.only.block.state[part.cells])
    np.testing.assert_array_equal(part.model.u, whole.u.reshape(-1, 3)[part.nodes].ravel())
    made = part.model
    made.fix("x0", here=True)
    step = uf.Move(made.unbalanced("cut"), 0.0, steps=2)
    result = uf.solve(made, step, frames=0)
    before = whole.u.reshape(-1, 3)[part.nodes].ravel()
    assert np.abs(before).max() > 0.1  # it was bent for good
    np.testing.assert_allclose(made.u, before, atol=1e-7 * np.abs(before).max())
    assert result["plastic_work"][-1] == pytest.approx(result["plastic_work"][0], rel=1e-12)


def test_energies_of_the_part_and_of_what_was_cut_off_make_the_whole(bent):
    part = uf.Trim(lambda x, y: x - 4.5, formed=False, edge="elements").of(bent)  # through the metal that has yielded
    assert len(part.cells) == 2 and part.edge_distance == pytest.approx(0.5)
    part.model.fix("x0", here=True)
    result = uf.solve(part.model, uf.Move(part.model.unbalanced("cut"), 0.0, steps=2), frames=0)
    gone = part.removed_energies
    assert gone.plastic > 0.03 * bent["plastic_work"][-1]
    assert result["plastic_work"][0] + gone.plastic == pytest.approx(bent["plastic_work"][-1], rel=1e-12)
    assert result["elastic_energy"][0] + gone.elastic == pytest.approx(bent["elastic_energy"][-1], rel=1e-10)
    assert "2 cells are left" in str(part)


def stretched(length, cells):
    """A strip under uniform tension beyond yielding."""
    model = uf.Model(strip(length, 2.0, 1.0, (cells, 2)), material=STEEL)
    for side, normal in (("x0", "x"), ("y0", "y"), ("lower", "z")):
        model.symmetry(side, normal)
    return model, uf.Move(model.prescribe("x1", "x", "pull"), 0.004 * length, steps=3)


def test_a_strip_under_tension_springs_back_as_one_that_was_short_from_the_first():
    long = uf.solve(*stretched(10.0, 5), frames=0)
    part = uf.Trim([(4.0, -1.0), (4.0, 3.0)], formed=False).of(long)
    model = part.model
    for side, normal in (("x0", "x"), ("y0", "y"), ("lower", "z")):
        model.symmetry(side, normal)
    cut = model.unbalanced("cut")
    pull = long["pull_force"][-1]
    assert cut.vector.reshape(-1, 3)[:, 0].sum() == pytest.approx(pull, rel=1e-9)
    uf.solve(model, uf.Move(cut, 0.0, steps=2), frames=0)
    short, draw = stretched(4.0, 2)
    uf.solve(short, [draw, uf.Release(draw.control)], frames=0)
    np.testing.assert_allclose(model.u, short.u, atol=1e-6 * np.abs(short.u).max())
    assert np.abs(short.u).max() > 0.01


def test_elastic_metal_is_as_new_without_the_plastic_metal_that_kept_it_stressed():
    """Two strips side by side are stretched and let go: tension in one, compression in the other."""
    sheet = strip(8.0, 4.0, 1.0, (4, 4))
    spring = uf.Body(material=uf.SVK(E=210e3, nu=0.3), cells=lambda x, y, z: y < 2.0, name="spring")
    soft = uf.Body(material=STEEL, cells=lambda x, y, z: y > 2.0, name="soft")
    model = uf.Model(sheet, bodies=[spring, soft])
    for side, normal in (("x0", "x"), ("y0", "y"), ("lower", "z")):
        model.symmetry(side, normal)
    pull = model.prescribe("x1", "x", "pull")
    held = uf.solve(model, [uf.Move(pull, 0.04, steps=3), uf.Release(pull)], frames=0)
    assert held["elastic_energy"][-1] > 0.02 * held["elastic_energy"].max()  # residual stress
    part = uf.Trim([(-1.0, 2.0), (9.0, 2.0)]).of(model)  # the wrong side of the line at first
    assert [body.name for body in part.model.bodies] == ["soft"]
    part = uf.Trim([(9.0, 2.0), (-1.0, 2.0)]).of(model)
    assert [body.name for body in part.model.bodies] == ["spring"]
    rest = part.model
    for side, normal in (("x0", "x"), ("y0", "y"), ("lower", "z")):
        rest.symmetry(side, normal)
    result = uf.solve(rest, uf.Move(rest.unbalanced("cut"), 0.0, steps=2), frames=0)
    assert np.abs(rest.u).max() < 1e-8
    assert result["elastic_energy"][0] > 0.1 * held["elastic_energy"][-1]
    assert abs(result["elastic_energy"][-1]) < 1e-9 * result["elastic_energy"][0]
    balance = result.balance()
    assert np.abs(balance.drift).max() < 1e-4


def test_a_hole_by_a_circle_and_stacks_that_stay_together():
    sheet = uf.mesh.plate(8.0, 8.0, 0.5, (8, 8), layers=2)
    model = uf.Model(sheet, material=uf.SVK(E=210e3, nu=0.3))
    part = uf.Trim(uf.Profile.circle((4.0, 4.0), 2.0, hole=True), edge="elements").of(model)
    gone = np.setdiff1d(np.arange(128), part.cells)
    centres = sheet.points[sheet.connectivity[gone]].mean(axis=1)
    assert len(gone) == 24 and (np.hypot(*(centres[:, :2] - 4.0).T) < 2.0).all()
    assert len(part.mesh.faces["cut"]) == 2 * 16
    assert part.edge_distance == pytest.approx(max(2.0 - np.sqrt(2.0), np.sqrt(5.0) - 2.0, 0.0), abs=1e-9)


def test_stages_with_a_cut_are_taken_up_from_their_checkpoints(tmp_path, same_state):
    stages = [uf.Stage("bend", bend), uf.Stage("trim", trim)]
    expected = uf.solve_stages(stages, frames=0)

    def stopped(before):
        model, step = trim(before)
        done = []

        def stop(fraction):
            if fraction > 0.6 and not done:
                done.append(True)
                raise KeyboardInterrupt
            return 1.0 - fraction

        return model, uf.Move(step.control, stop, steps=2)

    with pytest.raises(KeyboardInterrupt):
        uf.solve_stages([stages[0], uf.Stage("trim", stopped)], frames=0, checkpoints=tmp_path, every=0.0)
    (tmp_path / "2-trim.h5").unlink(missing_ok=True)
    again = uf.solve_stages(stages, frames=0, checkpoints=tmp_path, every=0.0)
    once_more = uf.solve_stages(stages, frames=0, checkpoints=tmp_path, every=0.0)
    for other in (again, once_more):
        assert same_state(other["trim"].model.system.snapshot(), expected["trim"].model.system.snapshot())


def test_the_next_tools_form_the_part_on(bent):
    part = uf.Trim(BEYOND_13, formed=False).of(bent)
    model = part.model
    rest = model.hold_rigid(name="rest")
    clamp = model.fix("x0", here=True)
    cut = model.unbalanced("cut")
    place = model.positions
    tip = place[model.mesh.nodes("cut")]
    x, z = float(tip[:, 0].mean()), float(tip[:, 2].min())
    bar = model.contact("lower", uf.Cylinder(centre=(x - 1.5, 0, z - 3.0), axis="y", radius=2.0), name="bar")
    lift = model.drive(bar, "z", "lift")
    steps = [uf.Move(cut, 0.0, steps=1), uf.Move(lift, 3.0, steps=6), uf.Free([bar, clamp], on=rest, steps=3)]
    result = uf.solve(model, steps, frames=0)
    assert result["bar_active"].max() > 0
    assert result["plastic_work"][-1] > 1.2 * result["plastic_work"][0]  # it was bent back beyond yielding
    free = model.evaluate(model.system.x).residual
    assert np.abs(free).max() < 1e-6 * np.abs(result["lift_force"]).max()  # no force acts on it any more


def test_what_cannot_be_trimmed_is_refused(bent):
    with pytest.raises(EmptySet, match="cuts nothing off"):
        uf.Trim([(30.0, -1.0), (30.0, 3.0)]).of(bent)
    with pytest.raises(EmptySet, match="removes the whole sheet"):
        uf.Trim([(30.0, 3.0), (30.0, -1.0)]).of(bent)
    with pytest.raises(MeshError, match="pieces"):
        uf.Trim(uf.Profile.from_corners([(6, -1), (10, -1), (10, 3), (6, 3)]).reversed(), formed=False).of(bent)
    with pytest.raises(InvalidValue, match="view along"):
        uf.Trim(BEYOND_13, view="r")
    with pytest.raises(InvalidValue, match="two corners"):
        uf.Trim([(1.0, 2.0)])
    with pytest.raises(InvalidValue, match="two corners"):
        uf.Trim("x1")
    with pytest.raises(InvalidValue, match="finite number"):
        uf.Trim(lambda x, y: 1.0).of(bent)
    part = uf.Trim(BEYOND_13, formed=False).of(bent)
    with pytest.raises(EmptySet, match="no node") as caught:
        part.model.fix("x1", here=True)
    assert "cut off" in str(caught.value)
    with pytest.raises(InvalidValue, match="mesh and the bodies"):
        continued(part.model, bent)
    part.model.fix(lambda x, y, z: x > 11.0)  # bent down, but held where it was before
    with pytest.raises(InvalidValue, match="elsewhere than it is") as caught:
        part.model.unbalanced()
    assert "here=True" in str(caught.value)


def plate(cells=(12, 10)):
    """A flat plate at rest."""
    model = uf.Model(strip(float(cells[0]), float(cells[1]), 0.5, cells, layers=2), material=STEEL)
    model.rest()
    return model


def test_cells_of_a_slanting_cut_that_hang_by_an_edge_are_cut_off_too_and_named():
    def tooth(x, y):
        """Left of x = 8; but at y = 5.5 the cell left of it goes, and that right of it stays: it has edges only."""
        row = (y > 5.0) & (y < 6.0)
        return np.where(np.where(row, (x < 7.0) | ((x > 8.0) & (x < 9.0)), x < 8.0), -1.0, 1.0)

    part = uf.Trim(tooth, formed=False).of(plate())
    assert part.dropped == 2 and len(part.cells) == 2 * (80 - 1)
    assert "2 more are cut off, which hung by an edge" in str(part)
    assert uf.Trim(lambda x, y: x - 8.0, formed=False).of(plate()).dropped == 0


def test_halves_that_hang_together_by_an_edge_are_refused():
    with pytest.raises(MeshError, match="hang together by an edge or a node"):
        uf.Trim(lambda x, y: np.where((x < 6.0) == (y < 5.0), -1.0, 1.0), formed=False).of(plate())

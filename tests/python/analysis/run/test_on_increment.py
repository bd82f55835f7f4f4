"""A function of the user after each increment, and the warning where tangents of the user are wrong."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.analysis.steps.own_parts import linear_rate
from umform.results.records import Iteration

STEEL = uf.J2(E=206e3, nu=0.3, hardening=uf.Swift(565.3, 0.0071, 0.259))


def bent(law=STEEL):
    model = uf.Model(uf.mesh.strip(20.0, 2.0, 1.0, (10, 1)), material=law, thickness_points=4)
    model.fix("x0")
    return model, model.prescribe("x1_lower", "z", name="tip")


def steps(tip):
    return [uf.Move(tip, -4.0, steps=4), uf.Release(tip, steps=5)]


def test_it_is_called_after_each_increment_and_changes_nothing():
    model, tip = bent()
    plain = uf.solve(model, steps(tip), progress=False)
    other, tip = bent()
    seen = []

    def look(result):
        assert result.model is other
        seen.append((len(result.rows), result.rows[-1]["tip"], uf.fields.point_fields(other).eqps.max()))
        other.evaluate(other.u * 1.001)  # beside the state; the run goes on from the converged one

    watched = uf.solve(other, steps(tip), progress=False, on_increment=look)
    assert [rows for rows, _, _ in seen] == list(range(2, len(plain.rows) + 1))
    assert [value for _, value, _ in seen] == list(plain["tip"][1:])
    assert seen[3][2] > seen[0][2] > 0.0
    np.testing.assert_array_equal(other.u, model.u)
    for column in ("tip_force", "iterations", "plastic_work"):
        np.testing.assert_array_equal(watched[column], plain[column])


def test_an_exception_in_it_ends_the_run():
    model, tip = bent()
    with pytest.raises(uf.errors.InvalidValue, match="a function of the result"):
        uf.solve(model, steps(tip), progress=False, on_increment=3)
    assert not model.u.any()

    def enough(result):
        if result.rows[-1]["tip"] < -1.6:
            raise StopIteration("bent enough")

    with pytest.raises(StopIteration) as stopped:
        uf.solve(model, steps(tip), progress=False, on_increment=enough)
    assert stopped.value.result["tip"][-1] == -2.0
    assert tip.value == -2.0
    with pytest.raises(TypeError) as caught:
        uf.solve(model, uf.Move(tip, -2.1, steps=1), progress=False, on_increment=lambda: None)
    assert "called with the result so far" in caught.value.__notes__[0]


@pytest.mark.parametrize("rows", [2, 5])
def test_a_stopped_arc_goes_on_along_the_same_path(rows, tmp_path):
    def shallow_arch():
        def rise(X):
            return X + np.outer(0.02 * X[:, 0] * (20.0 - X[:, 0]), (0.0, 0.0, 1.0))

        model = uf.Model(uf.mesh.strip(20.0, 2.0, 0.3, (10, 1)).transformed(rise), material=uf.SVK(E=2e5, nu=0.3))
        for end in ("x0", "x1"):
            model.hinge(end, "xz")
        model.fix(lambda x, y, z: x > -1.0, "y")
        return model, uf.Arc(model.force(lambda x, y, z: abs(x - 10.0) < 1e-6, (0.0, 0.0, -1.0), "f"), to=8.0, most=15)

    whole, again = uf.solve(*shallow_arch(), progress=False), stopped(shallow_arch, rows, tmp_path)
    np.testing.assert_array_equal(again["f"], whole["f"])
    assert again.events == whole.events


def test_an_arc_whose_end_is_not_known_has_no_note_of_it():
    model = uf.Model(uf.mesh.strip(20.0, 2.0, 1.0, (4, 1)), material=uf.SVK(E=2e5, nu=0.3))
    model.fix("x0")
    load = model.force("x1", (0.0, 0.0, -1.0), "f")

    def fails(model):
        raise RuntimeError

    with pytest.raises(RuntimeError) as caught:
        uf.solve(model, uf.Arc(load, to=1.0, until=fails), progress=False)
    assert caught.value.result.events == []


def test_a_run_that_is_stopped_at_the_end_of_a_step_keeps_its_notes(tmp_path):
    def pressed():
        model = uf.Model(uf.mesh.strip(20.0, 2.0, 1.0, (6, 1)), material=uf.SVK(E=2e5, nu=0.3))
        model.fix("x0")
        force = model.press(model.contact("upper", uf.Cylinder((15.0, 0.0, 5.8), "y", 5.0), penalty=2e3), "z", "f")
        return model, [uf.Close(force, -20.0), uf.Release(force)]

    whole = uf.solve(*pressed(), progress=False)
    assert len(whole.events) == 2
    for step in (1, 2):
        rows = int(np.flatnonzero(whole["step"] == step)[-1]) + 1
        assert stopped(pressed, rows, tmp_path).events == whole.events


def stopped(build, rows, folder):
    """A run that a function ends at a row, and that is resumed."""
    path = folder / f"{rows}.h5"

    def stop(result):
        if len(result) == rows:
            raise StopIteration

    with pytest.raises(StopIteration):
        uf.solve(*build(), progress=False, checkpoint=path, every=0.0, on_increment=stop)
    return uf.resume(path, *build(), progress=False)


def test_of_open_runs_and_resumed_ones(tmp_path):
    model, tip = bent()
    seen = []
    run = uf.OpenRun(model, on_increment=lambda result: seen.append(result["tip"][-1]))
    run.take(uf.Move(tip, -0.5, steps=2))
    bent_so_far = run.mark()
    run.take(uf.Move(tip, -1.0, steps=2))
    run.go_back(bent_so_far)
    run.take(uf.Release(tip, steps=5))
    assert seen[:4] == [-0.25, -0.5, -0.75, -1.0]
    assert seen[4] == pytest.approx(-0.4)

    def stops(result):
        assert len(result.rows) < 4, "here"

    model, tip = bent()
    path = tmp_path / "run.chk.h5"
    with pytest.raises(AssertionError, match="here"):
        uf.solve(model, steps(tip), progress=False, checkpoint=path, every=0.0, on_increment=stops)
    again, tip = bent()
    seen.clear()
    each = lambda result: seen.append(len(result.rows))  # noqa: E731
    result = uf.resume(path, again, steps(tip), progress=False, on_increment=each)
    assert seen[-1] == len(result.rows)
    assert seen[0] > 2


# Tangents of the user ---------------------------------------------------------------------------------------


def of_hooke(factor):
    """A law with hardening by the largest strain, whose tangent is too stiff by a factor."""
    C = np.diag([2e5] * 3 + [8e4] * 3)

    def law(strain, history):
        size = 1.0 + 40.0 * np.einsum("qi,qi->q", strain, strain)
        tangent = size[:, None, None] * C + 80.0 * np.einsum("qi,qj->qij", strain @ C, strain)
        return size[:, None] * (strain @ C), factor * 0.5 * (tangent + np.swapaxes(tangent, 1, 2)), history

    return uf.UserLaw(law, name="own")


def test_a_wrong_tangent_of_the_user_is_warned_of():
    options = uf.NewtonOptions(max_iterations=60, line_search=False, mixed=False)
    for factor, warns in ((1.0, False), (1.6, True)):
        model, tip = bent(of_hooke(factor))
        result = uf.solve(model, uf.Move(tip, 0.2, steps=4), progress=False, options=options)
        found = [text for text in result.warnings if "check_law compares the tangent of your law" in text]
        assert len(found) == warns
        if warns:
            assert "converges slowly in 3 of 3 increments" in found[0]


def test_rates():
    def iterations(*residuals, entered=0, step_length=1.0):
        last = len(residuals) - 1
        return [
            Iteration(k, r, 1e-3, 0.0, entered * (k == last), 0, step_length if k == last else 1.0, 0, 0.0)
            for k, r in enumerate(residuals)
        ]

    slow = [0.4**k for k in range(9)]
    assert linear_rate(iterations(*slow)) == pytest.approx(0.4)
    assert linear_rate(iterations(*slow[:7])) is None
    assert linear_rate(iterations(*slow[:8], 1e-12)) is None
    assert linear_rate(iterations(*slow, entered=1)) is None
    assert linear_rate(iterations(*slow, step_length=0.5)) is None

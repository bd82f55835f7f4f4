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

    def enough(result):
        if result.rows[-1]["tip"] < -1.6:
            raise StopIteration("bent enough")

    with pytest.raises(StopIteration) as stopped:
        uf.solve(model, steps(tip), progress=False, on_increment=enough)
    assert stopped.value.result["tip"][-1] == -2.0
    assert tip.value == -2.0


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

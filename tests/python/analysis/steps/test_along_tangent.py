"""Elastic sheets without contact are extrapolated along the tangent at the end of the last increment. eq. (5.133)"""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.analysis.newton.newton import Newton
from umform.analysis.newton.strategy_statistics import StrategyStatistics
from umform.analysis.steps import increment
from umform.model.terms.term import Found, Global, Term
from umform.surfaces import Plane

LENGTH, THICKNESS, MODULUS = 10.0, 0.1, 1e5


def clamped(cells=20, material=None):
    """A thin strip, clamped at one end."""
    mesh = uf.mesh.strip(LENGTH, 1.0, THICKNESS, (cells, 1))
    model = uf.Model(mesh, "EAS3DEAS", material=material or uf.SVK(E=MODULUS, nu=0.0), tie_E33=True)
    model.fix("x0")
    return model


def loaded():
    """With a force at its end and a pressure below, which bend it far."""
    model = clamped()
    nodes = model.mesh.nodes("x1")
    tip = model.force(nodes, (0.0, 0.0, 1.0 / len(nodes)), "tip")
    return model, uf.Move([tip, model.pressure("lower")], [0.5, 0.02], steps=8)


def lifted(**options):
    """Whose end is lifted by two thirds of its length."""
    model = clamped(**options)
    return model, uf.Move(model.prescribe("x1_lower", "z", name="end"), 6.5, steps=12)


def rolled():
    """Rolled to a circle, in steps of 18 degrees, by a couple that turns with its end."""
    model = clamped(32)
    size = 2.0 * np.pi * MODULUS * THICKNESS**2 / 12.0 / LENGTH
    loads, ways = [], []
    for side, sign in (("lower", 1.0), ("upper", -1.0)):
        nodes = model.mesh.nodes(f"x1_{side}")
        for direction, turn in (((1.0, 0.0, 0.0), np.cos), ((0.0, 0.0, 1.0), np.sin)):
            force = sign * size / len(nodes) * np.array(direction)
            loads.append(model.force(nodes, force, f"{side} {turn.__name__}"))
            ways.append(lambda part, turn=turn: part * turn(2.0 * np.pi * part))
    return model, uf.Move(loads, ways, steps=20)


def run(build, **options):
    """Its model and its result."""
    model, move = build()
    return model, uf.solve(model, move, frames=0, progress=False, options=uf.NewtonOptions(**options))


@pytest.mark.parametrize("build", [loaded, lifted, rolled])
def test_fewer_iterations_lead_to_the_same_answer(build, monkeypatch):
    """Than along the last increment."""
    model, along = run(build)
    monkeypatch.setattr(increment, "_along_tangent", lambda *_: None)
    other, chord = run(build)
    np.testing.assert_allclose(model.u, other.u, atol=1e-7 * np.abs(other.u).max())
    assert along.timing.attempts.won == chord.timing.attempts.won == {"tangent": 1, "extrapolation": len(along) - 2}
    assert along["iterations"].sum() <= 0.83 * chord["iterations"].sum()
    assert along.timing.factorisation.calls <= 0.81 * chord.timing.factorisation.calls
    assert along.timing.attempts.evaluations < chord.timing.attempts.evaluations


@pytest.fixture
def starts(monkeypatch):
    """Extrapolated increments of the unknowns, each with that along the tangent of an evaluation at the same place."""
    seen, original = [], Newton.solve

    def watched(newton, goal, extrapolation=None, *more, **options):
        if extrapolation is not None:
            system = newton.system
            state = system.state
            rates = {control: goal.controls[control.name] - control.value for control in system.controls}
            evaluation = system.evaluate(state, rates=rates)
            tangent = np.linalg.solve(system.tangent(evaluation).toarray(), -system.restrict(evaluation.predictor))
            seen.append((system.coefficients(extrapolation), tangent))
        return original(newton, goal, extrapolation, *more, **options)

    monkeypatch.setattr(Newton, "solve", watched)
    return seen


@pytest.mark.parametrize("build", [loaded, lifted])
def test_it_is_the_tangent_at_the_end_of_the_last_increment(build, starts):
    run(build)
    for extrapolated, tangent in starts:
        np.testing.assert_allclose(extrapolated, tangent, atol=2e-3 * np.abs(tangent).max())


def test_unequal_increments_take_a_part_of_it(starts):
    model, _ = loaded()
    uf.solve(model, uf.Move(list(model.controls), [0.5, 0.02]), frames=0, progress=False)
    sizes = [float(np.abs(tangent).max()) for _, tangent in starts]
    assert max(sizes) > 1.3 * min(sizes)
    for extrapolated, tangent in starts:
        np.testing.assert_allclose(extrapolated, tangent, atol=0.05 * np.abs(tangent).max())


def metal():
    """A sheet that yields."""
    return lifted(material=uf.J2(kappa=1e5, mu=4e4, hardening=uf.Linear(100.0, 500.0)))


def touching():
    """A sheet above a tool."""
    model, move = lifted()
    model.contact("lower", Plane(point=(0, 0, -5), normal=(0, 0, 1)), penalty=1.0)
    return model, move


@pytest.mark.parametrize(
    ("build", "options"),
    [
        (metal, {}),
        (touching, {}),
        (lifted, {"mixed": False}),
        (lifted, {"extrapolate": 2}),
        (lifted, {"extrapolate": 0}),
    ],
)
def test_other_sheets_and_options_have_other_predictors(build, options, monkeypatch):
    monkeypatch.setattr(Newton, "along_last_factors", lambda *_: pytest.fail("along the tangent"))
    run(build, **options)


class Way(Term):
    """A scalar unknown that goes to 1."""

    def __init__(self):
        self.unknowns = (Global("way", {}),)

    def evaluate(self, at, into):
        (way,) = self.unknowns
        number = into.border.number(way)
        into.border.residual[number] = at.scalars[way] - 1.0
        into.border.corner[number, number] = 1.0
        return Found()


def test_a_sheet_with_a_scalar_unknown_is_extrapolated_along_its_last_increment():
    model, move = loaded()
    model.add(Way())
    alone, _ = run(loaded)
    result = uf.solve(model, move, frames=0, progress=False)
    assert result.model.system.unknowns[0].value == pytest.approx(1.0)
    np.testing.assert_allclose(model.u, alone.u, atol=1e-7 * np.abs(alone.u).max())


def test_the_tangent_of_an_unstable_state_is_not_followed(monkeypatch):
    """Its factors may be those of a shifted matrix, and loads fall along it."""
    monkeypatch.setattr(StrategyStatistics, "stable", property(lambda self: False, lambda self, value: None))
    monkeypatch.setattr(Newton, "along_last_factors", lambda *_: pytest.fail("along the tangent"))
    run(loaded)


def test_a_linear_step_needs_no_further_solution(monkeypatch):
    model = clamped(4)
    end = model.force(model.mesh.nodes("x1"), (0.0, 0.0, 1e-13), "end")
    monkeypatch.setattr(Newton, "along_last_factors", lambda *_: pytest.fail("along the tangent"))
    assert uf.solve(model, uf.Move(end, 1.0, steps=1), frames=0, progress=False).timing.factorisation.calls == 1


def test_the_rate_of_the_residual_is_the_predictor_of_an_evaluation():
    for build in (loaded, lifted):
        model, _ = run(build)
        rates = dict(zip(model.controls, (0.3, -0.01), strict=False))
        state = model.system.state
        expected = model.system.evaluate(state, rates=rates).predictor
        np.testing.assert_allclose(
            model.system.rate(state, rates), expected, rtol=0, atol=1e-12 * np.abs(expected).max()
        )

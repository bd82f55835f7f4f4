"""The load parameter as a scalar unknown of the model: its column, its equation, pressed tools beside it."""

from __future__ import annotations

import numpy as np
import pytest

from umform import materials as mt
from umform.analysis.newton.newton import Newton
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import solve
from umform.analysis.steps import Arc, Move
from umform.analysis.steps.arc_length.equation import ArcLength, Line
from umform.mesh import strip
from umform.model import Model
from umform.surfaces import Cylinder, Plane

TIGHT = NewtonOptions(residual=1e-12, increment=1e-9)


def pressed(element="ANS3DEAS"):
    """A strip that is clamped at both ends under a cylinder that a force presses."""
    model = Model(strip(40.0, 4.0, 1.0, (12, 1)), element, material=mt.SVK(E=210e3, nu=0.3))
    model.fix("x0")
    model.fix("x1")
    tool = model.tool("punch", Cylinder((20.0, 0.0, 10.48), "y", 10.0))
    model.contact("upper", tool, penalty=1e4, points=4, name="top")
    return model, model.press(tool, "z", "press")


def moved(kind):
    """A model, a control and its rate."""
    if kind == "press":
        model, press = pressed("DISP3D")
        press.value = -50.0
        return model, press, -100.0
    model = Model(strip(2.0, 1.0, 0.4, (2, 1)), "DISP3D", material=mt.NeoHooke(E=100.0, nu=0.3))
    model.fix("x0")
    if kind == "load":
        return model, model.force("x1", (1.0, 2.0, 3.0)), 0.7
    if kind == "pressure":
        return model, model.pressure("upper"), 0.7
    if kind == "midline":
        return model, model.prescribe_midline("x1", "z"), 0.7
    contact = model.contact("upper", Plane((0.0, 0.0, 0.15), "-z"), penalty=50.0)
    return model, model.drive(contact, (0.3, 0.0, -1.0)), 0.7


@pytest.mark.parametrize("held", [True, False])
@pytest.mark.parametrize("kind", ["load", "pressure", "midline", "tool", "press"])
def test_column_row_and_corner_are_derivatives(kind, held, build, rng):
    """Of the residual over all unknowns, the equation of the load parameter last; its scale counts as a constant."""
    model, control, rate = moved(kind)
    line = Line([control], [control.value], [control.value + rate])
    equation = ArcLength(line)
    equation.load_weight = 0.3
    if not held:
        equation.ask(0.5, model.u - 0.01 * rng.normal(size=model.u.size))
    with model.system.with_term(equation):
        x = model.system.x + 0.003 * rng.normal(size=model.system.x.size)
        supports = model.supports.displacement(line.rates)
        x[: model.u.size] += x[-1] * supports
        ahead = rng.normal(size=model.system.x.size)
        ahead = model.system.extend(model.system.coefficients(ahead))
        evaluation = model.evaluate(x)
        solver = Newton(model.system).ready_solver()
        solver.factor(evaluation)

        def residual(step):
            found = model.evaluate(x + step * ahead)
            scaled = found.residual.copy()
            scaled[-1] *= evaluation.force_scale / found.force_scale
            return model.system.restrict(scaled)

        change = build.central_difference(residual, 0.0, 1.0, 1e-6)
        np.testing.assert_allclose(
            solver.solve(change), model.system.coefficients(ahead), atol=1e-5 * np.abs(ahead).max()
        )
    assert model.system.others == []
    assert model.system.x.size == model.u.size + (kind == "press")


def test_an_arc_raises_the_force_that_presses_a_tool():
    """A move through the same forces finds the same ways."""
    model, press = pressed()
    result = solve(model, Arc(press, -150.0, increment=0.2, grow=1.0), options=TIGHT, frames=0)
    assert press.value == -150.0
    assert len(result) > 4
    np.testing.assert_allclose(result["punch_fz"][1:], -result["press"][1:], rtol=1e-8)
    other, control = pressed()
    expected = solve(other, [Move(control, v, steps=1) for v in result["press"][1:]], options=TIGHT, frames=0)
    np.testing.assert_allclose(result["press_way"], expected["press_way"], rtol=1e-7, atol=1e-12)
    np.testing.assert_allclose(model.u, other.u, atol=1e-7 * np.abs(other.u).max())


def test_between_increments_the_load_parameter_is_no_unknown(build):
    model, load = build.loaded_arch()
    sizes = []

    def look(model):
        sizes.append(model.system.x.size)
        assert np.isfinite(model.evaluate(model.system.x).residual).all()
        return not model.system.snapshot().unknowns and len(sizes) == 3

    result = solve(model, Arc(load, 0.1, until=look), frames=0)
    assert sizes == [model.u.size] * 3
    assert len(result) == 4


def test_the_length_does_not_spoil_the_residual_of_the_forces(build):
    """Lengths a million times those of another system of units make the same iterations."""
    records = []
    for unit in (1.0, 1e3, 1e-3):
        mesh = strip(10.0 * unit, 1.0 * unit, 0.2 * unit, (4, 1))
        model = Model(mesh, material=mt.SVK(E=1000.0 / unit**2, nu=0.0))
        model.fix("x0")
        load = model.force("x1", (0.0, 0.0, 0.02), "load")
        result = solve(model, Arc(load, 1.0, increment=0.2, grow=1.0), frames=0)
        records.append([[it.residual for it in one] for one in result.iterations])
    for one in records[1:]:
        assert [len(increment) for increment in one] == [len(increment) for increment in records[0]]
        np.testing.assert_allclose([i[0] for i in one[1:]], [i[0] for i in records[0][1:]], rtol=1e-6)

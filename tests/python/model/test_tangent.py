"""The tangent as a sparse matrix, enhanced parameters in equilibrium, and the warning where they are not."""

from __future__ import annotations

import logging

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

import umform as uf
from umform.errors import InvalidValue, NoConvergence

STEEL = uf.J2(E=206e3, nu=0.3, hardening=uf.Swift(565.3, 0.0071, 0.259))


def bent(law=STEEL, **contact):
    model = uf.Model(uf.mesh.strip(20.0, 2.0, 1.0, (10, 1)), material=law)
    model.fix("x0")
    die = model.tool("die", uf.Cylinder((10.0, 0.0, -5.55), "y", 5.0))
    model.contact("lower", die, name="on die", penalty=3e3, **contact)
    return model, model.prescribe("x1_lower", "z", name="tip")


def pressed():
    """A pressed punch, whose way is an unknown; a tie of thickness and friction."""
    model = uf.Model(uf.mesh.strip(20.0, 2.0, 1.0, (10, 1)), material=STEEL)
    model.fix("x0")
    model.hold_director("x1", "x")
    punch = model.tool("punch", uf.Cylinder((17.0, 0.0, 5.5), "y", 5.0))
    model.contact("upper", punch, name="on punch", penalty=3e3, friction=0.1)
    press = model.spring(punch, "z", stiffness=20.0, name="press")
    return model, press


def state_of(build, value, **options):
    model, control = build(**options)
    uf.solve(model, uf.Move(control, value, steps=6), progress=False)
    name = control.name
    return model, model.state.toward({name: value * 1.02}, model.state.time + 0.1)


@pytest.mark.parametrize(
    ("build", "value", "options"),
    [(bent, -1.5, {}), (bent, -1.5, {"friction": 0.2}), (bent, -1.5, {"cells": 3}), (pressed, -40.0, {})],
    ids=["points", "friction", "cells", "pressed"],
)
def test_tangent_is_the_derivative_of_the_settled_residual(build, value, options, rng):
    """At a state that flows, under contact: plasticity, friction, ties and the way of a pressed tool."""
    model, goal = state_of(build, value, **options)
    q = rng.normal(size=model.system.restrict(np.zeros(goal.x.size)).size)
    way = model.system.extend(q)
    way *= 1e-3 / np.abs(way).max()
    q = model.system.coefficients(way)
    at = goal.x + 0.5 * model.system.extend(q)

    def residual(part):
        found = model.system.settle(model.system.state_at(at + part * way, goal)).residual
        model.system.revert()
        return model.system.restrict(found)

    evaluation = model.system.settle(model.system.state_at(at, goal))
    assert evaluation.flowing.any()
    assert evaluation.active.any()
    K = model.tangent(evaluation)
    model.system.revert()
    h = 1e-4
    measured = (residual(h) - residual(-h)) / (2.0 * h)
    np.testing.assert_allclose(K @ q, measured, rtol=0, atol=2e-6 * np.abs(K @ q).max())
    unsymmetric = abs(K - K.T).max() / abs(K).max()
    assert (unsymmetric < 1e-12) == (build is bent and not options)


def test_own_newton_finds_the_states_of_solve():
    tight = uf.NewtonOptions(residual=1e-12, increment=1e-9, extrapolate=0, line_search=False)
    model, tip = bent()
    uf.solve(model, uf.Move(tip, -1.0, steps=4), progress=False, options=tight)
    own, _ = bent()
    for k in range(1, 5):
        goal = own.state.toward({"tip": -0.25 * k}, 0.25 * k)
        x, du = goal.x.copy(), own.system.prescribed_displacement(goal) - goal.x
        du -= own.system.extend(own.system.coefficients(du))
        first = own.evaluate(goal, du)
        du += own.system.extend(spsolve(own.tangent(first), -own.system.restrict(first.residual + first.predictor)))
        for _ in range(20):
            own.system.recover(du)
            x = x + du
            at = own.evaluate(own.system.state_at(x, goal))
            r = own.system.restrict(at.residual)
            if np.linalg.norm(r) < 1e-12 * at.force_scale:
                break
            du = own.system.extend(spsolve(own.tangent(at), -r))
        own.system.commit(at)
    np.testing.assert_allclose(own.u, model.u, rtol=0, atol=1e-12)
    np.testing.assert_allclose(own.bodies.only.block.state, model.bodies.only.block.state, rtol=0, atol=1e-11)


def told(caplog):
    return [record for record in caplog.records if record.name == "umform.model"]


def test_a_residual_at_fixed_displacement_is_warned_of(caplog):
    model, tip = bent()
    uf.solve(model, uf.Move(tip, -1.0, steps=4), progress=False)
    x, records = model.u.copy(), []
    caplog.set_level(logging.WARNING, logger="umform.model")
    model.evaluate(x)
    assert not told(caplog)  # at the converged state they are in equilibrium

    def slope(settle):
        found = []
        for part in (1.0 + 1e-4, 1.0 - 1e-4):
            other, _ = bent(uf.J2(E=206e3, nu=0.3 * part, hardening=STEEL.hardening))
            found.append(other.system.restrict((other.system.settle(x) if settle else other.evaluate(x)).residual))
        records.append(len(told(caplog)))
        return (found[0] - found[1]) / 6e-5

    right, wrong = slope(settle=True), slope(settle=False)
    assert records == [0, 2]
    assert "enhanced parameters are not in equilibrium" in caplog.text
    assert np.linalg.norm(wrong - right) > 0.1 * np.linalg.norm(right)
    elastic, _ = bent(uf.SVK(E=206e3, nu=0.3))
    elastic.evaluate(x)
    elastic.evaluate(x)
    assert len(told(caplog)) == 3  # once for each model


def test_displacement_elements_have_nothing_to_settle(caplog):
    caplog.set_level(logging.WARNING, logger="umform.model")
    model = uf.Model(uf.mesh.strip(4.0, 1.0, 1.0, (4, 1)), "DISP3D", material=STEEL)
    u = 0.001 * np.sin(model.mesh.points).ravel()
    np.testing.assert_array_equal(model.evaluate(u).residual, model.system.settle(u).residual)
    assert not told(caplog)


def test_what_has_no_tangent_is_refused():
    model, _ = bent()
    with pytest.raises(InvalidValue, match="has no tangent"):
        model.tangent(model.evaluate(model.state, tangent=False))
    before = model.evaluate(model.state)
    model.fix("x1", "y")
    with pytest.raises(InvalidValue, match="has no tangent"):
        model.tangent(before)
    inside_out = np.zeros_like(model.u).reshape(-1, 3)
    inside_out[model.mesh.nodes("upper"), 2] = -3.0
    with pytest.raises(NoConvergence, match="no equilibrium") as refused:
        model.system.settle(inside_out.ravel())
    assert "cell" in str(refused.value)


def test_a_displacement_without_equilibrium_leaves_nothing_behind():
    """Its remedy is to settle at displacements in between: they begin with converged parameters."""
    model, tip = bent()
    uf.solve(model, uf.Move(tip, -1.0, steps=4), progress=False)
    way = model.system.extend(np.random.default_rng(0).normal(size=model.system.pattern.n))
    near = model.u + 1e-4 * way
    expected = model.system.settle(near).residual
    model.system.revert()
    with pytest.raises(NoConvergence, match="no equilibrium"):
        model.system.settle(model.u + 0.2 * way)
    np.testing.assert_array_equal(model.system.settle(near).residual, expected)

"""The geometric stiffness of the stress that an increment foresaw: what it is, and what it saves. docs/theory, 5.13"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from umform import elements as el
from umform import materials as mt
from umform.analysis.newton.newton import Newton
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import solve
from umform.analysis.steps import Move
from umform.history_variables import history_of
from umform.materials.user_law import UserLaw
from umform.mesh import strip
from umform.model import Model
from umform.results.records import Failed
from umform.surfaces import Plane

#: Without enhanced strains, with and without tying.
PURE = (
    el.element("DISP3D"),
    el.element("DISP9K3D"),
    replace(el.element("ANS3DEAS", tie_E33=True), modes=(), thickness_order=0, name="tied"),
    replace(el.element("MI9K3DEAS", tie_E33=True), modes=(), thickness_order=0, name="tied 18"),
)


def block(element, law):
    """One thick clamped layer."""
    mesh = strip(2.0, 1.0, 0.6, (2, 1), cell=el.element(element).cell)
    model = Model(mesh, element, material=law)
    model.fix("x0")
    return model


def increment(model, size, seed=1):
    """An increment of all free degrees of freedom."""
    free = np.isin(np.arange(model.u.size), model.system.free)
    return np.where(free, size * np.random.default_rng(seed).standard_normal(model.u.size), 0.0)


def difference(model, u, du):
    """Consistent tangent, and what the mixed one after ``du`` has beyond that, at the same enhanced parameters."""
    found = []
    for mixed in (False, True):
        model.system.revert()
        model.evaluate(model.u)
        model.system.recover(du, mixed)
        found.append(model.evaluate(u))
    consistent, other = found
    np.testing.assert_array_equal(other.residual, consistent.residual)
    return consistent.values, other.values - consistent.values


@pytest.mark.parametrize("element", PURE, ids=lambda element: element.name)
def test_it_differs_by_the_geometric_stiffness_of_the_quadratic_strain(element):
    """G is linear in the stress: with a law of stress C : E and no tangent, K = G; E(du) + E(-du) = 2 Q(du)."""
    hooke = mt.SVK(E=100.0, nu=0.3)
    lam, mu = 100.0 * 0.3 / (1.3 * 0.4), 100.0 / 2.6
    C = np.diag([2 * mu] * 3 + [mu] * 3)
    C[:3, :3] += lam
    stress_alone = UserLaw(lambda E, state: (E @ C, np.zeros((len(E), 6, 6)), state), name="stress alone")
    model, geometric = block(element, hooke), block(element, stress_alone)
    u, du = increment(model, 0.02, seed=2), increment(model, 0.03)
    K, more = difference(model, u, du)
    expected = -0.5 * (geometric.evaluate(du).values + geometric.evaluate(-du).values)
    assert np.abs(expected).max() > 1e-4 * np.abs(K).max()
    np.testing.assert_allclose(more, expected, atol=1e-12 * np.abs(K).max())


@pytest.mark.parametrize("name", ["ANS3DEAS", "EAS3DEAS", "BEND8", "MI9K3DEAS", "BEND18"])
def test_enhanced_parameters_play_no_part_in_it(name):
    """They are linear in the strains: with a constant C the difference is homogeneous of order two in ``du`` alone."""
    model = block(name, mt.SVK(E=100.0, nu=0.3))
    du = increment(model, 0.01)
    K, once = difference(model, increment(model, 0.02, seed=2), du)
    _, twice = difference(model, increment(model, 0.01, seed=3), 2 * du)
    assert np.abs(once).max() > 1e-5 * np.abs(K).max()
    np.testing.assert_allclose(twice, 4 * once, atol=1e-11 * np.abs(K).max())


def test_what_is_taken_back_leaves_the_consistent_tangent():
    model = block("EAS3DEAS", mt.NeoHooke(E=100.0, nu=0.3))
    u, du = increment(model, 0.02, seed=2), increment(model, 0.03)
    consistent = model.evaluate(u).values.copy()
    model.system.recover(du, mixed=True)
    assert (model.evaluate(u).values != consistent).any()
    model.system.shorten(0.0)
    np.testing.assert_array_equal(model.evaluate(u).values, consistent)
    model.system.recover(du, mixed=True)
    model.system.revert()
    np.testing.assert_array_equal(model.evaluate(u).values, consistent)


@pytest.mark.parametrize("element", ["DISP3D", "EAS3DEAS", "MI9K3DEAS"])
def test_what_is_committed_leaves_the_consistent_tangent(element):
    """The increment that was committed foresees nothing any more: the next tangent is that of a plain run."""

    def committed(mixed):
        model = block(element, mt.NeoHooke(E=100.0, nu=0.3))
        u, du = increment(model, 0.02, seed=2), increment(model, 0.03)
        model.evaluate(model.u)
        model.system.recover(du, mixed)
        evaluation = model.evaluate(u)
        model.system.commit(evaluation)
        return evaluation.values, model.evaluate(u).values.copy()

    (plain, plain_after), (mixed, after) = committed(False), committed(True)
    assert np.abs(mixed - plain).max() > 1e-6 * np.abs(plain).max()
    np.testing.assert_array_equal(after, plain_after)


def steel():
    """Yields where it is bent."""
    return mt.J2(E=210e3, nu=0.3, hardening=mt.Linear(yield_stress=300.0, modulus=1000.0))


def rolled(mixed, element="ANS3DEAS", law=None, steps=5):
    """A thin strip, a hundred times as long as thick, whose end goes up by three quarters of its length."""
    cell, cells = ("hex18", (10, 1)) if "9K" in element else ("hex8", (20, 1))
    model = Model(strip(10.0, 1.0, 0.1, cells, cell=cell), element, material=law or mt.SVK(E=1e5, nu=0.3))
    model.fix("x0")
    end = model.prescribe("x1_lower", "z", name="end")
    result = solve(model, Move(end, 7.5, steps=steps), frames=0, options=NewtonOptions(mixed=mixed))
    return model, result


@pytest.mark.parametrize("element", ["ANS3DEAS", "EAS3DEAS", "MI9K3DEAS"])
def test_thin_sheets_need_fewer_iterations_for_the_same_answer(element):
    (plain, before), (mixed, after) = rolled(False, element), rolled(True, element)
    np.testing.assert_allclose(mixed.u, plain.u, atol=1e-7 * np.abs(plain.u).max())
    assert after["iterations"].sum() <= 0.8 * before["iterations"].sum()


def test_its_convergence_is_quadratic():
    model, _ = rolled(True)
    for control in model.controls:
        control.value = 7.8
    records = Newton(model.system, NewtonOptions(residual=1e-12, increment=1e-12)).solve().iterations
    norms = [r.residual for r in records if r.residual > 1e-11]
    orders = np.log(np.array(norms[2:]) / norms[1:-1]) / np.log(np.array(norms[1:-1]) / norms[:-2])
    assert orders.max() > 1.8


def test_plastic_answers_are_the_same():
    """Of a law with a history too: the residual that is solved is the same."""
    (plain, before), (mixed, after) = (rolled(way, law=steel(), steps=40) for way in (False, True))
    assert len(before) == len(after) == 41  # the answer depends on the increments
    assert (history_of(plain.bodies.only.block)["eqps"] > 0).any()
    np.testing.assert_allclose(mixed.u, plain.u, atol=1e-6 * np.abs(plain.u).max())


def test_by_default_elastic_sheets_take_it():
    elastic, plastic, touching = block("ANS3DEAS", mt.SVK(E=100.0, nu=0.3)), block("ANS3DEAS", steel()), rolled(True)[0]
    touching.contact("lower", Plane(point=(0, 0, -5), normal=(0, 0, 1)), penalty=1.0)
    assert [Newton(model.system).mixed for model in (elastic, plastic, touching)] == [True, False, True]
    assert Newton(plastic, NewtonOptions(mixed=True)).mixed
    assert not Newton(elastic, NewtonOptions(mixed=False)).mixed


def test_an_increment_that_fails_with_it_is_tried_with_the_consistent_tangent(monkeypatch):
    original, tried = Newton.solve, []

    def solve_with(self, goal, extrapolation=None, mode=None, beyond=None, keep=False):
        tried.append((extrapolation is not None, not mode.mixed))
        if mode.mixed:
            raise Failed("not with this one", [])
        return original(self, goal, extrapolation, mode, beyond, keep)

    monkeypatch.setattr(Newton, "solve", solve_with)
    _, result = rolled(True)
    assert len(result) == 6  # nothing is cut
    plain = [(False, False), (False, True)]
    extrapolated = [(True, False), *plain]  # left out after a failure for one increment, then for three
    assert tried == plain + extrapolated + plain + extrapolated + plain

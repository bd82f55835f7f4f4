"""The first evaluation of an extrapolated increment keeps the points that a tool held. eq. (4.230)"""

from __future__ import annotations

import numpy as np
import pytest

from umform import materials as mt
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import solve
from umform.analysis.steps import Move, Release
from umform.mesh import strip
from umform.model import Model
from umform.model.equations.evaluated import Evaluated
from umform.surfaces import Cylinder

STEEL = mt.J2(E=210e3, nu=0.3, hardening=mt.Linear(200.0, 1000.0))


def pressed(friction=0.1, **settings):
    """A clamped strip that a round punch has bent."""
    model = Model(strip(20.0, 2.0, 0.8, (12, 1)), material=STEEL)
    model.fix("x0")
    punch = model.tool("punch", Cylinder((14.0, 0.0, 6.41), "y", 6.0))
    contact = model.contact("upper", punch, penalty=2e4, friction=friction, **settings)
    way = model.drive(punch, "-z", "way")
    solve(model, Move(way, 1.0, steps=4), frames=0, progress=False)
    return model, contact, way


@pytest.mark.parametrize("friction", [None, 0.1])
def test_a_point_that_has_opened_is_held_with_tension_in_one_evaluation(friction):
    model, contact, way = pressed(friction)
    held = contact.found.status > 0
    way.value = 0.9  # the tool has left all points
    assert not model.evaluate(model.system.x).active.any()
    forces = model.evaluate(model.system.x).residual
    kept = model.evaluate(model.system.x, keep=True)
    assert kept.kept
    assert not kept.active.any()
    points = kept.found[contact]
    pull = np.zeros((len(model.mesh.points), 3))
    N = np.swapaxes(contact.block.shape_values, 1, 2)
    tension = 2e4 * np.where(held, points.gap, 0.0) * contact.block.areas  # towards the tool
    at_points = (tension[:, None] * points.normal).reshape(len(contact.facets), -1, 3)
    np.add.at(pull, contact.facets, N @ at_points)
    np.testing.assert_allclose((kept.residual - forces).reshape(-1, 3), pull, atol=1e-9)
    again = model.evaluate(model.system.x)  # once only
    assert not again.kept
    np.testing.assert_array_equal(again.residual, forces)


@pytest.mark.parametrize("friction", [None, 0.1])
def test_the_tangent_of_kept_points_is_consistent(friction, build):
    """The part of them: all points have opened, so that the rest is the sheet alone."""
    model, contact, way = pressed(friction)
    way.value = 1.0 - 2.0 * contact.found.penetration
    v = model.system.extend(np.random.default_rng(1).standard_normal(model.system.restrict(model.u).size))

    def forces(x):
        return model.system.restrict(model.evaluate(x, keep=True).residual - model.evaluate(x).residual)

    tangents = [
        build.dense(model.system.pattern, model.evaluate(model.system.x, keep=keep).values) for keep in (True, False)
    ]
    slope = build.central_difference(forces, model.system.x, v, h=1e-5)
    assert np.abs(slope).max() > 1.0
    assert build.relative_error((tangents[0] - tangents[1]) @ model.system.coefficients(v), slope) < 1e-6


def test_tools_whose_travel_is_an_unknown_and_cells_keep_nothing():
    model, contact, way = pressed(None, cells=3)
    way.value = 0.9
    assert not model.evaluate(model.system.x, keep=True).kept
    assert not contact.keeps_points


def test_no_state_converges_with_kept_points_and_a_release_keeps_none(monkeypatch):
    model, _, way = pressed()
    evaluate, asked, converged = Evaluated.evaluate, [], []
    commit = model.system.commit

    def watched(self, *arguments, keep=False, **named):
        asked.append(keep)
        return evaluate(self, *arguments, keep=keep, **named)

    def committed(evaluation):
        converged.append(evaluation.kept)
        commit(evaluation)

    monkeypatch.setattr(Evaluated, "evaluate", watched)
    model.system.commit = committed
    keep = NewtonOptions(keep=True)
    solve(model, Move(way, 2.0, steps=5), options=keep, frames=0, progress=False)
    assert any(asked)
    asked.clear()
    solve(model, Release(way), options=keep, frames=0, progress=False)
    assert not any(asked)
    assert converged
    assert not any(converged)
    solve(model, Move(way, 2.0, steps=5), frames=0, progress=False)
    assert not any(asked)  # an option

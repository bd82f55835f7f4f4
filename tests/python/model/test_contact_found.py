"""What an evaluation of a contact leaves behind: a value of its own, the history of the points, facets that are far."""

from __future__ import annotations

import numpy as np
import pytest

from umform import _core
from umform.history_variables import history_of
from umform.mesh import strip
from umform.model.contact.friction import Friction
from umform.surfaces import Cylinder, Sphere, UserSurface


def facets_on(tool, penalty=100.0, points=2, cells=(24, 24), law=None):
    mesh = strip(24.0, 24.0, 1.0, cells)
    law = law or _core.penalty_law(penalty)
    return _core.contact_block(mesh.facets("lower"), mesh.points, (points, points), False, tool.kernel(), law), mesh


def forces(block, mesh, u):
    pattern = _core.Pattern(np.full(u.size, -1, dtype=np.int32), [block.connectivity], True)
    f = np.zeros(u.size)
    block.evaluate(u, pattern.scatter(block.connectivity), f, None, None, None)
    return f


BALL = Sphere((12.0, 0.0, -8.4), 8.0)  # below the middle of the sheet, 0.1 inside


def test_what_was_found_is_that_of_its_evaluation(rng):
    block, mesh = facets_on(BALL)
    u = 0.01 * rng.normal(size=mesh.points.size)
    f = forces(block, mesh, u)
    found, gaps, normals = block.found(), block.gaps, block.normals
    tractions, pressures = block.tractions, block.pressures
    assert 3 < len(found.points) < 40
    forces(block, mesh, u + np.tile((0.0, 0.0, 5.0), len(mesh.points)))
    assert not block.active.any()
    np.testing.assert_array_equal(found.points, np.flatnonzero(gaps <= 0.0))
    np.testing.assert_array_equal(np.flatnonzero(found.active), found.points)
    np.testing.assert_array_equal(found.gap, gaps[found.points])
    np.testing.assert_array_equal(found.normal, normals[found.points])
    np.testing.assert_array_equal(found.pressure, 100.0 * -found.gap)
    np.testing.assert_array_equal(found.traction, found.pressure[:, None] * found.normal)
    np.testing.assert_array_equal(tractions[found.points], found.traction)
    np.testing.assert_array_equal(pressures[found.points], found.pressure)
    assert np.count_nonzero(pressures) == np.count_nonzero(found.pressure)
    assert found.penetration == -gaps.min()
    np.testing.assert_array_equal(found.force, -(found.pressure * found.area)[:, None] * found.normal)
    np.testing.assert_allclose(found.force.sum(axis=0), f.reshape(-1, 3).sum(axis=0), atol=1e-12)
    with pytest.raises(ValueError, match="read-only"):
        found.gap[0] = 0.0


def test_a_law_says_what_its_points_remember():
    law = _core.penalty_law(7.0)
    assert (law.penalty, law.symmetric) == (7.0, True)
    block, _ = facets_on(BALL, penalty=7.0)
    assert block.symmetric
    assert block.history_variables == {"multiplier": 1}
    assert block.state.shape == (block.points, 1)


def test_multipliers_have_one_owner():
    """Those of now are set between evaluations; the converged ones change by commit and restore only."""
    block, _ = facets_on(BALL)
    first = np.arange(float(block.points))
    block.multipliers = first
    np.testing.assert_array_equal(block.state, 0.0)
    block.commit()
    np.testing.assert_array_equal(history_of(block)["multiplier"][:, 0], first)
    block.multipliers = 2.0 * first
    block.revert()
    np.testing.assert_array_equal(block.multipliers, first)
    block.multipliers = 2.0 * first
    block.restore(3.0 * block.state)
    np.testing.assert_array_equal(block.multipliers, 3.0 * first)
    np.testing.assert_array_equal(history_of(block)["multiplier"][:, 0], 3.0 * first)
    with pytest.raises(ValueError, match="another size"):
        block.restore(first[:-1])


def ball(x, scale=1.0):
    d = x - np.asarray(BALL.centre)
    rho = np.linalg.norm(d, axis=1)
    n = d / rho[:, None]
    H = (np.eye(3) - n[:, :, None] * n[:, None, :]) / rho[:, None, None]
    return scale * (rho - BALL.radius), scale * n, scale * H


def test_most_facets_of_a_large_sheet_are_far_and_their_gaps_are_measured_when_asked_for(rng):
    block, mesh = facets_on(BALL)
    once, _ = facets_on(BALL)
    u = np.zeros(mesh.points.size)
    far = []
    for _ in range(5):
        u += 0.02 * rng.normal(size=u.size)
        f = forces(block, mesh, u)
        far.append(block.far_facets)
        fresh, _ = facets_on(BALL)
        np.testing.assert_array_equal(f, forces(fresh, mesh, u))
    assert far[0] == 0
    assert min(far[1:]) > 0.9 * 24 * 24
    forces(once, mesh, u)
    np.testing.assert_array_equal(block.gaps, once.gaps)
    assert block.far_facets == 0


def test_friction_remembers_the_same_place_of_a_point_in_a_far_facet(rng):
    """A resumed run locates all facets at first: its bits must not depend on which were far."""
    law = _core.coulomb_law(100.0, 1.0, 0.01, Friction(0.1).kernel())
    block, mesh = facets_on(BALL, law=law)
    fresh, _ = facets_on(BALL, law=law)
    for one in (block, fresh):
        one.set_pose(np.eye(3), np.array([0.0, 0.0, 0.123]))
    u = np.zeros(mesh.points.size)
    for _ in range(3):
        u += 0.02 * rng.normal(size=u.size)
        forces(block, mesh, u)
    assert block.far_facets > 0.9 * 24 * 24
    forces(fresh, mesh, u)
    assert fresh.far_facets == 0
    for one in (block, fresh):
        one.commit()
    np.testing.assert_array_equal(history_of(block)["place"], history_of(fresh)["place"])


@pytest.mark.parametrize("scale", [1.0, 4.0])
def test_functions_of_users_are_asked_for_every_point_with_one_call(scale):
    """A level set that is no distance may fall faster than a point moves; nothing says that it does not."""
    asked = []

    def function(x):
        asked.append(len(x))
        return ball(x, scale)

    tool = UserSurface(function)
    assert not tool.kernel().is_distance
    assert Cylinder((0, 0, 0), "y", 1.0).kernel().is_distance
    block, mesh = facets_on(tool)
    for _ in range(3):
        f = forces(block, mesh, np.zeros(mesh.points.size))
    assert asked == [block.points] * 3
    assert block.far_facets == 0
    assert f.any()

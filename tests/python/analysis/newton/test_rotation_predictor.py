"""The arc of a body that goes round with a tool."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from umform.analysis.newton.rotation_predictor import Screw


@pytest.mark.parametrize("angle", [1e-9, 0.3, 2.0])
def test_straight_way_and_what_it_lacks_make_the_arc(angle):
    """Places go round with the motion, and what they move beside it turns with them. eq. (4.178)"""
    rng = np.random.default_rng(3)
    axis = rng.normal(size=3)
    Q, s = Rotation.from_rotvec(angle * axis / np.linalg.norm(axis)).as_matrix(), rng.normal(size=3)
    x, beside = rng.normal(size=(5, 3)), rng.normal(size=(5, 3))
    screw = Screw.of(Q, s)
    way = screw.straight(x) + beside
    expected = x @ Q.T + s - x + beside @ Q.T
    np.testing.assert_allclose(way + screw.beyond(x, way), expected, atol=1e-12)
    np.testing.assert_allclose(screw.arrival(x @ Q.T + s), x @ Q.T + s - x, atol=1e-12)


def test_straight_way_is_the_velocity_of_the_motion():
    """A small part of the screw moves places by that part of the straight way, to first order."""
    Q, s = Rotation.from_rotvec([0.0, 0.5, 0.2]).as_matrix(), np.array([0.3, -0.1, 0.4])
    screw, x, part = Screw.of(Q, s), np.random.default_rng(4).normal(size=(4, 3)), 1e-6
    small = Screw.of(Rotation.from_rotvec(part * screw.w).as_matrix(), part * screw.v)
    np.testing.assert_allclose(x @ small.Q.T + small.s - x, part * screw.straight(x), atol=1e-11)

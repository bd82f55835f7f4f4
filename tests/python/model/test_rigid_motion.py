"""A bent body that is moved as a rigid body keeps its state: its internal forces turn with it."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.analysis.run.stages import continued
from umform.elements import element
from umform.model.transfer.rigid_motion import RigidMotion

STEEL = uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(yield_stress=160.0, modulus=500.0))


def made(name, points):
    cell = element(name).cell
    return uf.Model(uf.mesh.grid(*points, cell), name, material=STEEL)


@pytest.mark.parametrize("name", ["BEND18", "EAS3DEAS", "ANS3DEAS"])
def test_internal_forces_turn_with_the_body(name):
    points = np.linspace(0.0, 10.0, 5), np.array([0.0, 1.0]), np.array([0.0, 0.5, 1.0])
    model = made(name, points)
    model.fix("x0")
    tip = model.prescribe("x1_lower", "z", name="tip")
    result = uf.solve(model, uf.Move(tip, -1.5, steps=3), frames=0, progress=False)
    assert model.bodies.only.block.state.shape and result["plastic_work"][-1] > 0.0
    motion = RigidMotion.in_section(2.0, np.array([1.0, 0.5]), np.array([4.0, -7.0]))
    still, moved = continued(made(name, points), result), continued(made(name, points), result, motion)
    f = still.evaluate(still.system.x).residual.reshape(-1, 3)
    turned = moved.evaluate(moved.system.x).residual.reshape(-1, 3)
    assert np.abs(f).max() > 1.0
    np.testing.assert_allclose(turned, f @ motion.rotation.T, atol=1e-8 * np.abs(f).max())
    np.testing.assert_allclose(motion.rotation @ motion.rotation.T, np.eye(3), atol=1e-15)


def test_a_point_goes_where_it_is_to_go():
    motion = RigidMotion.in_section(0.5 * np.pi, np.array([1.0, 0.0]), np.array([5.0, 5.0]))
    np.testing.assert_allclose(motion.of(np.array([[1.0, 3.0, 0.0], [2.0, 3.0, 0.0]])), [[5, 3, 5], [5, 3, 6]])

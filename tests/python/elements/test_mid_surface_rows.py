"""Rows tied in the plane at the mid-surface: no element of the catalogue has them, and they go another way."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform import elements
from umform.elements.technology import Element, Tying
from umform.model import Model

IN_PLANE = {"hex8": Tying("11", (0.0,), (-1.0, 1.0)), "hex18": Tying("12", (-0.5, 0.5), (-0.5, 0.5))}


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
@pytest.mark.parametrize("shear", [False, True])
def test_force_and_tangent_are_derivatives_of_the_energy(cell, shear, rng):
    tying = (IN_PLANE[cell], *(elements.ANS_SHEAR if shear else ()))
    element = Element("MINE", cell, tying=tying, surface_points=2 if cell == "hex8" else 3)
    mesh = uf.mesh.strip(length=2.0, width=1.5, thickness=0.7, cells=(1, 1), cell=cell)
    mesh.points[:] += 0.05 * rng.normal(size=mesh.points.shape)
    model = Model(mesh, element, material=uf.SVK(E=210e3, nu=0.3))
    u = 0.05 * rng.normal(size=mesh.points.size)
    K, f = model.bodies.only.block.element(0, u)
    order = (3 * mesh.connectivity[0][:, None] + np.arange(3)).ravel()
    step = 1e-5

    def difference(function, dof):
        forward, backward = u.copy(), u.copy()
        forward[dof] += step
        backward[dof] -= step
        return (function(forward) - function(backward)) / (2.0 * step)

    energy_slope = np.array([difference(lambda v: model.bodies.only.block.energy(v)[0], dof) for dof in order])
    np.testing.assert_allclose(f, energy_slope, atol=1e-7 * np.abs(f).max())
    columns = np.array([difference(lambda v: model.bodies.only.block.element(0, v)[1], dof) for dof in order]).T
    np.testing.assert_allclose(K, columns, atol=1e-7 * np.abs(K).max())

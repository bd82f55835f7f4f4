"""Contact over cells: the tangent, resultants, the edge of contact, work along the way, friction, multipliers."""

from __future__ import annotations

import numpy as np
import pytest

from umform import _core
from umform.errors import InvalidValue
from umform.mesh import grid, strip
from umform.model import Model
from umform.surfaces import Cylinder, Plane, Sphere, UserSurface

PENALTY = 50.0


def ellipsoid(x):
    """sqrt of the form of an ellipsoid less one: no distance, and a gradient that is not of length one."""
    axes, centre = np.array([4.0, 6.0, 3.0]), np.array([1.5, 1.5, -2.9])
    D = np.diag(axes**-2.0)
    y = x - centre
    root = np.sqrt(np.einsum("ni,ij,nj->n", y, D, y))
    n = y @ D / root[:, None]
    H = (D - n[:, :, None] * n[:, None, :]) / root[:, None, None]
    return root - 1.0, n, H


TOOLS = {
    "plane": Plane((1.5, 1.5, -0.02), (0.2, 0.1, 1.0)),
    "cylinder": Cylinder((1.5, 0.0, -4.9), (0.3, 1.0, 0.0), 5.0),
    "bore": Cylinder((1.2, 0.0, 9.95), (0.2, 1.0, 0.0), 10.0, inside=True),
    "sphere": Sphere((1.5, 1.4, -4.9), 5.0),
    "bowl": Sphere((1.5, 1.4, 9.95), 10.0, inside=True),
    "ellipsoid": UserSurface(ellipsoid),
}


def plate(cell="hex8", cells=(3, 3), amount=0.1):
    """A plate of 3 x 3 x 1 above z = 0 whose faces are no rectangles."""
    mesh = strip(3.0, 3.0, 1.0, cells, cell=cell)
    mesh.points[:, 2] += 0.5
    mesh.points[:, :2] += amount * np.sin(2.0 * mesh.points[:, 1::-1] + 0.3)
    return mesh


def block_over(mesh, tool, cells=3, law=None):
    law = _core.penalty_law(PENALTY) if law is None else law
    return _core.contact_cells(mesh.facets("lower"), mesh.points, cells, tool.kernel(), law)


def waved(mesh, rng, amount=0.02):
    return amount * rng.normal(size=mesh.points.size)


def respond(block, u, way=None):
    """Forces on the nodes; with a way what the tangent makes of it."""
    pattern = _core.Pattern(np.arange(u.size, dtype=np.int32), [block.connectivity], block.symmetric)
    f, product, values = np.zeros(u.size), np.zeros(u.size), np.zeros(len(pattern.indices))
    block.evaluate(u, pattern.scatter(block.connectivity), f, values, way, None if way is None else product)
    return (f, product) if way is not None else f


def differences(block, u, way, step=2e-6):
    return (respond(block, u + step * way) - respond(block, u - step * way)) / (2.0 * step)


def assert_exact_tangent(block, mesh, u, rng, tolerance=1e-8):
    """Against fourth-order differences along random ways."""
    for _ in range(4):
        way = rng.normal(size=u.size)
        exact = respond(block, u, way)[1]
        near, far = differences(block, u, way), differences(block, u, way, 4e-6)
        measured = (4.0 * near - far) / 3.0
        assert np.abs(exact).max() > 1.0
        np.testing.assert_allclose(exact, measured, rtol=0, atol=tolerance * np.abs(exact).max())


# The tangent ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
@pytest.mark.parametrize("tool", TOOLS)
def test_the_tangent_is_exact(tool, cell, rng):
    mesh = plate(cell)
    block = block_over(mesh, TOOLS[tool])
    u = waved(mesh, rng)
    respond(block, u)
    share = block.found().share
    assert ((share > 0.0) & (share < 1.0)).any()  # edges of contact pass through cells
    assert_exact_tangent(block, mesh, u, rng)

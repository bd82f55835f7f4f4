"""Meshes and models of several cases."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform import mesh
from umform.materials import SVK
from umform.mesh import Mesh
from umform.model import Model
from umform.model.terms.dead_load import Load
from umform_book.variants import Variant

Floats = NDArray[np.float64]


def hemisphere(cells: int, cell: str = "hex8", *, radius: float = 10.0, thickness: float = 0.04) -> Mesh:
    """Quarter of a hemisphere with an 18 degree hole.

    Sets: x0 the rim of the hole, x1 the equator, y0 in the plane y = 0, y1 in the plane x = 0.
    """
    flat = mesh.strip(1, 1, thickness, (cells, cells), cell=cell)
    return flat.transformed(lambda X: onto_hemisphere(X, radius))


def onto_hemisphere(X: Floats, radius: float) -> Floats:
    """Bend the unit square, z through the thickness, into the quarter of :func:`hemisphere`."""
    polar, azimuth, r = np.radians(18 + 72 * X[:, 0]), 0.5 * np.pi * X[:, 1], radius + X[:, 2]
    ring = r * np.sin(polar)
    return np.column_stack([ring * np.cos(azimuth), ring * np.sin(azimuth), r * np.cos(polar)])


def pinched_hemisphere(
    variant: Variant, divisions: int
) -> tuple[Model, list[Load], NDArray[np.int32], NDArray[np.int32]]:
    """Hemisphere of MacNeal & Harder (1985) and of Sze et al. (2004) with its loads.

    The quarter carries half of each force, half of that on the lower and half on the upper node: inward along x at B,
    outward along y at A.

    Returns
    -------
    model : Model
    loads : list of Load
        Their value is the force on the whole shell.
    at_A, at_B : ndarray of int
        Lower and upper node under the forces.
    """
    shell = hemisphere(variant.cells(divisions), variant.cell)
    model = Model(shell, variant.element, material=SVK(E=6.825e7, nu=0.3))
    model.symmetry("y0", "y")
    model.symmetry("y1", "x")
    at_B, at_A = (np.intersect1d(shell.nodes("x1"), shell.nodes(side)) for side in ("y0", "y1"))
    model.fix(at_B[:1], "z")
    loads = [model.force(at_B, (-0.25, 0, 0), "B"), model.force(at_A, (0, 0.25, 0), "A")]
    return model, loads, at_A, at_B

"""Part of a cylinder, which four of the problems start from."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform import mesh
from umform.mesh import Ids, Mesh
from umform_book.variants import Variant

Floats = NDArray[np.float64]


def sector(
    variant: Variant,
    divisions: tuple[int, int],
    *,
    radius: float,
    length: float,
    thickness: float,
    angles: tuple[float, float] = (0.0, 0.5 * np.pi),
) -> Mesh:
    """Sector of a cylinder around the y axis.

    Parameters
    ----------
    variant : Variant
        Element that is to stand on the mesh.
    divisions : tuple of int
        Intervals between nodes along the ring and along the axis.
    radius, length, thickness : float
        Radius of the mid-surface, length along y from 0, thickness.
    angles : tuple of float
        First and last angle, measured from the z axis towards x.

    Returns
    -------
    Mesh
        Sets: x0 and x1 at the first and the last angle, y0 and y1 at the ends; upper is the outer face.
    """

    def around(X: Floats) -> Floats:
        angle, r = angles[0] + (angles[1] - angles[0]) * X[:, 0], radius + X[:, 2]
        return np.column_stack([r * np.sin(angle), length * X[:, 1], r * np.cos(angle)])

    ring, axial = (variant.cells(number) for number in divisions)
    return mesh.strip(1.0, 1.0, thickness, (ring, axial), cell=variant.cell).transformed(around)


def corner(shell: Mesh, ring: str, end: str) -> Ids:
    """Lower and upper node of a corner of the sector: "x0", "y1" for instance."""
    return np.intersect1d(shell.nodes(ring), shell.nodes(end))

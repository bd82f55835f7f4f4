"""The skin of a formed part for renderers: its outer faces, subdivided by the shape functions of the elements."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.report.part import Part
from umform.report.patches import Surface, unit

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]

#: Largest number of parts of a face along a side, and about how many parts all faces have.
_FINE, _PARTS = 6, 300_000


@dataclass(frozen=True)
class Skin:
    """Subdivided outer faces of a part; each face has its own points, those of neighbours coincide.

    Attributes
    ----------
    points, normals : ndarray, shape (p, 3)
        Points on the faces, and unit normals, smooth between faces but not over edges of the sheet.
    quads : ndarray of int, shape (q, 4)
        Parts of the faces, counter-clockwise from outside.
    values : ndarray, shape (p,) or None
        A field at the points.
    lines : list of ndarray, shape (l, s, 3)
        Edges of the elements, each once, as points along them; those through the thickness are the last.
    middles, directions, areas : ndarray
        Of each face: middle, unit normal, and area by one Gauss point.
    owners : ndarray of int
        Element of each face.
    """

    points: Floats
    normals: Floats
    quads: Ids
    values: Floats | None
    lines: list[Floats]
    middles: Floats
    directions: Floats
    areas: Floats
    owners: Ids


def parts_of(cells: Ids, fine: int = _FINE, parts: int = _PARTS) -> int:
    """Parts of a face along its sides: up to ``fine``, fewer if the elements are many; 2 for 8 nodes."""
    most = fine if cells.shape[1] == 18 else 2
    return int(np.clip(np.sqrt(parts / (2 * len(cells))), 1, most))


def skin_of(part: Part, field: str | None = None, parts: int | None = None, *, factor: float = 1.0) -> Skin:
    """Subdivide the outer faces of a part.

    Parameters
    ----------
    part : Part
        The sheet.
    field : str, optional
        Scalar field: nodal values are interpolated by the shape functions, means of cells at corners bilinearly.
    parts : int, optional
        Parts of a face along its sides; default: those of `parts_of`.
    factor : float
        The values of the field are multiplied by it.
    """
    surface = Surface.of(part.reference, part.cells, parts or parts_of(part.cells))
    points, normals = surface.at(part.points)
    middles, across = surface.middles(part.points)
    values = None
    if field is not None:
        values = factor * surface.values(part.at_corners(field), bilinear=field not in part.nodal)
    return Skin(
        points,
        normals,
        surface.quads,
        values,
        [points[line] for line in surface.lines],
        middles,
        unit(across),
        4.0 * np.linalg.norm(across, axis=1),
        surface.owners,
    )

"""Structured meshes of all kinds of cells between grid lines, and the supports on them."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from problem import Floats, Ids
from umform import mesh
from umform_book.calculix import EDGES


def grid(x: ArrayLike, y: ArrayLike, z: ArrayLike, cell: str) -> tuple[Floats, Ids]:
    """Points and cells between grid lines.

    Parameters
    ----------
    x, y, z : array_like
        Increasing positions of the borders of the cells.
    cell : {"hex8", "hex18", "hex20", "quad4"}
        Kind of cell. The nodes of quad4 lie halfway between the outermost z.
    """
    made = mesh.grid(x, y, z, "hex18" if cell == "hex18" else "hex8")
    points, cells = made.points, made.connectivity.astype(np.int64)
    if cell == "hex20":
        ends, middle = np.unique(np.sort(cells[:, EDGES], axis=2).reshape(-1, 2), axis=0, return_inverse=True)
        return (
            np.concatenate([points, points[ends].mean(axis=1)]),
            np.concatenate([cells, len(points) + middle.reshape(-1, 12)], axis=1),
        )
    if cell == "quad4":
        used, lower = np.unique(cells[:, :4], return_inverse=True)
        points = points[used]
        points[:, 2] = 0.5 * (np.min(z) + np.max(z))
        return points, lower.reshape(-1, 4)
    return points, cells


def held(*rules: tuple[ArrayLike, str]) -> Ids:
    """Rows (node, axis) of supports: masks over the nodes, and the letters of the axes held there.

    The letters u, v, w stand for the rotations about x, y, z.
    """
    rows = []
    for mask, letters in rules:
        nodes = np.flatnonzero(mask)
        rows += [np.stack([nodes, np.full(len(nodes), "xyzuvw".index(letter))], axis=1) for letter in letters]
    return np.unique(np.concatenate(rows), axis=0)

"""Meshes of the linear obstacle course."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from umform import mesh
from umform.mesh import Mesh
from umform_book.variants import Variant

Floats = NDArray[np.float64]


def rectangle(
    variant: Variant, intervals: tuple[int, int], size: tuple[float, float, float], *, layers: int = 1
) -> Mesh:
    """Strip with so many intervals between nodes along x and y; never less than one element.

    Parameters
    ----------
    variant : Variant
        Its cells are taken.
    intervals : tuple of int
        Intervals along x and y.
    size : tuple of float
        Length, width and thickness.
    layers : int
        Elements through the thickness.
    """
    cells = (max(1, variant.cells(intervals[0])), max(1, variant.cells(intervals[1])))
    return mesh.strip(*size, cells, cell=variant.cell, layers=layers)


def cylinder_panel(
    variant: Variant,
    divisions: int,
    *,
    radius: float,
    thickness: float,
    angle: float,
    length: float,
    layers: int = 1,
) -> Mesh:
    """Part of a cylinder along y: x0 is the crown, where the normal is z; x1 lies at the angle (degrees)."""

    def bent(X: Floats) -> Floats:
        a, r = np.radians(angle) * X[:, 0], radius + X[:, 2]
        return np.column_stack([r * np.sin(a), X[:, 1], r * np.cos(a)])

    return rectangle(variant, (divisions, divisions), (1.0, length, thickness), layers=layers).transformed(bent)


def merged(parts: Sequence[Mesh]) -> Mesh:
    """One mesh of several that meet node on node; with the face sets lower and upper."""
    points = np.concatenate([part.points for part in parts])
    size = float(np.ptp(points, axis=0).max())
    _, first, number = np.unique(
        np.round(points / (1e-9 * size)), axis=0, return_index=True, return_inverse=True
    )  # coincident but for round-off
    starts = np.cumsum([0, *(len(part.points) for part in parts)])
    cells = np.concatenate([part.connectivity + start for part, start in zip(parts, starts, strict=False)])
    offsets = np.cumsum([0, *(len(part.connectivity) for part in parts)])
    faces = {
        name: np.concatenate([p.faces[name] + [offset, 0] for p, offset in zip(parts, offsets, strict=False)])
        for name in ("lower", "upper")
    }
    return Mesh(points[first], {parts[0].cell: number.ravel()[cells]}, faces=faces)


def quarter_disc(variant: Variant, divisions: int, radius: float, thickness: float) -> Mesh:
    """Quarter of a disc in three blocks that meet at (0.4, 0.4) of the radius; no element is a parallelogram."""
    a, c = 0.5 * radius, 0.4 * radius

    def core(X: Floats) -> Floats:
        x, y, z = X.T
        stretch = x * y * (c - a)
        return np.column_stack([a * x + stretch, a * y + stretch, z])

    def ring(X: Floats) -> Floats:
        along, turn, z = X.T
        inner = np.column_stack([a + turn * (c - a), turn * c])
        outer = radius * np.column_stack([np.cos(0.25 * np.pi * turn), np.sin(0.25 * np.pi * turn)])
        plane = inner + along[:, None] * (outer - inner)
        return np.column_stack([plane, z])

    def mirrored_ring(X: Floats) -> Floats:
        plane = ring(X * [1, -1, 1] + [0, 1, 0])
        return plane[:, [1, 0, 2]]

    block = rectangle(variant, (divisions, divisions), (1.0, 1.0, thickness))
    maps: list[Callable[[Floats], Floats]] = [core, ring, mirrored_ring]
    return merged([block.transformed(function) for function in maps])

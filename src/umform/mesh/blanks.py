"""Flat blanks of quadrilaterals without degenerate elements: discs and rings, whole, half or a quarter."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Annotated, Literal

import numpy as np
from annotated_types import Ge, Le
from numpy.typing import NDArray

from umform.errors import InvalidValue, WrongCellType
from umform.mesh.generators import Divisions, Layers, Lines, graded
from umform.mesh.mesh import FACE_NODES, Floats, Mesh
from umform.mesh.neighbours import Whole, outer_faces
from umform.spec import About, check_arguments
from umform.spec.types import Positive

#: How far the sides of the core of a disc bulge from straight lines towards a circle.
_BULGE = 0.6
Portion = Literal["whole", "half", "quarter"]


def disc(
    radius: Positive,
    thickness: Positive,
    cells: tuple[Divisions, Divisions],
    *,
    part: Portion = "whole",
    cell: str = "hex8",
    layers: Layers = 1,
    grading: Positive = 1.0,
    core: Annotated[float, Ge(0.05), Le(0.75), About(cause="a length in place of a part of the radius")] = 0.5,
    radii: Lines | None = None,
) -> Mesh:
    """Flat disc about the z-axis, mid-surface at z = 0: a square core in the middle, rings of elements around it.

    Parameters
    ----------
    radius : float
        Radius of the rim.
    thickness : float
        Along z.
    cells : tuple of int
        Elements along a side of the core of a quarter (half of those on a quarter of the rim), and from the core to
        the rim.
    part : {"whole", "half", "quarter"}
        A half has x >= 0, a quarter y >= 0 as well.
    cell : {"hex8", "hex18"}
        Cell type.
    layers : int
        Elements through the thickness.
    grading : float
        Ratio of the last to the first element size, from the core to the rim.
    core : float
        Half-width of the core, relative to the radius.
    radii : sequence of float, optional
        Radii of the rings, from ``core * radius`` to ``radius``, in place of the second number of cells and the
        grading.

    Returns
    -------
    Mesh
        With face sets ``lower`` and ``upper``, and node sets ``rim``, ``centre``, of parts ``x0`` and ``y0``, each also
        with ``_lower`` and ``_upper``.

    Raises
    ------
    InvalidValue
        If a number is out of range.
    """
    _check_cells(cells)
    check_arguments(disc, radius=radius, thickness=thickness, part=part, layers=layers, core=core)
    sides, rings = cells
    order = order_of(cell)
    square = np.linspace(0.0, 1.0, sides * order + 1)
    u, v = np.meshgrid(square, square, indexing="ij")
    round_ = np.stack([u * np.sqrt(1.0 - 0.5 * v * v), v * np.sqrt(1.0 - 0.5 * u * u)], axis=-1)
    straight = np.stack([u, v], axis=-1) / math.sqrt(2.0) * 1.15
    middle = core * radius * (_BULGE * round_ + (1.0 - _BULGE) * straight)
    out = _along(1.0, rings, grading, order) if radii is None else _parts_of(radii, core * radius, radius, order)
    patches = [middle]
    for edge, angles in ((middle[-1], 0.25 * math.pi * square), (middle[::-1, -1], 0.25 * math.pi * (1.0 + square))):
        arc = radius * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
        patches.append(edge[None] + out[:, None, None] * (arc - edge)[None])
    points, quads = _joined(patches, part, order, 1e-9 * radius)
    far = np.hypot(*points.T)
    sets = {"rim": far > radius * (1 - 1e-9), "centre": far < radius * 1e-9}
    return stacked(points, quads, thickness, layers, sets | _symmetry(points, part, 1e-9 * radius), cell)


def ring(
    inner: Positive,
    outer: Positive,
    thickness: Positive,
    cells: tuple[Divisions, Divisions],
    *,
    part: Portion = "whole",
    cell: str = "hex8",
    layers: Layers = 1,
    grading: Positive = 1.0,
) -> Mesh:
    """Flat ring about the z-axis, mid-surface at z = 0.

    Parameters
    ----------
    inner : float
        Radius of the hole.
    outer : float
        Radius of the rim.
    thickness : float
        Along z.
    cells : tuple of int
        Elements on a quarter of the circle, and from the hole to the rim.
    part, cell, layers
        As for :func:`disc`.
    grading : float
        Ratio of the last to the first element size, from the hole to the rim.

    Returns
    -------
    Mesh
        As :func:`disc`, with the node set ``hole`` in place of ``centre``.

    Raises
    ------
    InvalidValue
        If a number is out of range.
    """
    _check_cells(cells)
    check_arguments(ring, inner=inner, outer=outer, thickness=thickness, part=part, layers=layers)
    if not inner < outer:
        raise InvalidValue(
            "the outer radius of a ring is larger than the inner one",
            where="ring",
            value=f"inner {inner:g}, outer {outer:g}",
            cause="the two exchanged, or a width in place of a radius",
            remedy="inner=10.0, outer=30.0",
        )
    around, rings = cells
    order = order_of(cell)
    angles = np.linspace(0.0, 0.5 * math.pi, around * order + 1)
    radii = inner + _along(outer - inner, rings, grading, order)
    arcs = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    points, quads = _joined([radii[:, None, None] * arcs[None]], part, order, 1e-9 * outer)
    far = np.hypot(*points.T)
    sets = {"rim": far > outer * (1 - 1e-9), "hole": far < inner * (1 + 1e-9)}
    return stacked(points, quads, thickness, layers, sets | _symmetry(points, part, 1e-9 * outer), cell)


def _along(length: float, cells: int, grading: float, order: int) -> Floats:
    """Nodes on a graded line that starts at 0; middle nodes of 18-node cells lie half-way."""
    ends = graded(length, cells, grading)
    return ends if order == 1 else np.sort(np.concatenate([ends, 0.5 * (ends[1:] + ends[:-1])]))


def _parts_of(radii: Lines, first: float, last: float, order: int) -> Floats:
    """Radii of rings as parts of the way from the core to the rim, with middle nodes half-way."""
    given = np.asarray(radii, dtype=float)
    ends = np.ptp(given) if given.ndim == 1 and len(given) > 1 else 0.0
    if not ends > 0 or (np.diff(given) <= 0).any() or np.abs(given[[0, -1]] - (first, last)).max() > 1e-6 * last:
        raise InvalidValue(
            "radii of rings ascend from the core to the rim",
            where="disc, radii",
            value=radii,
            cause="another core, or radii that are not sorted",
            remedy=f"from {first:g} to {last:g}",
        )
    parts = (given - given[0]) / ends
    return parts if order == 1 else np.sort(np.concatenate([parts, 0.5 * (parts[1:] + parts[:-1])]))


def _joined(patches: Sequence[Floats], part: str, order: int, tolerance: float) -> tuple[Floats, Whole]:
    """Points (n, 2) and quadrilaterals of patches (i, j, 2) of a quarter, mirrored for a half or the whole."""
    mirrored = list(patches)
    if part != "quarter":  # exchanging the directions of a patch restores the orientation of its mirror image
        mirrored += [np.swapaxes(patch * (1.0, -1.0), 0, 1) for patch in mirrored]
    if part == "whole":
        mirrored += [np.swapaxes(patch * (-1.0, 1.0), 0, 1) for patch in mirrored]
    offsets = ((FACE_NODES[: 4 if order == 1 else 9] + 1) / 2 * order).astype(int)
    points, quads, count = [], [], 0
    for patch in mirrored:
        number = count + np.arange(patch.shape[0] * patch.shape[1]).reshape(patch.shape[:2])
        starts = (np.arange(0, size - 1, order) for size in patch.shape[:2])
        i, j = (index.ravel() for index in np.meshgrid(*starts, indexing="ij"))
        quads.append(np.stack([number[i + a, j + b] for a, b in offsets], axis=1))
        points.append(patch.reshape(-1, 2))
        count += number.size
    X = np.concatenate(points)
    X[np.abs(X) < tolerance] = 0.0
    _, first, same = np.unique(np.round(X / tolerance), axis=0, return_index=True, return_inverse=True)
    return X[first], same.ravel()[np.concatenate(quads)]


def _symmetry(points: Floats, part: str, tolerance: float) -> dict[str, NDArray[np.bool_]]:
    """Nodes of the planes of symmetry of a part."""
    on = {"x0": np.abs(points[:, 0]) < tolerance, "y0": np.abs(points[:, 1]) < tolerance}
    return {} if part == "whole" else {"x0": on["x0"]} if part == "half" else on


def stacked(
    points: Floats, quads: Whole, thickness: float, layers: int, sets: Mapping[str, NDArray[np.bool_]], cell: str
) -> Mesh:
    """Layers of cells above each other."""
    count, heights = len(points), graded(thickness, layers) - 0.5 * thickness
    nodes = np.concatenate([np.column_stack([points, np.full(count, z)]) for z in heights])
    bottom = np.concatenate([quads + layer * count for layer in range(layers)])
    cells = np.concatenate([bottom, bottom + count], axis=1).astype(np.int32)
    named: dict[str, Whole] = {}
    for name, chosen in sets.items():
        ids = np.flatnonzero(chosen)
        named[name] = np.concatenate([ids + layer * count for layer in range(layers + 1)])
        named[f"{name}_lower"], named[f"{name}_upper"] = ids, ids + layers * count
    return Mesh(nodes, {cell: cells}, named, outer_faces(cells))


def order_of(cell: str) -> int:
    """Order of the element sides of a cell type."""
    if cell not in ("hex8", "hex18"):
        raise WrongCellType(
            "unknown cell type",
            where="cell",
            value=cell,
            cause="a typing mistake, or a name of another program",
            remedy="hex8 or hex18",
        )
    return 1 if cell == "hex8" else 2


def _check_cells(cells: tuple[int, int]) -> None:
    if not isinstance(cells, tuple | list) or len(cells) != 2 or min(cells) < 1:
        raise InvalidValue(
            "cells are two numbers, both at least 1",
            where="cells",
            value=cells,
            cause="one number for both directions, or none along one",
            remedy="cells=(8, 6)",
        )

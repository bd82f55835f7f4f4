"""Structured meshes: graded grids, strips and plates."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from annotated_types import Ge, Le, MaxLen, MinLen
from numpy.typing import ArrayLike

from umform.errors import InvalidValue, WrongCellType
from umform.mesh.mesh import FACE_NODES, Floats, Mesh
from umform.mesh.numbers import common
from umform.spec import About, InDeck, check_arguments
from umform.spec.types import Positive

#: Number of elements along a line, and through the thickness.
Divisions = Annotated[int, Ge(1), Le(100_000), About(cause="a fraction, or a sign")]
Layers = Annotated[int, Ge(1), Le(100), About(cause="a fraction, or a sign")]
#: Positions of grid lines.
Lines = Annotated[ArrayLike, InDeck(Annotated[list[float], MinLen(2), MaxLen(100_001)])]


def graded(length: Positive, cells: Divisions, ratio: Positive = 1.0) -> Floats:
    """Grid lines from 0 to a length.

    Parameters
    ----------
    length : float
        Position of the last line.
    cells : int
        Number of intervals.
    ratio : float
        Ratio of the last to the first interval; they grow geometrically.

    Returns
    -------
    ndarray, shape (cells + 1,)
        Positions of the lines.
    """
    check_arguments(graded, length=length, cells=cells, ratio=ratio)
    steps = ratio ** (np.arange(cells) / max(cells - 1, 1))
    return np.concatenate([[0.0], np.cumsum(steps) / steps.sum()]) * length


def grid(x: Lines, y: Lines, z: Lines, cell: str = "hex8", thickness: Positive | None = None) -> Mesh:
    """Structured mesh from grid lines.

    Parameters
    ----------
    x, y : array_like
        Borders of the elements, increasing.
    z : array_like
        Borders of the layers, increasing.
    cell : {"hex8", "hex18"}
        Cell type.
    thickness : float, optional
        Thickness of all layers: z is scaled to it, its first border stays. Default: as z says.

    Returns
    -------
    Mesh
        With node and face sets x0, x1, y0, y1, lower, upper, and node sets x0_lower, x0_upper, ... for their edges.
    """
    check_arguments(grid, thickness=thickness)
    lines = []
    for name, given in (("x", x), ("y", y), ("z", z)):
        try:
            values = np.asarray(given, dtype=float)
        except (TypeError, ValueError):  # words, for instance
            values = np.empty(0)
        if values.ndim != 1 or len(values) < 2 or not (np.diff(values) > 0).all():
            raise InvalidValue(
                "grid lines must increase",
                where=name,
                value=given,
                cause="a length in place of lines, one line, or a value twice",
                remedy="two lines or more, such as [0.0, 5.0, 10.0]",
            )
        lines.append(values)
    if thickness is not None and thickness != np.ptp(lines[2]):
        lines[2] = lines[2][0] + (lines[2] - lines[2][0]) * (thickness / np.ptp(lines[2]))
    if cell not in ("hex8", "hex18"):
        raise WrongCellType(
            "unknown cell type",
            where="cell",
            value=cell,
            cause="a typing mistake, or a name of another program",
            remedy="hex8 or hex18",
        )
    per_cell = 1 if cell == "hex8" else 2
    if per_cell == 2:
        for axis in (0, 1):
            middles = 0.5 * (lines[axis][1:] + lines[axis][:-1])
            lines[axis] = np.sort(np.concatenate([lines[axis], middles]))
    nx, ny, nz = (len(values) for values in lines)
    points = np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, 3)
    number = np.arange(nx * ny * nz, dtype=np.int32).reshape(nx, ny, nz)

    offsets = ((FACE_NODES[: 4 if per_cell == 1 else 9] + 1) / 2 * per_cell).astype(int)
    ix, iy, iz = (
        a.ravel()
        for a in np.meshgrid(
            np.arange(0, nx - 1, per_cell), np.arange(0, ny - 1, per_cell), np.arange(nz - 1), indexing="ij"
        )
    )
    cells = np.stack([number[ix + dx, iy + dy, iz + dz] for dz in (0, 1) for dx, dy in offsets], axis=1)

    planes = {
        "x0": number[0],
        "x1": number[-1],
        "y0": number[:, 0],
        "y1": number[:, -1],
        "lower": number[..., 0],
        "upper": number[..., -1],
    }
    sets = {name: ids.ravel() for name, ids in planes.items()}
    for name in ("x0", "x1", "y0", "y1"):
        for side in ("lower", "upper"):
            sets[f"{name}_{side}"] = common(sets[name], sets[side])
    where = {
        "x0": (ix == 0, 2),
        "x1": (ix == ix.max(), 3),
        "y0": (iy == 0, 4),
        "y1": (iy == iy.max(), 5),
        "lower": (iz == 0, 0),
        "upper": (iz == iz.max(), 1),
    }
    faces = {
        name: np.stack([np.flatnonzero(hit), np.full(hit.sum(), face)], axis=1) for name, (hit, face) in where.items()
    }
    return Mesh(points, {cell: cells}, sets, faces)


def strip(
    length: Positive,
    width: Positive,
    thickness: Positive,
    cells: tuple[Divisions, Divisions],
    *,
    cell: str = "hex8",
    layers: Layers = 1,
    grading: tuple[float, float] = (1.0, 1.0),
) -> Mesh:
    """Flat strip or plate: x from 0 to length, y from 0 to width, mid-surface at z = 0.

    Parameters
    ----------
    length : float
        Along x.
    width : float
        Along y.
    thickness : float
        Along z.
    cells : tuple of int
        Elements along x and y.
    cell : {"hex8", "hex18"}
        Cell type.
    layers : int
        Elements through the thickness.
    grading : tuple of float
        Ratio of the last to the first element size, along x and y.
    """
    if not isinstance(cells, tuple | list) or len(cells) != 2:
        raise InvalidValue(
            "cells are two numbers, along x and y",
            where="cells",
            value=cells,
            cause="one number for both directions, or one through the thickness, which is layers",
            remedy="cells=(24, 1)",
        )
    if np.shape(grading) != (2,):
        raise InvalidValue(
            "gradings are two numbers, along x and y",
            where="grading",
            value=grading,
            cause="one number for both directions",
            remedy="grading=(2.0, 1.0)",
        )
    check_arguments(strip, layers=layers)
    return grid(
        graded(length, cells[0], grading[0]),
        graded(width, cells[1], grading[1]),
        graded(thickness, layers) - 0.5 * thickness,
        cell,
    )


#: A plate is a wide strip.
plate = strip

"""First places in the flat: a conformal map, or one onto a disc that cannot fold."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue, SingularMatrix
from umform.flat_pattern.one_step.equations import Equations, between_corners
from umform.flat_pattern.one_step.part import Sheet
from umform.flat_pattern.one_step.strain import Formed, areas, flat_sides
from umform.solvers import Pattern, make_solver

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]

#: Ratio of smallest to mean area below which a map is not taken.
_LEAST = 1e-7


def first_places(sheet: Sheet, formed: Formed) -> Floats:
    """Places of all points in the flat, with positive areas of all triangles and the area of the part. eq. (6.7)"""
    for make in (conformal, onto_disc):
        X = make(sheet, formed)
        if X is None:
            continue
        A = areas(flat_sides(X, sheet.triangles))
        if A.min() > _LEAST * A.mean():
            return np.asarray(X * np.sqrt(formed.area.sum() / A.sum()))
    raise AssertionError("a map onto a disc cannot fold")


def conformal(sheet: Sheet, formed: Formed) -> Floats | None:
    """Least-squares conformal map, two far points of the outer edge held; None if it is not determined."""
    points, triangles = sheet.points, sheet.triangles
    loop = sheet.loops[0]
    ends = _far_apart(points[loop])
    a, b = loop[ends[0]], loop[ends[1]]
    held = np.zeros(2 * len(points), dtype=bool)
    held[[2 * a, 2 * a + 1, 2 * b, 2 * b + 1]] = True
    equations = Equations(len(points), triangles, held, symmetric=True)
    hessian = np.zeros((len(triangles), 4, 4))
    laplacian = formed.area[:, None, None] * formed.inverse
    hessian[:, :2, :2] = hessian[:, 2:, 2:] = laplacian
    turn = np.array([[0.0, 0.5], [-0.5, 0.0]])
    hessian[:, :2, 2:] -= turn
    hessian[:, 2:, :2] -= turn.T
    matrices = between_corners(hessian)
    X = np.zeros(2 * len(points))
    X[2 * b] = float(np.linalg.norm(points[b] - points[a]))
    rhs = -equations.columns(matrices, np.array([2 * b])) @ X[[2 * b]]
    solver = make_solver(equations.pattern)
    try:
        solver.factor(equations.matrix(matrices))
    except SingularMatrix:
        return None
    X[equations.free] = solver.solve(rhs[equations.free])
    return X.reshape(-1, 2)


def _far_apart(points: Floats) -> tuple[int, int]:
    first = int(np.linalg.norm(points - points.mean(axis=0), axis=1).argmax())
    return first, int(np.linalg.norm(points - points[first], axis=1).argmax())


def with_outline(sheet: Sheet, formed: Formed) -> Floats:
    """Places whose outer edge is that of the part, seen along z.

    Raises
    ------
    InvalidValue
        If triangles fold: an outline with notches, or one that is not flat.
    """
    outline = sheet.points[sheet.loops[0], :2]
    for X in (onto_disc(sheet, formed, outline), sheet.points[:, :2]):
        A = areas(flat_sides(X, sheet.triangles))
        if A.min() > _LEAST * abs(A).mean():
            return X.copy()
    raise InvalidValue(
        "the clamped outline cannot be filled by the flat sheet",
        where="clamped",
        cause="an outline with deep notches, or a part that is not seen from above along z",
        remedy="turn the part so that the punch moves along z; leave the outline free",
    )


def onto_disc(sheet: Sheet, formed: Formed, outline: Floats | None = None) -> Floats:
    """Each inner point in the middle of its neighbours, the outer edge on a circle (Tutte 1963); holes are filled."""
    del formed
    count, holes = len(sheet.points), sheet.loops[1:]
    links = [sheet.triangles[:, [0, 1]], sheet.triangles[:, [1, 2]], sheet.triangles[:, [2, 0]]]
    links += [np.c_[np.full(len(hole), count + k), hole] for k, hole in enumerate(holes)]
    ends = np.unique(np.sort(np.concatenate(links), axis=1), axis=0)
    total, loop = count + len(holes), sheet.loops[0]
    x = np.zeros((total, 2))
    lengths = np.linalg.norm(np.diff(sheet.points[[*loop, loop[0]]], axis=0), axis=1)
    angle = 2.0 * np.pi * np.concatenate([[0.0], np.cumsum(lengths)[:-1]]) / lengths.sum()
    x[loop] = np.stack([np.cos(angle), np.sin(angle)], axis=1) if outline is None else outline
    inner = np.setdiff1d(np.arange(total), loop)
    if len(inner):
        number = np.full(total, -1)
        number[inner] = np.arange(len(inner))
        x[inner] = _middles(ends, number, x, len(inner))
    return x[:count]


def _middles(ends: Ids, number: Ids, x: Floats, size: int) -> Floats:
    a, b = number[ends].T
    degree = np.bincount(number[ends][number[ends] >= 0], minlength=size)
    both = (a >= 0) & (b >= 0)
    low, high = np.minimum(a, b)[both], np.maximum(a, b)[both]
    rows = np.concatenate([np.arange(size), low])
    columns = np.concatenate([np.arange(size), high])
    values = np.concatenate([degree.astype(float), -np.ones(len(low))])
    order = np.lexsort((columns, rows))
    starts = np.searchsorted(rows[order], np.arange(size + 1))
    pattern = Pattern(size, starts.astype(np.int32), columns[order].astype(np.int32), symmetric=True)
    rhs = np.zeros((size, 2))
    for one, other in (ends.T, ends.T[::-1]):
        known = (number[one] >= 0) & (number[other] < 0)
        np.add.at(rhs, number[one[known]], x[other[known]])
    solver = make_solver(pattern)
    solver.factor(values[order])
    return solver.solve(rhs)

"""Reject cells without a positive volume, and name the probable cause."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.errors import FoldedElement, InvertedElement, WrongNodeOrder

Floats = NDArray[np.float64]
Ids = NDArray[np.int32]

#: Cells per batch: their base vectors take twenty times the memory of the mesh.
_AT_ONCE = 1 << 14


def jacobians(points: Floats, cells: Ids) -> Floats:
    """Determinants of the Jacobian at the Gauss points and corners of all cells, shape (cells, points)."""
    gauss = _core.gauss(2 if cells.shape[1] == 8 else 3)[0]
    samples = [
        np.stack(np.meshgrid(a, a, a[[0, -1]], indexing="ij"), axis=-1).reshape(-1, 3)
        for a in (gauss, np.array([-1.0, 1.0]))
    ]
    _, dN = _core.shell_functions(cells.shape[1], np.concatenate(samples))
    parts = range(0, max(len(cells), 1), _AT_ONCE)
    return np.concatenate([_determinants(dN, points[cells[k : k + _AT_ONCE]]) for k in parts])


def _determinants(dN: Floats, X: Floats) -> Floats:
    """Triple products of the base vectors: derivatives (points, 3, nodes) times positions (cells, nodes, 3)."""
    g = (dN.reshape(-1, dN.shape[-1]) @ X).reshape(len(X), len(dN), 3, 3)
    (a, b, c), (d, e, f), (u, v, w) = (np.moveaxis(g[:, :, i], -1, 0) for i in range(3))
    determinants: Floats = a * (e * w - f * v) + b * (f * u - d * w) + c * (d * v - e * u)
    return determinants


def _other_orders(nodes: int) -> dict[str, Ids]:
    """Common node orders of other programs, as permutations to the order used here."""
    half = nodes // 2
    lower, upper = np.arange(half), np.arange(half, nodes)
    orders = {
        "upper face first, or faces numbered clockwise": np.concatenate([upper, lower]),
    }
    if nodes == 8:
        orders["nodes numbered line by line"] = np.array([0, 1, 3, 2, 4, 5, 7, 6])
    else:
        orders["nodes numbered line by line"] = np.array([0, 2, 8, 6, 1, 5, 7, 3, 4, 9, 11, 17, 15, 10, 14, 16, 12, 13])
    return {name: order.astype(np.int32) for name, order in orders.items()}


def check_cells(points: Floats, cells: Ids) -> None:
    """Reject inverted and folded cells.

    Raises
    ------
    WrongNodeOrder
        If all cells are invalid but valid in another node order.
    InvertedElement
        If a cell has a negative volume.
    FoldedElement
        If a cell is folded over itself or flat.
    """
    if not any(_bad(jacobians(points, cells[k : k + _AT_ONCE])).any() for k in range(0, len(cells), _AT_ONCE)):
        return
    J = jacobians(points, cells)
    bad = _bad(J)
    if bad.any(axis=1).all():
        for name, order in _other_orders(cells.shape[1]).items():
            if (jacobians(points, cells[:, order]) > 0).all():
                raise WrongNodeOrder(
                    "the nodes of the cells are in another order than umform's",
                    where=f"all {len(cells)} cells",
                    cause=name,
                    remedy=f"reorder the columns of the connectivity: cells[:, {order.tolist()}]",
                )
    cell = int(np.flatnonzero(bad.any(axis=1))[0])
    where = f"cell {cell} (one of {int(bad.any(axis=1).sum())}), nodes {cells[cell].tolist()}"
    value = f"det J from {J[cell].min():.3g} to {J[cell].max():.3g}"
    if (J[cell] < 0).all():
        raise InvertedElement(
            "a cell is turned inside out",
            where=where,
            value=value,
            cause="lower and upper face exchanged, or nodes numbered clockwise",
            remedy="number the lower face counter-clockwise seen from the upper one",
        )
    raise FoldedElement(
        "a cell is folded or flat",
        where=where,
        value=value,
        cause="two nodes exchanged or at the same place, a warped face, or no thickness",
        remedy="look at the nodes of this cell; a mid-side node of hex18 must lie near the middle of its side",
    )


def _bad(J: Floats) -> NDArray[np.bool_]:
    """Where a cell has no positive volume."""
    bad: NDArray[np.bool_] = ~(1e-10 * np.abs(J).max(axis=1, keepdims=True) < J)
    return bad

"""Select cells of a body by indices, a mask, a predicate, or a set of nodes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.errors import EmptySet, InvalidValue
from umform.mesh import Mesh

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]

#: Cells: their indices, a mask, a predicate of the coordinates x, y, z of their centres, or the name of a set that has
#: all of their nodes, as a sheet of :func:`umform.mesh.together`.
Cells = ArrayLike | Callable[[Floats, Floats, Floats], Any]


def cell_numbers(mesh: Mesh, cells: Cells | None, name: str) -> Numbers:
    """Sorted indices of selected cells."""
    count = len(mesh.connectivity)
    if cells is None:
        return np.arange(count)
    if callable(cells):
        found = np.asarray(cells(*mesh.points[mesh.connectivity].mean(axis=1).T))
        if found.dtype != bool or found.shape not in ((), (count,)):
            raise InvalidValue(
                "a predicate of x, y, z returns True or False for each cell",
                where=f"body {name}",
                value=f"{found.dtype} of shape {found.shape}",
                cause="coordinates or numbers in place of truth values",
                remedy="lambda x, y, z: x > 5.0",
            )
        cells = np.broadcast_to(found, count)
    if isinstance(cells, str):
        inside = np.zeros(len(mesh.points), dtype=bool)
        inside[mesh.nodes(cells)] = True
        cells = inside[mesh.connectivity].all(axis=1)
    chosen = np.asarray(cells)
    if chosen.dtype == bool and chosen.shape != (count,):
        raise InvalidValue(
            "a mask of cells has one entry for each cell",
            where=f"body {name}",
            value=chosen.shape,
            cause="a mask of nodes, or of another mesh",
            remedy=f"shape ({count},)",
        )
    if chosen.size and chosen.dtype != bool and not np.issubdtype(chosen.dtype, np.integer):
        raise InvalidValue(
            "cells of a body are whole numbers, a mask, a predicate, or the name of a set",
            where=f"body {name}",
            value=f"{chosen.dtype} of shape {chosen.shape}",
            cause="coordinates or fractions in place of the numbers of cells",
            remedy="cells=[0, 1, 2]",
        )
    numbers = np.flatnonzero(chosen) if chosen.dtype == bool else np.unique(chosen.astype(np.int64))
    if len(numbers) == 0:
        raise EmptySet(
            "a body has no cell",
            where=f"body {name}",
            cause="a comparison of real numbers without a tolerance, or an empty list",
            remedy="look at its predicate or its numbers",
        )
    if numbers[0] < 0 or numbers[-1] >= count:
        raise InvalidValue(
            "a cell of a body does not exist",
            where=f"body {name}",
            value=int(numbers[0] if numbers[0] < 0 else numbers[-1]),
            cause="numbers that start at 1, or those of another mesh",
            remedy=f"0 to {count - 1}",
        )
    return numbers

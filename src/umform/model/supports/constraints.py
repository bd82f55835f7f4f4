"""Linear constraints on a few degrees of freedom each: weights, and the value of the weighted sum.

Rows that share a degree of freedom form a group. An orthonormal basis of its null space gives the columns of T, and the
displacement of least norm that satisfies the rows gives c in u = T q + c. docs/theory, 5.10, eqs. (5.41)-(5.43)
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.mesh import Ids
from umform.mesh.neighbours import connected
from umform.model.terms.control import Control

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]

#: Singular values of a group below this belong to redundant rows; weights are of order one.
_DEPENDENT = 1e-9


@dataclass(frozen=True)
class Rows:
    """Constraints of one support in one direction.

    Attributes
    ----------
    dofs : ndarray of int, shape (k, m)
        Degrees of freedom of each constraint.
    weights : ndarray, shape (k, m)
        Their weights.
    control : Control or None
        Value of the weighted sums; zero without a control.
    by : str
        Name of the support.
    offsets : ndarray, shape (k,), optional
        Constant values of the sums, in addition to the control.
    """

    dofs: Ids
    weights: Floats
    control: Control | None
    by: str
    offsets: Floats | None = None


class Groups:
    """Rows that share degrees of freedom, by groups.

    Parameters
    ----------
    constrained : ndarray of bool, shape (3 n,)
        Degrees of freedom that are held or prescribed individually; the rows do not affect them.
    rows : sequence of Rows
        The constraints.

    Attributes
    ----------
    dofs : ndarray of int, shape (m,)
        Degrees of freedom in groups.
    count : int
        Number of their remaining unknowns.
    unknown, place, weight : ndarray
        The entries of T over them: weight of an unknown (0 ... count - 1) in the degree of freedom dofs[place].
    """

    def __init__(self, constrained: NDArray[np.bool_], rows: Sequence[Rows]) -> None:
        self.rows = list(rows)
        numbers = np.cumsum([0, *(len(part.dofs) for part in self.rows)])
        self._spans = list(zip(numbers[:-1].tolist(), numbers[1:].tolist(), strict=True))
        entry_row = _joined([np.repeat(np.arange(a, b), r.dofs.shape[1]) for r, (a, b) in self._pairs()])
        entry_dof = _joined([part.dofs.ravel() for part in self.rows])
        weight = np.concatenate([np.empty(0), *(part.weights.ravel() for part in self.rows)])
        free = ~constrained[entry_dof] & (weight != 0.0)
        self._all = entry_row, entry_dof, weight, int(numbers[-1])
        self._held = entry_row[~free], entry_dof[~free], weight[~free]
        self.dofs, entry_place = np.unique(entry_dof[free], return_inverse=True)
        self._reduce(entry_row[free], entry_place.astype(np.int64), weight[free])

    def _pairs(self) -> list[tuple[Rows, tuple[int, int]]]:
        return list(zip(self.rows, self._spans, strict=True))

    def _reduce(self, row: Numbers, place: Numbers, weight: Floats) -> None:
        """Null space and pseudo-inverse of each group, those of the same size together."""
        self.count, self.unknown, self.place, self.weight = 0, *_stacked([])
        self._inverse = _stacked([])
        if len(self.dofs) == 0:
            return
        count, size = self._all[3], len(self.dofs)
        group = connected(count + size, np.stack([row, count + place], axis=1))
        groups = int(group.max()) + 1
        rows_in, at_row = _counted(group[:count], groups)
        dofs_in, at_dof = _counted(group[count:], groups)
        columns: list[tuple[Numbers, Numbers, Floats]] = []
        inverse: list[tuple[Numbers, Numbers, Floats]] = []
        for r, m in sorted(set(zip(rows_in.tolist(), dofs_in.tolist(), strict=True))):
            if r == 0 or m == 0:
                continue
            alike = np.flatnonzero((rows_in == r) & (dofs_in == m))
            matrix = np.zeros((len(alike), r, m))
            number = np.full(groups, -1)
            number[alike] = np.arange(len(alike))
            mine = number[group[row]] >= 0
            np.add.at(matrix, (number[group[row[mine]]], at_row[row[mine]], at_dof[place[mine]]), weight[mine])
            their_rows, their_dofs = (np.argsort(g, kind="stable") for g in (group[:count], group[count:]))
            row_of = their_rows[np.isin(group[:count][their_rows], alike)].reshape(-1, r)
            dof_of = their_dofs[np.isin(group[count:][their_dofs], alike)].reshape(-1, m)
            u, s, vt = np.linalg.svd(matrix, full_matrices=True)
            ranks = (s > _DEPENDENT).sum(axis=1)
            for rank in np.unique(ranks):
                of_rank = ranks == rank
                null = vt[of_rank, rank:]
                unknown = self.count + np.arange(null.shape[0] * null.shape[1]).reshape(null.shape[:2])
                self.count += unknown.size
                columns.append(_entries(unknown[:, :, None], dof_of[of_rank][:, None, :], null))
                solve = np.einsum("gkm,gk,grk->gmr", vt[of_rank, :rank], 1.0 / s[of_rank, :rank], u[of_rank, :, :rank])
                inverse.append(_entries(dof_of[of_rank][:, :, None], row_of[of_rank][:, None, :], solve))
        self.unknown, self.place, self.weight = _stacked(columns)
        self._inverse = _stacked(inverse)

    def restrict(self, r: Floats) -> Floats:
        """Reduce a vector at all degrees of freedom to the unknowns."""
        weights = self.weight * r[self.dofs[self.place]]
        return np.bincount(self.unknown, weights=weights, minlength=self.count)[: self.count].astype(np.float64)

    def extend(self, x: Floats, u: Floats) -> None:
        """Write the displacement of the degrees of freedom in groups for given unknowns to u."""
        u[self.dofs] = np.bincount(self.place, weights=self.weight * x[self.unknown], minlength=len(self.dofs))

    def prescribe(self, values: Mapping[Control, float], u: Floats, offsets: bool) -> None:
        """Write the displacement of least norm that satisfies the rows to u.

        Parameters
        ----------
        values : mapping of Control to float
            Values of the controls, zero for missing ones.
        u : ndarray, shape (3 n,)
            Contains the displacement of individually held or prescribed degrees of freedom.
        offsets : bool
            Whether to apply the offsets of the rows.
        """
        if len(self.dofs) == 0:
            return
        wanted = self._wanted(values, offsets)
        row, dof, weight = self._held
        wanted -= np.bincount(row, weights=weight * u[dof], minlength=len(wanted))
        place, row, factor = self._inverse
        u[self.dofs] = np.bincount(place, weights=factor * wanted[row], minlength=len(self.dofs))

    def missed(self, values: Mapping[Control, float], u: Floats, offsets: bool) -> tuple[Rows, int] | None:
        """Find a constraint that a displacement from :meth:`prescribe` violates because it contradicts another one."""
        wanted = self._wanted(values, offsets)
        row, dof, weight, count = self._all
        off = np.abs(np.bincount(row, weights=weight * u[dof], minlength=count) - wanted)
        scale = max(float(np.abs(wanted).max(initial=0.0)), float(np.abs(u).max(initial=0.0)))
        wrong = np.flatnonzero(off > 1e-8 * scale)
        if len(wrong) == 0:
            return None
        return next((part, int(wrong[0]) - a) for part, (a, b) in self._pairs() if a <= wrong[0] < b)

    def _wanted(self, values: Mapping[Control, float], offsets: bool) -> Floats:
        wanted = np.zeros(self._all[3])
        for part, (a, b) in self._pairs():
            if part.control is not None:
                wanted[a:b] = values.get(part.control, 0.0)
            if offsets and part.offsets is not None:
                wanted[a:b] += part.offsets
        return wanted


def _joined(parts: Sequence[NDArray[np.integer]]) -> Numbers:
    return np.concatenate([np.empty(0, dtype=np.int64), *parts]).astype(np.int64)


def _counted(group: NDArray[np.integer], groups: int) -> tuple[Numbers, Numbers]:
    """How many members each group has, and the position of each member in its group."""
    sizes = np.bincount(group, minlength=groups)
    order = np.argsort(group, kind="stable")
    position = np.empty(len(group), dtype=np.int64)
    position[order] = np.arange(len(group)) - (np.cumsum(sizes) - sizes)[group[order]]
    return sizes.astype(np.int64), position


def _entries(one: Numbers, other: Numbers, values: Floats) -> tuple[Numbers, Numbers, Floats]:
    """Row, column and value of the entries that are not negligible."""
    one, other = np.broadcast_arrays(one, other)
    some = np.abs(values) > 1e-15
    return one[some], other[some], values[some]


def _stacked(parts: Sequence[tuple[Numbers, Numbers, Floats]]) -> tuple[Numbers, Numbers, Floats]:
    rows, columns, values = zip(*parts, strict=True) if parts else ((), (), ())
    return _joined(rows), _joined(columns), np.concatenate([np.empty(0), *values])

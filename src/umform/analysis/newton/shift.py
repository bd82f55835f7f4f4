"""Find a stable equilibrium where the tangent is indefinite: factorise K + s 1 instead. eq. (5.54)

When a contact point opens, the sheet may lose its stability: no equilibrium is near, and Newton's method alternates
between states with the point and without it. With a positive definite matrix each increment is a descent direction, and
the line search leads to the next stable equilibrium. There the tangent is positive definite and is not shifted. Of an
unsymmetric tangent (friction) the symmetric part is made positive definite. eq. (5.101)
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from umform.analysis.newton.bordered import Bordered
from umform.analysis.newton.symmetric_part import SymmetricPart
from umform.analysis.newton.system import Evaluation, System
from umform.solvers import Factorisation

Floats = NDArray[np.float64]

#: First shift relative to the largest entry, ratio of successive shifts, and their number.
_FIRST, _GROWTH, _MOST = 1e-8, 10.0, 9


class Shift:
    """Shifts of the tangents of one increment.

    Parameters
    ----------
    system : System
        Its pattern contains all diagonal entries.
    """

    def __init__(self, system: System) -> None:
        self._system, self._next = system, _FIRST

    @cached_property
    def _diagonal(self) -> NDArray[np.intp]:
        pattern = self._system.pattern
        return np.flatnonzero(pattern.indices == pattern.rows)

    @cached_property
    def _symmetric_part(self) -> SymmetricPart:
        return SymmetricPart(self._system.pattern)

    def negative_pivots(self, evaluation: Evaluation, found: int | None, *, asked: bool = True) -> int | None:
        """Number of negative pivots, of an unsymmetric tangent those of its symmetric part; None if ranks share it.

        Parameters
        ----------
        evaluation : Evaluation
            With the tangent.
        found : int or None
            Those of the factors of the tangent.
        asked : bool
            Whether the symmetric part may be factorised.
        """
        if not asked or self._system.pattern.symmetric or self._system.ranks.size > 1:
            return found
        return self._symmetric_part.negative_pivots(evaluation.values)

    def factor(self, solver: Bordered, evaluation: Evaluation) -> Factorisation:
        """Factorise a tangent with negative pivots, with the smallest tried shift that removes them.

        Returns
        -------
        Factorisation
            Of the shifted tangent; with negative pivots if no shift sufficed.
        """
        unit, shift = self._system.largest_entry(evaluation.values), self._next
        symmetric = self._system.pattern.symmetric
        for _ in range(_MOST):
            values = evaluation.values.copy()
            values[self._diagonal] += shift * unit
            found = solver.factor(evaluation, values) if symmetric else None
            if not (found.negative_pivots if found else self._symmetric_part.negative_pivots(values)):
                break
            shift *= _GROWTH
        self._next = max(_FIRST, shift / _GROWTH)
        return found or solver.factor(evaluation, values)

"""Unknowns, pattern and scatter maps of a model, built once for a set of supports and terms."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.errors import InvalidValue
from umform.mesh import Ids
from umform.model.equations.unknowns import Unknowns
from umform.model.supports.constraints import Groups
from umform.model.terms.term import Term
from umform.ranks import Ranks
from umform.solvers import Pattern

Floats = NDArray[np.float64]


class Assembly:
    """Unknowns, pattern and scatter maps.

    Parameters
    ----------
    terms : sequence of Term
        Terms of the tangent.
    constrained : ndarray of bool, shape (3 n,)
        Degrees of freedom that are held or prescribed.
    pairs : ndarray of int, shape (k, 2)
        Pairs of degrees of freedom whose mean is held.
    groups : Groups
        Constraints in local axes.
    ranks : Ranks
        Ranks that share the model.
    """

    def __init__(
        self, terms: Sequence[Term], constrained: NDArray[np.bool_], pairs: Ids, groups: Groups, ranks: Ranks
    ) -> None:
        constrained[pairs] = True
        constrained[groups.dofs] = True
        free = np.flatnonzero(~constrained)
        if not ranks.any(len(free) + len(pairs) + groups.count > 0):
            raise InvalidValue("all degrees of freedom are prescribed", remedy="leave some nodes free")
        self.unknowns = Unknowns(free, pairs, groups, constrained.size)
        equation = np.full(constrained.size, -1, dtype=np.int32)
        equations = self.unknowns.equations
        equation[equations] = np.arange(len(equations))
        couplings = {term: tuple(term.couples()) for term in terms}
        wide = [part for term, parts in couplings.items() if not term.within_bodies for part in parts]
        pattern = _core.Pattern(equation, wide, symmetric=all(term.symmetric for term in terms))
        self.scatters = {
            term: [] if term.by_pattern else [pattern.scatter(part) for part in parts]
            for term, parts in couplings.items()
        }
        self.whole_pattern = pattern
        detailed = Pattern(len(equations), pattern.indptr.astype(np.int32), pattern.indices, pattern.symmetric)
        self.entries = detailed.nnz
        self.pattern, self._reduction = detailed, None
        if self.unknowns.reduced:
            self.pattern, self._reduction = self.unknowns.reduction(detailed.rows, detailed.indices, detailed.symmetric)

    def reduce(self, values: Floats) -> Floats:
        """Map entries from the equations of the elements to the unknowns. eq. (5.19)"""
        return values if self._reduction is None else self._reduction(values)

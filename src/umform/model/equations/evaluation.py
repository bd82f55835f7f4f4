"""Result of an evaluation of a model; it owns its data, so it stays valid after later evaluations."""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from umform.model.terms.control import Control
from umform.model.terms.state import State
from umform.model.terms.term import Border, Found, Term
from umform.ranks import Ranks

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Evaluation:
    """Residual and tangent at a displacement, and the results of each term.

    Attributes
    ----------
    state : State
        Where it was made.
    controls : mapping of Control to float
        Values of the controls there.
    residual : ndarray, shape (3 n + k,)
        Internal and contact forces minus loads at all degrees of freedom; reactions at those that are held, prescribed
        or tied; then the residuals of the equations of scalar unknowns.
    values : ndarray
        Entries of the tangent over the unknowns, in the order of :attr:`Model.pattern`; empty of forces alone.
    predictor : ndarray, shape (3 n + k,)
        Tangent times the increment of the prescribed degrees of freedom, or rate of the residual at fixed unknowns;
        zero if neither was requested.
    force_scale : float
        Root of the sum of squares of all element forces, the scale of a residual. eq. (5.8)
    failed : int
        First cell whose evaluation failed, or -1. The residual of :meth:`umform.Model.evaluate` is then NaN.
    failure : str
        Cause of that failure.
    round_off : float
        Change of the residual of contact per relative error of all positions. eq. (5.36)
    found : dict of Term to Found
        Results of each term: gaps, tractions, plastic points.
    border : Border
        Rows and columns of the scalar unknowns.
    number : int
        Counter of the evaluations of the model.
    """

    state: State
    controls: Mapping[Control, float]
    residual: Floats
    values: Floats
    predictor: Floats
    force_scale: float
    failed: int
    failure: str
    round_off: float
    found: dict[Term, Any]
    border: Border
    number: int

    @property
    def x(self) -> Floats:
        """Displacement, followed by the scalar unknowns, shape (3 n + k,)."""
        return self.state.x

    @property
    def time(self) -> float:
        """Time."""
        return self.state.time

    @property
    def u(self) -> Floats:
        """Displacement, shape (3 n,)."""
        return self.x[: self.x.size - len(self.border.unknowns)]

    @cached_property
    def status(self) -> NDArray[np.uint8]:
        """0 for each open contact point, 1 if a tool holds it, 2 if it also slips; over all contacts."""
        joined: NDArray[np.uint8] = _joined([found.status for found in self.found.values()], np.dtype(np.uint8))
        return joined

    @cached_property
    def active(self) -> NDArray[np.bool_]:
        """Mask of the held contact points, over all contacts."""
        return self.status > 0

    @cached_property
    def flowing(self) -> NDArray[np.uint8]:
        """1 for each point of the material whose history the evaluation has changed, else 0."""
        joined: NDArray[np.uint8] = _joined([found.flowing for found in self.found.values()], np.dtype(np.uint8))
        return joined

    @cached_property
    def kept(self) -> bool:
        """Whether tools hold open points, so that this is no state of equilibrium. eq. (4.230)"""
        return any(found.kept for found in self.found.values())

    def without_tangent(self) -> Self:
        """The same without the entries of the tangent, whose memory the next evaluation may reuse."""
        bare = copy(self)
        object.__setattr__(bare, "values", np.empty(0))
        return bare

    def at_points(self, chosen: NDArray[np.bool_]) -> str:
        """Positions of some contact points as text for a message: ": 3 points of die, one near (12, 0, 0.5)".

        Parameters
        ----------
        chosen : ndarray of bool
            Mask of the length of :attr:`active`.
        """
        places, start = [], 0
        for term, found in self.found.items():
            own = chosen[start : start + found.active.size]
            start += found.active.size
            if own.any():
                near = ", ".join(f"{x:.4g}" for x in found.x[np.argmax(own)])
                count = int(own.sum())
                places.append(f"{count} point{'s' if count > 1 else ''} of {term.name}, one near ({near})")
        return ": " + "; ".join(places) if places else ""

    def touching(self, ranks: Ranks) -> bool:
        """Whether a tool touches the sheet anywhere."""
        return ranks.any(bool(self.active.any()))


def _joined(parts: list[Any], kind: np.dtype[Any]) -> Any:
    """Concatenate arrays; a single non-empty array is returned as it is."""
    full = [part for part in parts if part.size]
    if len(full) == 1:
        return full[0]
    return np.concatenate(full) if full else np.zeros(0, dtype=kind)


def first_failure(found: Mapping[Term, Found]) -> tuple[int, str]:
    """First cell that failed and why, or -1."""
    failed = [(one.failed, one.failure) for one in found.values() if one.failed >= 0]
    return min(failed) if failed else (-1, "")

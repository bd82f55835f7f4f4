"""Limit points and bifurcation points between the converged states of a path.

At both a pivot of the tangent changes its sign. At a limit point the load also has an extremum, at a bifurcation point
it does not. docs/theory, 5.12
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.results.history import History

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class PathState:
    """A converged state of a path.

    Attributes
    ----------
    fraction : float
        Load parameter lambda, from 0 to 1.
    arc : float
        Length of the path so far.
    tangent : ndarray, shape (3 n + k,)
        Rate of displacement and scalar unknowns with the length of the path.
    slope : float
        Rate of the load parameter with the length of the path; negative where the load goes back.
    pivots : int or None
        Negative pivots of the tangent, if the solver reports them.
    odd : bool or None
        Whether the determinant of the tangent is negative, if the solver reports it.
    """

    fraction: float
    arc: float
    tangent: Floats
    slope: float
    pivots: int | None
    odd: bool | None = None

    @property
    def known(self) -> bool:
        """Whether the solver reports the signs of the pivots."""
        return self.pivots is not None or self.odd is not None

    def changes(self, before: PathState) -> int:
        """How many pivots have changed their sign since another state, or whether their number is odd."""
        if self.pivots is not None and before.pivots is not None:
            return abs(self.pivots - before.pivots)
        return int(self.negative != before.negative)

    @property
    def negative(self) -> bool:
        """Whether the determinant is negative."""
        return self.pivots % 2 == 1 if self.pivots is not None else bool(self.odd)


class CriticalPoints:
    """Detects critical points between successive states of a path, and reports them to the result.

    Parameters
    ----------
    result : History
        Takes the events and warnings.
    loads : callable
        Text of the loads at a load parameter.
    where : str
        Name of the step.
    """

    def __init__(self, result: History, loads: Callable[[float], str], where: str) -> None:
        self.result, self.loads, self.where = result, loads, where
        self._last: PathState | None = None
        self._counted: PathState | None = None  # the last state with known signs of pivots
        self._turns = 0  # limit points since then
        self._silent = False

    def memory(self) -> dict[str, Any]:
        """State before the last one, for checkpoints."""
        counted = None if self._counted is None else vars(self._counted)
        return {"counted": counted, "turns": self._turns, "silent": self._silent}

    def recall(self, last: PathState, memory: Mapping[str, Any]) -> None:
        """Continue from the last state of a restored path."""
        counted = memory["counted"]
        self._last, self._counted = last, None if counted is None else PathState(**counted)
        self._turns, self._silent = memory["turns"], memory["silent"]

    def advance(self, state: PathState) -> None:
        """Process the next converged state."""
        last, self._last = self._last, state
        if last is not None and last.slope * state.slope < 0.0:
            self._turns += 1
            what = "maximum" if last.slope > 0.0 else "minimum"
            self.result.note(
                f"{self.where}: limit point, a {what} of the load at {self.loads(extremum(last, state))}"
                + self._count(last, state)
            )
        if state.pivots is None:
            self._say_that_pivots_are_unknown(state)
        if not state.known:
            return
        if self._counted is not None:
            self._look_for_bifurcation(self._counted, state)
        self._counted, self._turns = state, 0

    def _look_for_bifurcation(self, before: PathState, state: PathState) -> None:
        """Each limit point changes the sign of one pivot; further changes are bifurcations."""
        change = state.changes(before)
        if change <= self._turns and (change + self._turns) % 2 == 0:
            return
        between = f"between {self.loads(before.fraction)} and {self.loads(state.fraction)}"
        self.result.note(f"{self.where}: bifurcation point {between}{self._count(before, state)}")
        if (state.pivots or state.negative) > (before.pivots or before.negative):
            self.result.warn(
                f"{self.where}: {between} a bifurcation point was passed: the path may be the unstable primary one; "
                "a small imperfection of the mesh or a small disturbing load leads to the other"
            )

    @staticmethod
    def _count(before: PathState, state: PathState) -> str:
        if before.pivots is None or state.pivots is None:
            return "; the determinant changes its sign" if before.known and state.changes(before) else ""
        return f"; negative pivots {before.pivots} -> {state.pivots}"

    def _say_that_pivots_are_unknown(self, state: PathState) -> None:
        if self._silent:
            return
        self._silent = True
        note = f"{self.where}: the solver {self.result.solver} does not tell the number of negative pivots"
        if state.known:
            note += ", but the sign of the determinant; two bifurcation points in one increment may pass unseen"
        else:
            note += "; bifurcation points may pass unseen"
        self.result.note(note)


def extremum(one: PathState, other: PathState) -> float:
    """Load parameter at its extremum between two states: a cubic with their slopes. eq. (5.27)"""
    length = other.arc - one.arc
    rise, m, n = other.fraction - one.fraction, length * one.slope, length * other.slope
    cubic = np.polynomial.Polynomial([one.fraction, m, 3.0 * rise - 2.0 * m - n, m + n - 2.0 * rise])
    roots = np.asarray(cubic.deriv().roots(), dtype=complex)
    inside = roots.real[(np.abs(roots.imag) < 1e-9) & (roots.real >= 0.0) & (roots.real <= 1.0)]
    return float(cubic(inside[0]))  # the slopes differ in sign: there is one

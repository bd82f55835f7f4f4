"""Shorten an increment of Newton's method that is too long. eq. (5.12)

If the full increment is accepted, the line search costs only a scalar product: the residual there is needed anyway. A
shorter one costs an evaluation; enhanced parameters are scaled with the displacement, so the start of the increment is
not evaluated again.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from umform.analysis.newton.system import Evaluation, State, System

Floats = NDArray[np.float64]

#: Ratio of the slope at the end to that at the beginning, of opposite sign, up to which an increment is accepted.
_OVERSHOOT = 0.8
#: Each trial is at least a quarter of the previous one: otherwise thin sheets, whose energy is a narrow curved valley,
#: progress too slowly.
_TRIALS, _SHORTEST, _LONGEST = 3, 0.25, 0.5
#: Ratio of the slopes at end and beginning from which an increment is doubled, and how often.
_STILL_DOWNHILL, _DOUBLINGS = 0.5, 6


def shortened(
    system: System,
    goal: State,
    u: Floats,
    du: Floats,
    r: Floats,
    evaluation: Evaluation,
    length: float,
    *,
    keep: bool = False,
) -> tuple[Evaluation, float]:
    """The evaluation where the slope along the increment has decreased, and the accepted part of the increment.

    Parameters
    ----------
    system : System
        It has recovered this part of the increment.
    goal : State
        The goal of the increment.
    u, du : ndarray, shape (3 n + k,)
        Start of the increment, and the full increment.
    r : ndarray
        Residual of the unknowns at ``u``.
    evaluation : Evaluation
        At ``u + length du``.
    length : float
        Accepted part of the increment.
    keep : bool
        Whether tools hold open points at ``u``: a part of the increment leaves them open, so they stay held.
    """
    along = system.coefficients(du)
    slope = system.ranks.dot(r, along)
    for _ in range(_TRIALS):
        overshoot = _overshoot(system, along, slope, evaluation)
        if overshoot <= _OVERSHOOT:
            break
        part = min(max(1.0 / (1.0 + overshoot), _SHORTEST), _LONGEST)  # the secant of the slope
        system.shorten(part)
        length *= part
        evaluation = system.evaluate(system.state_at(u + length * du, goal), keep=keep)
    return evaluation, length


def lengthened(
    system: System, goal: State, u: Floats, du: Floats, r: Floats, evaluation: Evaluation, length: float
) -> tuple[Evaluation, float]:
    """The same, after doubling the increment as long as the slope along it hardly decreases.

    Increments of a tangent that was shifted to be positive definite are too short: near a loss of stability the
    residual is small, and the next stable state is far. Parameters as of :func:`shortened`.
    """
    along = system.coefficients(du)
    slope = system.ranks.dot(r, along)
    for _ in range(_DOUBLINGS):
        if _overshoot(system, along, slope, evaluation) > -_STILL_DOWNHILL:
            break
        system.shorten(2.0)
        length *= 2.0
        evaluation = system.evaluate(system.state_at(u + length * du, goal))
    return shortened(system, goal, u, du, r, evaluation, length)


def _overshoot(system: System, along: Floats, slope: float, evaluation: Evaluation) -> float:
    """Ratio of the slope to that at the beginning, positive after a change of sign; infinite if a cell failed."""
    if evaluation.failed >= 0:
        return math.inf
    ratio = -system.ranks.dot(system.restrict(evaluation.residual), along) / slope if slope else 0.0
    return ratio if math.isfinite(ratio) else math.inf

"""Shorten an increment of Newton's method that goes too far. eq. (5.12)

It costs nothing where the full increment will do: the residual there is wanted anyway, and the slope along the
increment is a product of two vectors. A shorter one costs an evaluation; enhanced parameters are shortened with the
displacement, so nothing is evaluated again at the point of departure.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from umform.solution.system import Evaluation, System

Floats = NDArray[np.float64]

#: Slope at the end over that at the beginning, against it, up to which an increment is taken.
_OVERSHOOT = 0.8
#: Each trial is at least a quarter of the one before: thin sheets, whose energy is a narrow bent valley, creep else.
_TRIALS, _SHORTEST, _LONGEST = 3, 0.25, 0.5
#: Slope at the end over that at the beginning from which an increment is doubled, and how often.
_STILL_DOWNHILL, _DOUBLINGS = 0.5, 6


def shortened(
    system: System, u: Floats, du: Floats, r: Floats, evaluation: Evaluation, length: float
) -> tuple[Evaluation, float]:
    """The evaluation where the slope along the increment has fallen, and the part of the increment that led there.

    Parameters
    ----------
    system : System
        It has recovered this part of the increment.
    u, du : ndarray, shape (3 n + k,)
        Where the increment begins, and the whole of it.
    r : ndarray
        Residual of the unknowns at ``u``.
    evaluation : Evaluation
        At ``u + length du``.
    length : float
        Part of the increment that has been taken.
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
        evaluation = system.evaluate(u + length * du)
    return evaluation, length


def lengthened(
    system: System, u: Floats, du: Floats, r: Floats, evaluation: Evaluation, length: float
) -> tuple[Evaluation, float]:
    """The same, after an increment that has been doubled as long as the slope along it hardly falls.

    Increments of a tangent that was shifted to be positive are too short: near a state that has lost its stability the
    residual is small, and the next stable state far. Parameters as of :func:`shortened`.
    """
    along = system.coefficients(du)
    slope = system.ranks.dot(r, along)
    for _ in range(_DOUBLINGS):
        if _overshoot(system, along, slope, evaluation) > -_STILL_DOWNHILL:
            break
        system.shorten(2.0)
        length *= 2.0
        evaluation = system.evaluate(u + length * du)
    return shortened(system, u, du, r, evaluation, length)


def _overshoot(system: System, along: Floats, slope: float, evaluation: Evaluation) -> float:
    """Slope over that at the beginning, positive where it has changed sign; infinite where a cell has no residual."""
    if evaluation.failed >= 0:
        return math.inf
    ratio = -system.ranks.dot(system.restrict(evaluation.residual), along) / slope if slope else 0.0
    return ratio if math.isfinite(ratio) else math.inf

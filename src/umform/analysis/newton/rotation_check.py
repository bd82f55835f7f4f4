"""Reject an increment in which a sheet rotates too far on a tool for its chord to be the direction of slip."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.model import Evaluation, Model
from umform.model.contact import Contact
from umform.results.records import Cause, Converged, Failed

Floats = NDArray[np.float64]

#: Ratio of chord to radius up to which the chord is shorter than the arc by at most a hundredth.
_LONGEST = 0.5


def follows(model: Model, last: Evaluation, converged: Converged) -> Converged:
    """The equilibrium, if the sheet rotated on no tool with friction by more than half a radian. eq. (4.152)

    The slip of an increment is measured along its chord. After half a turn of a free sheet all chords pass through its
    centre, and friction has no moment: a spurious equilibrium, which large increments may reach.

    Parameters
    ----------
    model : Model
        At ``converged``, not yet committed.
    last : Evaluation
        Evaluation at the last converged state.
    converged : Converged
        The increment.

    Raises
    ------
    Failed
        If it rotated farther; the model is reverted.
    """
    for pair in model.contacts:
        if pair.friction is None or pair.tool.open:
            continue
        chord = _chord(model, pair, last, converged.evaluation)
        if chord > _LONGEST:
            model.system.revert()
            angle = np.degrees(2.0 * np.arcsin(min(0.5 * chord, 1.0)))
            reason = f"the sheet turns on {pair.name} by {angle:.0f} degrees, too far for the direction of its slip"
            raise Failed(reason, converged.iterations, Cause.TURN)
    return converged


def _chord(model: Model, pair: Contact, last: Evaluation, now: Evaluation) -> float:
    """Displacement of the points in contact minus its mean, relative to their distance from their mean."""
    both = last.found[pair].active & now.found[pair].active
    before, behind = (_in_frame_of_tool(pair, evaluation)[both] for evaluation in (last, now))
    sums = model.system.ranks.sum(np.concatenate([[float(both.sum())], before.sum(axis=0), behind.sum(axis=0)]))
    if sums[0] == 0.0:
        return 0.0
    arms, ways = before - sums[1:4] / sums[0], behind - before - (sums[4:] - sums[1:4]) / sums[0]
    squares = model.system.ranks.sum(np.array([(ways**2).sum(), (arms**2).sum()]))
    return float(np.sqrt(squares[0] / squares[1])) if squares[1] > 0.0 else 0.0


def _in_frame_of_tool(pair: Contact, evaluation: Evaluation) -> Floats:
    """Positions of the contact points in the frame of the tool, shape (points, 3)."""
    rotation, shift = pair.tool.pose(evaluation.controls, evaluation.time)
    places: Floats = (evaluation.found[pair].x - shift) @ rotation
    return places

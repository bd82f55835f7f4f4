"""Predictor for a sheet that friction carries on a rotating tool: a circular arc instead of a straight line."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.model import Evaluation, Model
from umform.model.terms.control import Control
from umform.model.terms.state import State
from umform.model.tools.tool import Tool

Floats = NDArray[np.float64]

#: Largest deviation, relative to the displacement, of a body that rotates with a tool.
_DIFFERENT = 0.5
#: Largest effect of supports and ties on a displacement that is compatible with them, relative to its largest entry.
_ROUND_OFF = 1e-9


@dataclass(frozen=True)
class Screw:
    """A rigid motion x -> Q x + s, and the velocity field w x x + v whose exponential it is. eq. (4.178)

    Attributes
    ----------
    Q, s : ndarray, shapes (3, 3) and (3,)
        Rotation and shift.
    w, v : ndarray, shape (3,)
        Rotation vector and velocity of the origin.
    """

    Q: Floats
    s: Floats
    w: Floats
    v: Floats

    @classmethod
    def of(cls, Q: Floats, s: Floats) -> Screw:
        """From the logarithm of a rigid motion with less than half a turn."""
        from scipy.spatial.transform import Rotation

        w = Rotation.from_matrix(Q).as_rotvec()
        angle, W = float(np.linalg.norm(w)), np.cross(np.eye(3), w)
        V = np.eye(3)
        if angle > 0.0:
            V = V + 2.0 * (np.sin(0.5 * angle) / angle) ** 2 * W + (angle - np.sin(angle)) / angle**3 * (W @ W)
        return cls(Q, s, w, np.asarray(np.linalg.solve(V, s), dtype=float))

    def straight(self, x: Floats) -> Floats:
        """Displacement of points (n, 3) along their velocities."""
        return np.asarray(np.cross(self.w, x) + self.v)

    def arrival(self, x: Floats) -> Floats:
        """Displacement of points (n, 3) up to their present positions."""
        return np.asarray(x - (x - self.s) @ self.Q)

    def beyond(self, x: Floats, way: Floats) -> Floats:
        """Difference of the rigid motion from a straight displacement of points, both (n, 3)."""
        relative = way - self.straight(x)
        return np.asarray(x @ self.Q.T + self.s - x + relative @ self.Q.T - way)


def carried(model: Model, goal: State, last: Evaluation, increment: Floats) -> Floats | None:
    """Correction of a straight increment if the sheet rotates with a tool; None if it does not.

    Parameters
    ----------
    model : Model
        The model.
    goal : State
        The goal of the increment.
    last : Evaluation
        Evaluation at the last converged state.
    increment : ndarray, shape (3 n + k,)
        Predicted increment, along the tangent.

    Returns
    -------
    ndarray, shape (3 n + k,), or None
        Zero for bodies that rotate with no tool, and where supports or ties prevent the rotation.
    """
    tools = _turning(model, goal, last, increment)
    if not tools:
        return None
    n = model.u.size
    x, way = _places(model, last), increment[:n].reshape(-1, 3)
    beyond, found = np.zeros_like(x), False
    for weights in _bodies(model, x):
        for screw in tools:
            if _goes_round(model, screw, screw.straight(x), x, way, weights):
                nodes = weights > 0.0
                beyond[nodes], found = screw.beyond(x[nodes], way[nodes]), True
                break
    if not found:
        return None
    whole = np.concatenate([beyond.ravel(), np.zeros(increment.size - n)])
    taken = float(np.abs(model.system.extend(model.system.coefficients(whole)) - whole).max(initial=0.0))
    held = model.system.ranks.max(taken) > _ROUND_OFF * model.system.ranks.max(float(np.abs(whole).max(initial=0.0)))
    return None if held else whole


def leaves_arc(model: Model, goal: State, last: Evaluation, increment: Floats) -> bool:
    """Whether an extrapolated increment is that of a body that rotated with a tool: it leaves the arc.

    Parameters as of `carried`.
    """
    tools = _turning(model, goal, last, increment)
    if not tools:
        return False
    x, way = _places(model, last), increment[: model.u.size].reshape(-1, 3)
    return any(
        _goes_round(model, screw, screw.arrival(x), x, way, weights) for weights in _bodies(model, x) for screw in tools
    )


def _places(model: Model, last: Evaluation) -> Floats:
    return model.mesh.displaced(last.u)


def _bodies(model: Model, x: Floats) -> list[Floats]:
    """For each body, the number of its cells at each of the nodes; ranks share nodes, but no cells."""
    return [np.bincount(body.connectivity.ravel(), minlength=len(x)).astype(float) for body in model.bodies]


def _turning(model: Model, goal: State, last: Evaluation, increment: Floats) -> list[Screw]:
    """Motions of the rotating tools with friction that touch the sheet."""
    values = model.controls.values_at(model.system.state_at(goal.x + increment, goal))
    screws = []
    for tool in model.tools:
        pairs = [pair for pair in tool.pairs if pair.has_friction and not tool.open]
        if not pairs or not model.system.ranks.any(any(bool(last.found[pair].active.any()) for pair in pairs)):
            continue
        Q, s = _motion(tool, last, values, goal.time)
        if np.trace(Q) < 3.0 - 1e-15:
            screws.append(Screw.of(Q, s))
    return screws


def _motion(tool: Tool, last: Evaluation, values: dict[Control, float], time: float) -> tuple[Floats, Floats]:
    """Rigid motion of a tool from the converged state to given values of the controls."""
    (before, at), (after, then) = tool.pose(last.controls, last.time), tool.pose(values, time)
    Q = after @ before.T
    return Q, then - Q @ at


def _goes_round(model: Model, screw: Screw, goes: Floats, x: Floats, way: Floats, weights: Floats) -> bool:
    """Whether the weighted displacement of points, those of the cells of a body, is that of a motion. eq. (4.179)"""
    sums = model.system.ranks.sum(np.concatenate([[weights.sum()], weights @ x]))
    turn, relative = np.cross(screw.w, x - sums[1:] / max(sums[0], 1.0)), way - goes
    squares = model.system.ranks.sum(np.array([weights @ (relative**2).sum(axis=1), weights @ (turn**2).sum(axis=1)]))
    return bool(squares[1] > 0.0 and squares[0] <= _DIFFERENT**2 * squares[1])

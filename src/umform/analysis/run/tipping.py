"""A sheet that tips: a tool pushes it beside the tools and supports that carry it. docs/theory, 4.18"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.analysis.steps import Move, Step
from umform.model import Model
from umform.model.contact import Contact
from umform.model.equations.checks import free_now, left_free, middle, motion_along, sprung
from umform.model.equations.rest_springs import Rest
from umform.model.terms.control import Control
from umform.model.terms.dead_load import Load
from umform.model.terms.forces import rigid_body_modes
from umform.model.terms.pressure import Pressure
from umform.model.tools.tool import Pose, Tool
from umform.model.tools.tool_controls import ToolForce, ToolWay

Floats = NDArray[np.float64]

#: Gap of a tool that carries the sheet, relative to the thickness: the run turns the sheet so far. eq. (4.260)
_NEAR = 0.5
#: Cosine between the motion of a tool and its normal, below which it slides along the sheet: 60 degrees.
_FACES = 0.5
#: Part of a step, and displacement relative to the thickness, that show where a tool goes.
_BEGIN, _A_LITTLE = 1e-3, 1e-3
#: Points of a tool that are looked at first.
_FEW = 50
#: Status of a linear programme without a solution.
_INFEASIBLE = 2


@dataclass(frozen=True)
class Tipping:
    """A tool whose push nothing balances.

    Attributes
    ----------
    step : int
        Number of the step that moves it.
    tool : str
        Its name.
    place : ndarray, shape (3,)
        Mean of the points that it meets first.
    carriers : dict of str to ndarray, shape (3,)
        Tools that carry the sheet, and their nearest points.
    """

    step: int
    tool: str
    place: Floats
    carriers: dict[str, Floats]


def tipping(model: Model, steps: Sequence[Step]) -> Tipping | None:
    """The first tool that pushes the sheet where no forces of tools and supports balance it. eq. (4.261)

    Parameters
    ----------
    model : Model
        The model before the first step.
    steps : sequence of Step
        Steps of the run; those after the first one that moves something else than tools are not considered.

    Returns
    -------
    Tipping or None
        None if the push can be balanced, also by friction and by tools half a thickness away; and if loads or unknown
        terms might balance it.
    """
    free = _free(model)
    if len(free) == 0 or free_now(model.system):
        return None
    values = {control: control.value for control in model.controls}
    anywhere = {tool for tool in model.tools if tool.motion is not None or tool.presses}
    for number, step in enumerate(steps, start=1):
        if not isinstance(step, Move) or not all(isinstance(one, ToolWay | ToolForce) for one in step.moved()):
            return None
        before = [values[control] for control in step.moved()]
        begun, ended = (dict(zip(step.moved(), step.values(part, before), strict=True)) for part in (_BEGIN, 1.0))
        poses = [
            (tool, tool.pose(values, model.system.time), _next_pose(model, tool, values, begun)) for tool in model.tools
        ]
        moved = {tool for tool, pose, then in poses if not all(map(np.array_equal, pose, then))}
        for tool, pose, then in poses:
            found = None
            if tool in moved and (tool not in anywhere or tool.presses) and _arrives(model, tool, pose, values | ended):
                found = _unbalanced(model, free, (tool, pose, then), poses, anywhere | moved)
            if found is not None:
                return Tipping(number, tool.name, *found)
        anywhere |= moved
        values |= ended
    return None


def _free(model: Model) -> Floats:
    """Rigid-body motions (k, 6) that supports and springs leave free; none if loads or unknown terms act."""
    unknown = [term for term in model.system.others if not isinstance(term, Rest)]
    if unknown or any(isinstance(control, Load | Pressure) for control in model.controls):
        return np.empty((0, 6))
    points = model.positions
    centre, size = middle(model.system, points)
    rows = [motion_along(x, n, centre, size) for x, n in sprung(model.system)]
    return left_free(model.system, rigid_body_modes(points, centre, size), rows)


def _arrives(model: Model, tool: Tool, pose: Pose, values: Mapping[Control, float]) -> bool:
    """Whether a tool reaches the sheet, as it lies now, by the end of a step; one with a force does."""
    if tool.presses or not tool.pairs or tool.open:
        return True
    points = _Points.of(model, tool, pose)
    along = np.einsum("ij,ij->i", _way(points, pose, tool.pose(values, model.system.time)), points.n)
    return bool((along >= points.gap).any())


def _next_pose(model: Model, tool: Tool, values: Mapping[Control, float], begun: Mapping[Control, float]) -> Pose:
    """Pose of a tool at the beginning of a step; a force moves its tool by a little."""
    then = {**values, **begun}
    for control in begun:
        if isinstance(control, ToolForce):
            sense = np.sign(begun[control] - values[control])
            then[control.way] = values[control.way] + float(sense) * _A_LITTLE * model.system.thickness
    return tool.pose(then, model.system.time)


@dataclass(frozen=True)
class _Points:
    """Contact points of a tool: gaps (m,), positions and normals (m, 3), coefficient of friction; NaN is any."""

    gap: Floats
    x: Floats
    n: Floats
    friction: Floats

    @classmethod
    def of(cls, model: Model, tool: Tool, pose: Pose) -> _Points:
        parts = [(pair.locate(model.u, pose), _coefficient(pair)) for pair in tool.pairs]
        gap = np.concatenate([at.gap for at, _ in parts])
        x, n = (np.concatenate([getattr(at, name) for at, _ in parts]) for name in ("x", "normal"))
        friction = np.concatenate([np.full(len(at.gap), coefficient) for at, coefficient in parts])
        return cls(gap, x, n, friction).part(np.isfinite(gap) & np.isfinite(n).all(axis=1))

    def part(self, chosen: NDArray[Any]) -> _Points:
        return _Points(self.gap[chosen], self.x[chosen], self.n[chosen], self.friction[chosen])

    def forces(self, model: Model, free: Floats) -> Floats:
        """Work of forces in the free motions (m, k): normals, or edges of a pyramid around each cone of friction."""
        centre, size = middle(model.system, model.positions)
        across = np.cross(self.n, np.eye(3)[np.abs(self.n).argmin(axis=1)])
        across /= np.linalg.norm(across, axis=1, keepdims=True)
        other, known = np.cross(self.n, across), ~np.isnan(self.friction)
        most, normal = np.where(known, self.friction, 1.0)[:, None], np.where(known[:, None], self.n, 0.0)
        edges = [normal + most * (a * across + b * other) for a in (-1.0, 1.0) for b in (-1.0, 1.0)]
        forces = [self.n, *(edges if (most > 0.0).any() else [])]
        return np.concatenate([motion_along(self.x, force, centre, size) for force in forces]) @ free.T


def _coefficient(pair: Contact) -> float:
    friction = pair.friction
    return 0.0 if friction is None else float(friction) if isinstance(friction, int | float) else np.nan


_Poses = Sequence[tuple[Tool, Pose, Pose]]


def _unbalanced(
    model: Model, free: Floats, pushing: tuple[Tool, Pose, Pose], poses: _Poses, anywhere: set[Tool]
) -> tuple[Floats, dict[str, Floats]] | None:
    """Place of a push and the places of the carriers if no forces balance it; None if some do, or if it is no push."""
    tool, pose, then = pushing
    if not tool.pairs or tool.open:
        return None
    first, near = _Points.of(model, tool, pose), _NEAR * model.system.thickness
    first = first.part(first.gap <= first.gap.min(initial=np.inf) + near)
    pushed = _pushed(first, pose, then)
    if len(first.gap) == 0 or not pushed[first.gap.argmin()]:
        return None
    first = first.part(pushed)
    carriers = {}
    for other, at, _ in poses:
        if other is not tool and other.pairs and not other.open:
            points = _Points.of(model, other, at)
            carriers[other.name] = points.part(points.gap <= (np.inf if other in anywhere else near))
    bears = [points.forces(model, free) for points in carriers.values()]
    if _balances(first.forces(model, free), np.concatenate([np.zeros((0, len(free))), *bears])):
        return None
    place = first.x.mean(axis=0)
    distances = {name: np.linalg.norm(points.x - place, axis=1) for name, points in carriers.items()}
    return place, {name: carriers[name].x[far.argmin()] for name, far in distances.items() if len(far)}


def _pushed(points: _Points, pose: Pose, then: Pose) -> NDArray[np.bool_]:
    """Which points a tool pushes along its normal on the way from one pose to another one."""
    way = _way(points, pose, then)
    pushed: NDArray[np.bool_] = np.einsum("ij,ij->i", way, points.n) > _FACES * np.linalg.norm(way, axis=1)
    return pushed


def _way(points: _Points, pose: Pose, then: Pose) -> Floats:
    """Ways (m, 3) of points that move with a tool from one pose to another one."""
    (Q, c), (R, d) = pose, then
    return (points.x - c) @ Q @ R.T + d - points.x


def _balances(pushes: Floats, bears: Floats) -> bool:
    """Whether some forces in the rows of both have no resultant, those of the push having the sum one. eq. (4.261)"""
    if pushes.shape[1] == 1:  # no linear programme for a single motion
        least, largest = (float(getattr(bears, name)(initial=0.0)) for name in ("min", "max"))
        return bool((pushes.min() <= 0.0 or least < 0.0) and (pushes.max() >= 0.0 or largest > 0.0))
    from scipy.optimize import linprog  # a fifth of a second

    for most in (_FEW, len(pushes) + len(bears)):  # a few points are enough in nearly all cases
        own, others = (rows[:: max(1, len(rows) // most)] for rows in (pushes, bears))
        columns = np.concatenate([own, others])
        matrix = np.vstack([columns.T, np.arange(len(columns)) < len(own)])
        answer = linprog(np.zeros(len(columns)), A_eq=matrix, b_eq=[0.0] * pushes.shape[1] + [1.0])
        if answer.status != _INFEASIBLE:
            return True
    return False

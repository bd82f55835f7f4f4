"""A rigid tool: its surface, its pose, and what moves it: ways, turns, a motion in time, forces that press it.

A tool is a thing of the model; several pairs of faces may touch the same one. docs/theory, 4.7
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.model.control import Control, Twins
from umform.model.forces import vector3
from umform.model.now import Now
from umform.model.term import At, Found, Global, Into, Term, Tree
from umform.model.tool_controls import Press, ToolMotion, ToolTurn
from umform.ranks import Ranks
from umform.surfaces import Surface
from umform.surfaces.directions import rotation_matrix

Floats = NDArray[np.float64]
Pose = tuple[Floats, Floats]

#: time -> translation (3,), or (translation (3,), rotation vector (3,)) about the tool's reference point.
Motion = Callable[[float], Floats | tuple[Floats, Floats]]


class Tool(Term):
    """A rigid tool; made by :meth:`umform.Model.tool`, or by :meth:`umform.Model.contact` for one pair.

    Parameters
    ----------
    name : str
        Its columns of the history are ``<name>_fx`` ... ``<name>_mz``: force and moment of the sheet on it.
    surface : Surface
        A tool of :mod:`umform.surfaces`.
    now : Now
        The time of its model.

    Attributes
    ----------
    pairs : list of Contact
        The pairs of faces that touch it.
    ways : list of ToolMotion or ToolTurn
        Controls that move it.
    motion : callable, optional
        Motion in time, in addition.
    reference_point : ndarray, shape (3,)
        Point that the motion turns it about.
    """

    timed_as = "contact"
    fixed = ("surface",)

    def __init__(self, name: str, surface: Surface, now: Now) -> None:
        if not isinstance(surface, Surface):
            raise InvalidValue(
                "a tool must be a surface",
                where=f"tool {name}",
                value=type(surface).__name__,
                cause="a function or a class in place of a surface",
                remedy="a tool of umform.surfaces, VDie or Cylinder for instance, or UserSurface(function)",
            )
        self.name, self.surface = name, surface
        self.kernel, self.now = surface.kernel(), now
        self.pairs: list[Any] = []
        self.ways: list[ToolMotion | ToolTurn] = []
        self.presses: list[Press] = []
        self.motion: Motion | None = None
        self.reference_point = np.zeros(3)

    # Where it is ---------------------------------------------------------------------------------------------

    def pose(self, values: Mapping[Control, float], time: float) -> Pose:
        """Rotation and shift: a point X of the tool's own frame lies at x = Q X + c. eq. (4.18)

        The turns come first, in the order in which they were made, then ways and motion.
        """
        shift, rotation = np.zeros(3), np.eye(3)
        for control in self.ways:
            if isinstance(control, ToolMotion):
                shift += values[control] * np.asarray(control.direction)
        if self.motion is not None:
            answer = self.motion(time)
            translation, turn = answer if isinstance(answer, tuple) and len(answer) == 2 else (answer, np.zeros(3))
            where = f"motion of tool {self.name} at time {time:g}"
            shift += vector3(translation, where)
            rotation = rotation_matrix(vector3(turn, where))
        centre = self.reference_point
        outer = np.ascontiguousarray(rotation), centre + shift - rotation @ centre
        for control in reversed(self.ways):
            if isinstance(control, ToolTurn):
                outer = _after(outer, _turned(control, values[control]))
        return outer

    @property
    def pose_now(self) -> Pose:
        """Where it stands: its pose at the present values of its controls and the present time."""
        return self.pose({way: way.value for way in self.ways}, self.now.time)

    def axis_of(self, turn: ToolTurn, values: Mapping[Control, float], time: float) -> tuple[Floats, Floats]:
        """Axis and point of a turn where the motions that come after it have taken them."""
        inner = [control for control in self.ways[: self.ways.index(turn) + 1] if isinstance(control, ToolTurn)]
        still = {control: 0.0 if control in inner else value for control, value in values.items()}
        rotation, shift = self.pose(still, time)
        return rotation @ np.asarray(turn.axis), rotation @ np.asarray(turn.about) + shift

    def moved_by(self, rates: Mapping[Control, float]) -> bool:
        """Whether one of its ways has a rate."""
        return any(rates.get(control, 0.0) != 0.0 for control in self.ways)

    def shift_rate(self, rates: Mapping[Control, float]) -> Floats | float:
        """Rate of its translation."""
        along = [control for control in self.ways if isinstance(control, ToolMotion)]
        return sum(rates.get(control, 0.0) * np.asarray(control.direction) for control in along)

    def spins(self, rates: Mapping[Control, float], at: At) -> list[tuple[Floats, Floats]]:
        """Rotation vector per time and a point of its axis, for each turn that has a rate."""
        found = []
        for control in self.ways:
            rate = rates.get(control, 0.0)
            if isinstance(control, ToolTurn) and rate != 0.0:
                axis, point = self.axis_of(control, at.values, at.time)
                found.append((rate * axis, point))
        return found

    # What moves it -------------------------------------------------------------------------------------------

    def add_way(self, way: ToolMotion | ToolTurn) -> None:
        """Let a control move it."""
        self.ways.append(way)

    def add_press(self, press: Press) -> None:
        """Let forces and a spring find its way."""
        self.presses.append(press)

    @property
    def unknowns(self) -> tuple[Global, ...]:  # type: ignore[override]
        """Ways that forces and springs find."""
        return tuple(press.unknown for press in self.presses)

    # Term ----------------------------------------------------------------------------------------------------

    def evaluate(self, at: At, into: Into) -> Found:
        """Add the equations of its unknown ways: forces of sheet, press and springs balance. eq. (4.41)"""
        border = into.border
        for press in self.presses:
            k = border.number(press.unknown)
            sheet = press.way.force(_Seen(into.residual, into.found, at.values, at.time), into.ranks)
            pressing = sum(at.values[force] for force in press.forces)
            border.residual[k] = press.stiffness * (at.values[press.way] - press.free) - sheet - pressing
            border.rows[k] = self._row(press.way, border.columns[k])
            border.corner[k, k] += press.stiffness
            for other, unknown in enumerate(border.unknowns):
                border.corner[k, other] -= sum(unknown.rates.get(force, 0.0) for force in press.forces)
                for pair in self.pairs:
                    if (pair, unknown) in into.moved:
                        border.corner[k, other] -= self._along(press.way, into.moved[pair, unknown], into)
            border.predictor[k] -= sum(at.rates.get(force, 0.0) for force in press.forces)
            for pair in self.pairs:
                if (pair, None) in into.moved:
                    border.predictor[k] -= self._along(press.way, into.moved[pair, None], into)
            if at.du is not None:
                border.predictor[k] += into.ranks.sum(float(border.rows[k] @ at.du))
        return Found()

    def _row(self, way: ToolMotion, column: Floats) -> Floats:
        """Derivative of minus the force of the sheet along a way with respect to u, shape (3 n,). eq. (4.42)"""
        if all(pair.symmetric for pair in self.pairs):  # the potential of contact has one Hessian
            return column
        rows: Floats = np.sum([pair.block.row(way.direction) for pair in self.pairs], axis=0)
        return rows

    def _along(self, way: ToolMotion, column: Floats, into: Into) -> float:
        """Resultant of nodal forces (3 n,) along a way."""
        return into.ranks.sum(float(column.reshape(-1, 3).sum(axis=0) @ np.asarray(way.direction)))

    def resultant(self, found: Mapping[Term, Any], ranks: Ranks) -> tuple[Floats, Floats]:
        """Force of the sheet on it and moment about the origin, over all pairs. eq. (4.17)"""
        parts = [found[pair].resultant() for pair in self.pairs]
        force, moment = (sum(part[k] for part in parts) for k in (0, 1))
        return ranks.sum(np.asarray(force) + np.zeros(3)), ranks.sum(np.asarray(moment) + np.zeros(3))

    def resultant_columns(self, found: Mapping[Term, Any], ranks: Ranks) -> dict[str, float]:
        """Its columns of the history: force and moment of the sheet on it."""
        force, moment = self.resultant(found, ranks)
        return {name: float(value) for name, value in zip(self.column_names(), [*force, *moment], strict=True)}

    def state(self) -> Tree:
        """Unknown ways."""
        return {press.unknown.name: press.unknown.value for press in self.presses}

    def restore(self, tree: Tree) -> None:
        """Put them back."""
        for press in self.presses:
            press.unknown.value = tree[press.unknown.name]

    def column_names(self) -> Iterable[str]:
        """Force and moment of the sheet on it."""
        return [f"{self.name}_{kind}{axis}" for kind in "fm" for axis in "xyz"]

    def strip(self, bare: Self, twins: Twins) -> None:
        """With the twins of what touches and moves it."""
        bare.now = twins.of(self.now)
        bare.pairs = [twins.of(pair) for pair in self.pairs]
        bare.ways = [twins.of(way) for way in self.ways]
        bare.__dict__.pop("kernel", None)
        bare.presses = [
            Press(
                twins.of(press.unknown),
                twins.of(press.way),
                [twins.of(force) for force in press.forces],
                press.stiffness,
                press.free,
            )
            for press in self.presses
        ]

    def fill(self, piece: Any, mesh: Any) -> None:
        """Make its kernel."""
        self.kernel = self.surface.kernel()


@dataclass(frozen=True)
class _Seen:
    """What a way reads to say the force on it."""

    residual: Floats
    found: Mapping[Term, Any]
    controls: Mapping[Control, float]
    time: float


def _turned(turn: ToolTurn, angle: float) -> Pose:
    """Pose of a turn about its axis."""
    rotation, point = rotation_matrix(angle * np.asarray(turn.axis)), np.asarray(turn.about)
    return np.ascontiguousarray(rotation), point - rotation @ point


def _after(outer: Pose, inner: Pose) -> Pose:
    """The inner pose, then the outer one."""
    (Q, c), (R, d) = outer, inner
    return np.ascontiguousarray(Q @ R), Q @ d + c

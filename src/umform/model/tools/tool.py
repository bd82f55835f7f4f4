"""A rigid tool: its surface, its pose, and its motion: travel, rotation, motion in time, forces.

A tool belongs to the model; several pairs of faces may touch it. docs/theory, 4.7
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from umform.model.terms.control import Control, Twins
from umform.model.terms.dead_load import Load
from umform.model.terms.forces import vector3
from umform.model.terms.present_state import Now
from umform.model.terms.term import At, Found, Global, Into, Term, Tree
from umform.model.tools.press import Press
from umform.model.tools.rigid_stops import ToolFound, bear
from umform.model.tools.tool_controls import ToolMotion, ToolTurn, ToolWay
from umform.ranks import Ranks
from umform.surfaces import Surface
from umform.surfaces.directions import rotation_matrix
from umform.surfaces.tool import check_is_surface

Floats = NDArray[np.float64]
Pose = tuple[Floats, Floats]

#: time -> translation (3,), or (translation (3,), rotation vector (3,)) about the tool's reference point.
Motion = Callable[[float], Floats | tuple[Floats, Floats]]

#: Rotation of a tool that has not turned.
_UPRIGHT = np.eye(3)
_UPRIGHT.setflags(write=False)


class Tool(Term):
    """A rigid tool; made by :meth:`umform.Model.tool`, or by :meth:`umform.Model.contact` for one pair.

    Parameters
    ----------
    name : str
        Its columns of the history are ``<name>_fx`` ... ``<name>_mz``: force and moment of the sheet on it.
    surface : Surface
        A tool of :mod:`umform.surfaces`.
    now : Now
        Time of its model.

    Attributes
    ----------
    pairs : list of Contact
        The pairs of faces that touch it.
    ways : list of ToolMotion or ToolTurn
        Controls of its motion.
    presses : list of Press
        Presses that determine some of them.
    motion : callable, optional
        Motion in time, in addition.
    reference_point : ndarray, shape (3,)
        Point about which the motion rotates the tool.
    open : bool
        Whether it is open: it then holds no point, wherever it is.
    load : Load, optional
        Forces on the sheet that replace it while it is open.
    may_bottom : bool
        Whether it is meant to squeeze the sheet against another tool; else a run warns of it.
    """

    timed_as = "contact"
    fixed = ("surface",)
    nodal = ("vector",)

    def __init__(self, name: str, surface: Surface, now: Now) -> None:
        check_is_surface(surface, f"tool {name}")
        self.name, self.surface = name, surface
        self.kernel, self.now = surface.kernel(), now
        self.pairs: list[Any] = []
        self.ways: list[ToolWay] = []
        self.presses: list[Press] = []
        self.motion: Motion | None = None
        self.reference_point = np.zeros(3)
        self.open = False
        self.load: Load | None = None
        self.may_bottom = False

    # Pose ----------------------------------------------------------------------------------------------------

    def pose(self, values: Mapping[Control, float], time: float) -> Pose:
        """Rotation and shift: a point X of the tool frame has the position x = Q X + c. eq. (4.18)

        Rotations are applied first, in the order of their definition, then translations and the motion in time.
        """
        shift, rotation = np.zeros(3), _UPRIGHT
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
        """Its pose at the present values of its controls and the present time."""
        return self.pose({way: way.value for way in self.ways}, self.now.time)

    def axis_of(self, turn: ToolTurn, values: Mapping[Control, float], time: float) -> tuple[Floats, Floats]:
        """Axis and point of a rotation after the motions that follow it."""
        inner = [control for control in self.ways[: self.ways.index(turn) + 1] if isinstance(control, ToolTurn)]
        still = {control: 0.0 if control in inner else value for control, value in values.items()}
        rotation, shift = self.pose(still, time)
        return rotation @ np.asarray(turn.axis), rotation @ np.asarray(turn.about) + shift

    def moved_by(self, rates: Mapping[Control, float]) -> bool:
        """Whether one of its controls has a rate."""
        return any(rates.get(control, 0.0) != 0.0 for control in self.ways)

    def carries(self, turn: ToolTurn, rates: Mapping[Control, float], at: At) -> tuple[Floats, Floats]:
        """Velocity of the point of a rotation, and spin of its axis, from the rates of the motions that follow it."""
        _, point = self.axis_of(turn, at.values, at.time)
        inner = self.ways[: self.ways.index(turn) + 1]
        after = {control: rate for control, rate in rates.items() if control not in inner or _slides(control)}
        velocity, spin = np.zeros(3) + self.shift_rate(after), np.zeros(3)
        for turning, centre in self.spins(after, at):
            velocity, spin = velocity + np.cross(turning, point - centre), spin + turning
        return velocity, spin

    def shift_rate(self, rates: Mapping[Control, float]) -> Floats | float:
        """Rate of its translation."""
        along = [control for control in self.ways if isinstance(control, ToolMotion)]
        return sum(rates.get(control, 0.0) * np.asarray(control.direction) for control in along)

    def spins(self, rates: Mapping[Control, float], at: At) -> list[tuple[Floats, Floats]]:
        """Angular velocity and a point of the axis, for each rotation with a rate."""
        found = []
        for control in self.ways:
            rate = rates.get(control, 0.0)
            if isinstance(control, ToolTurn) and rate != 0.0:
                axis, point = self.axis_of(control, at.values, at.time)
                found.append((rate * axis, point))
        return found

    # Motion --------------------------------------------------------------------------------------------------

    def add_way(self, way: ToolWay) -> None:
        """Add a control of its motion."""
        self.ways.append(way)

    def add_press(self, press: Press) -> None:
        """Let forces and a spring determine its travel."""
        self.presses.append(press)

    @property
    def unknowns(self) -> tuple[Global, ...]:  # type: ignore[override]
        """Controls determined by forces and springs."""
        return tuple(press.unknown for press in self._finding())

    def _finding(self) -> list[Press]:
        """Presses that determine a travel at present."""
        return [press for press in self.presses if not press.held]

    # Term ----------------------------------------------------------------------------------------------------

    def evaluate(self, at: At, into: Into) -> Found:
        """Add the equilibrium equations of its unknown travels. eqs. (4.42), (4.61)"""
        border, borne = into.border, dict[str, float]()
        seen = _Seen(into.residual, into.found, at.values, at.time)
        for press in self._finding():
            k, way = border.number(press.unknown), press.way
            takes, slope = press.takes(at.values[way], way.of_sheet(seen, into.ranks))
            border.residual[k] = takes - at.values[press.force]
            if press.rigid and (force := bear(press, at, into)) is not None:
                borne[press.force.name] = force
                continue
            border.rows[k] = border.columns[k] if way.symmetric else way.row(at)
            border.corner[k, k] += slope
            for other, unknown in enumerate(border.unknowns):
                border.corner[k, other] -= unknown.rates.get(press.force, 0.0)
                border.corner[k, other] -= way.rate(unknown.rates, _moved(into, unknown), at, into)
            border.predictor[k] -= at.rates.get(press.force, 0.0)
            if at.rates:
                border.predictor[k] -= way.rate(at.rates, _moved(into, None), at, into)
            if at.du is not None:
                border.predictor[k] += into.ranks.sum(float(border.rows[k] @ at.du))
        return ToolFound(borne=borne)

    def resultant(self, found: Mapping[Term, Any], ranks: Ranks) -> tuple[Floats, Floats]:
        """Force of the sheet on it and moment about the origin, over all pairs. eq. (4.17)"""
        parts = [found[pair].resultant() for pair in self.pairs]
        force, moment = (sum(part[k] for part in parts) for k in (0, 1))
        return ranks.sum(np.asarray(force) + np.zeros(3)), ranks.sum(np.asarray(moment) + np.zeros(3))

    def resultant_columns(self, found: Mapping[Term, Any], ranks: Ranks) -> dict[str, float]:
        """Its columns of the history: force and moment of the sheet on it."""
        force, moment = self.resultant(found, ranks)
        return {name: float(value) for name, value in zip(self._of_resultant(), [*force, *moment], strict=True)}

    def columns(self, found: Found, ranks: Ranks) -> dict[str, float]:
        """Forces of rigid stops on it, along its travel."""
        borne = found.borne if isinstance(found, ToolFound) else {}
        return {f"{press.force.name}_stop": borne.get(press.force.name, 0.0) for press in self.presses if press.rigid}

    def state(self) -> Tree:
        """Unknown travels, whether each is prescribed at present; whether it is open, and its replacing forces."""
        ways = {press.unknown.name: [press.unknown.value, float(press.held)] for press in self.presses}
        tree: Tree = {"ways": ways}
        if self.load is not None:
            tree |= {"open": self.open, "vector": self.load.vector.copy()}
        return tree

    def restore(self, tree: Tree) -> None:
        """Restore them."""
        for press in self.presses:
            value, held = tree["ways"][press.unknown.name]
            press.unknown.value, press.held = float(value), bool(held)
        if self.load is not None:
            self.load.vector = np.array(tree.get("vector", np.zeros_like(self.load.vector)))
            self._open(bool(tree.get("open", False)))  # a state from before it had forces that replace it

    def stay_open(self, open_now: bool) -> None:
        """Open it, or close it again; its travel is prescribed while it is open."""
        self._open(open_now)
        for press in self.presses:
            press.held = open_now

    def _open(self, open_now: bool) -> None:
        self.open = open_now
        for pair in self.pairs:
            if "block" in vars(pair):  # else it is created with the present pose
                pair.block.open = open_now

    def column_names(self) -> Iterable[str]:
        """Force and moment of the sheet on it, and forces of rigid stops."""
        return [*self._of_resultant(), *(f"{press.force.name}_stop" for press in self.presses if press.rigid)]

    def _of_resultant(self) -> list[str]:
        return [f"{self.name}_{kind}{axis}" for kind in "fm" for axis in "xyz"]

    def strip(self, bare: Self, twins: Twins) -> None:
        """With the twins of its pairs and controls."""
        bare.now = twins.of(self.now)
        bare.pairs = [twins.of(pair) for pair in self.pairs]
        bare.ways = [twins.of(way) for way in self.ways]
        bare.__dict__.pop("kernel", None)
        bare.load = None if self.load is None else twins.of(self.load)
        bare.presses = [press.twin(twins) for press in self.presses]

    def fill(self, piece: Any, mesh: Any) -> None:
        """Build its kernel."""
        self.kernel = self.surface.kernel()


@dataclass(frozen=True)
class _Seen:
    """Data for the force on the tool along a travel."""

    residual: Floats
    found: Mapping[Term, Any]
    controls: Mapping[Control, float]
    time: float


def _moved(into: Into, unknown: Global | None) -> dict[Any, Floats]:
    """Rates of the forces of the sheet on tools, by pair."""
    return {pair: rate for (pair, by), rate in into.moved.items() if by is unknown}


def _slides(control: Control) -> bool:
    return isinstance(control, ToolMotion)


def _turned(turn: ToolTurn, angle: float) -> Pose:
    """Pose of a rotation about its axis."""
    rotation, point = rotation_matrix(angle * np.asarray(turn.axis)), np.asarray(turn.about)
    return np.ascontiguousarray(rotation), point - rotation @ point


def _after(outer: Pose, inner: Pose) -> Pose:
    """Composition: the inner pose, then the outer one."""
    (Q, c), (R, d) = outer, inner
    return np.ascontiguousarray(Q @ R), Q @ d + c

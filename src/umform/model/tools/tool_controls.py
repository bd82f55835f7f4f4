"""Controls of a tool: translation along a direction, rotation about an axis, and their conjugate forces."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.errors import InvalidValue
from umform.model.terms.control import Control, Seen, Twins
from umform.model.terms.forces import vector3
from umform.model.terms.into import At, Into
from umform.ranks import Ranks
from umform.surfaces import Direction, unit_vector

Floats = NDArray[np.float64]


@dataclass(eq=False, repr=False)
class ToolWay(Control):
    """A rigid motion of a tool, and of the tools that follow it; its force is that of all of them on the sheet.

    The force is conjugate to the value, as that of a prescribed displacement: positive where the sheet resists a motion
    in the positive sense, and force times travel is the work on the sheet.

    Attributes
    ----------
    tool : Tool
        The tool for which it was made.
    followers : list of Tool
        Tools that follow it.
    """

    tool: Any = None
    followers: list[Any] = field(default_factory=list)

    @property
    def tools(self) -> list[Any]:
        """All tools that it moves."""
        return [self.tool, *self.followers]

    def force(self, evaluation: Seen, ranks: Ranks) -> float:
        """Conjugate force, or moment, of its tools on the sheet."""
        return 0.0 - self.of_sheet(evaluation, ranks)  # no -0.0

    def of_sheet(self, evaluation: Seen, ranks: Ranks) -> float:
        """Force, or moment, of the sheet on its tools."""
        return sum(self._force_on(tool, evaluation, ranks) for tool in self.tools)

    def row(self, at: At) -> Floats:
        """Derivative of its force with respect to the nodes of this rank, shape (3 n,). eq. (4.62)"""
        rows = [
            pair.block.row(*self._motion(tool, at)) for tool in self.tools for pair in tool.pairs if not pair.tool.open
        ]
        return np.sum(rows, axis=0) if rows else np.zeros(at.u.size)

    def velocity(self, places: Floats, tool: Any, at: At) -> Floats:
        """Velocity of points (n, 3) of one of its tools at the rate 1, shape (n, 3)."""
        velocity, spin, centre = self._motion(tool, at)
        moving: Floats = velocity + np.cross(spin, places - centre)
        return moving

    @property
    def symmetric(self) -> bool:
        """Whether the tangents of all pairs of its tools are symmetric: then row and column are equal."""
        return all(pair.symmetric for tool in self.tools for pair in tool.pairs)

    def rate(self, rates: Mapping[Control, float], moved: Mapping[Any, Floats], at: At, into: Into) -> float:
        """Rate of the force of the sheet on its tools with controls at fixed nodes. eq. (4.63)

        Parameters
        ----------
        rates : mapping of Control to float
            Rates of the controls.
        moved : mapping of Contact to ndarray, shape (3 n,)
            Rates of the forces of the sheet on the tool with these controls, at the nodes.
        """
        share = 0.0
        for tool in self.tools:
            for pair in tool.pairs:
                if pair in moved:
                    share += self._rate_on(tool, pair, rates, moved[pair].reshape(-1, 3), at, into)
        return into.ranks.sum(share)

    @abstractmethod
    def _force_on(self, tool: Any, evaluation: Seen, ranks: Ranks) -> float:
        """Force of the sheet on one of its tools."""

    @abstractmethod
    def _motion(self, tool: Any, at: At) -> tuple[Floats, Floats, Floats]:
        """Velocity, angular velocity and a point of the axis of a tool at the rate 1."""

    @abstractmethod
    def _rate_on(
        self, tool: Any, pair: Any, rates: Mapping[Control, float], moved: Floats, at: At, into: Into
    ) -> float:
        """Rate of the force of one pair on a tool."""

    def strip(self, bare: Any, twins: Twins) -> None:
        """Of the twins of its tools."""
        bare.tool = twins.of(self.tool)
        bare.followers = [twins.of(tool) for tool in self.followers]


@dataclass(eq=False, repr=False)
class ToolMotion(ToolWay):
    """Translation of a tool along a direction; its force is that of the tool on the sheet along it."""

    direction: tuple[float, float, float] = (0.0, 0.0, 1.0)

    def _force_on(self, tool: Any, evaluation: Seen, ranks: Ranks) -> float:
        force, _ = tool.resultant(evaluation.found, ranks)
        return float(force @ np.asarray(self.direction))

    def _motion(self, tool: Any, at: At) -> tuple[Floats, Floats, Floats]:
        return np.asarray(self.direction), np.zeros(3), np.zeros(3)

    def _rate_on(
        self, tool: Any, pair: Any, rates: Mapping[Control, float], moved: Floats, at: At, into: Into
    ) -> float:
        return float(moved.sum(axis=0) @ np.asarray(self.direction))


@dataclass(eq=False, repr=False)
class ToolTurn(ToolWay):
    """Rotation of a tool about an axis, in radians; its force is the moment of the tool on the sheet."""

    axis: tuple[float, float, float] = (0.0, 0.0, 1.0)
    about: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def _force_on(self, tool: Any, evaluation: Seen, ranks: Ranks) -> float:
        """Moment of the sheet on the tool about the present axis."""
        axis, point = tool.axis_of(self, evaluation.controls, evaluation.time)
        force, moment = tool.resultant(evaluation.found, ranks)
        return float((moment - np.cross(point, force)) @ axis)

    def _motion(self, tool: Any, at: At) -> tuple[Floats, Floats, Floats]:
        axis, point = tool.axis_of(self, at.values, at.time)
        return np.zeros(3), axis, point

    def _rate_on(
        self, tool: Any, pair: Any, rates: Mapping[Control, float], moved: Floats, at: At, into: Into
    ) -> float:
        """The forces change, and later motions move the axis."""
        axis, point = tool.axis_of(self, at.values, at.time)
        arms = (into.positions + at.u).reshape(-1, 3) - point
        rate = float(np.cross(arms, moved).sum(axis=0) @ axis)
        force, moment = into.found[pair].resultant(point)
        velocity, spin = tool.carries(self, rates, at)
        return rate - float(np.cross(velocity, force) @ axis) + float(moment @ np.cross(spin, axis))


@dataclass(eq=False, repr=False)
class ToolForce(Control):
    """A force (or moment) on a tool along one of its travels, which is then unknown."""

    way: Any = None

    def strip(self, bare: Any, twins: Twins) -> None:
        """On the twin of its way."""
        bare.way = twins.of(self.way)


def turn_of(name: str, tool: Any, axis: Direction, about: ArrayLike) -> ToolTurn:
    """A checked rotation of a tool."""
    point = vector3(about, f"turn of tool {tool.name}")
    return ToolTurn(name, axis=unit_vector(axis, "turn"), about=tuple(point.tolist()), tool=tool)


def refuse_given_and_found(others: Sequence[ToolWay], way: ToolWay, name: str) -> None:
    """Refuse a travel along which a tool would have both a prescribed motion and a force.

    Parameters
    ----------
    others : sequence of ToolWay
        Existing travels of the tool.
    way : ToolWay
        The new one.
    name : str
        Name of its control.

    Raises
    ------
    InvalidValue
        If one of the others has the same direction.
    """
    for other in others:
        if other.tool is way.tool and _along(other, way):
            raise InvalidValue(
                "a tool cannot be driven and pressed along the same direction",
                where=f"tool {way.tool.name}",
                value=f"{other.name}, and {name}",
                cause="its way would be given and found at the same time",
                remedy="press it along another direction, or drive it only; Release gives its way back to steps",
            )


def _along(one: ToolWay, other: ToolWay) -> bool:
    """Whether two travels of a tool have a common component: directions that are not perpendicular, or one axis."""
    if isinstance(one, ToolMotion) and isinstance(other, ToolMotion):
        return abs(math.fsum(a * b for a, b in zip(one.direction, other.direction, strict=True))) > 1e-9
    if not (isinstance(one, ToolTurn) and isinstance(other, ToolTurn)):
        return False
    between = np.subtract(other.about, one.about)
    size = 1e-9 * max(np.abs(one.about).max(), np.abs(other.about).max())
    parallel = np.linalg.norm(np.cross(one.axis, other.axis)) < 1e-9
    return bool(parallel and np.linalg.norm(np.cross(between, one.axis)) <= size)

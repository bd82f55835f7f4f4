"""What moves a tool: ways along a direction, turns about an axis, and forces that press it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from umform.errors import InvalidValue, NotFinite
from umform.model.control import Control, Seen, Twins
from umform.model.forces import vector3
from umform.model.into import Global
from umform.ranks import Ranks
from umform.surfaces import Direction, unit_vector


@dataclass(eq=False, repr=False)
class ToolMotion(Control):
    """Translation of a tool along a direction; its force is that of the sheet on the tool along it."""

    direction: tuple[float, float, float] = (0.0, 0.0, 1.0)
    tool: Any = None

    def force(self, evaluation: Seen, ranks: Ranks) -> float:
        """Force of the sheet on the tool along the direction."""
        force, _ = self.tool.resultant(evaluation.found, ranks)
        return float(force @ np.asarray(self.direction))

    def strip(self, bare: Any, twins: Twins) -> None:
        """Of the twin of its tool."""
        bare.tool = twins.of(self.tool)


@dataclass(eq=False, repr=False)
class ToolTurn(Control):
    """Turn of a tool about an axis through a point, in radians; its force is the moment of the sheet on the tool."""

    axis: tuple[float, float, float] = (0.0, 0.0, 1.0)
    about: tuple[float, float, float] = (0.0, 0.0, 0.0)
    tool: Any = None

    def force(self, evaluation: Seen, ranks: Ranks) -> float:
        """Moment of the sheet on the tool about the axis where it is now."""
        axis, point = self.tool.axis_of(self, evaluation.controls, evaluation.time)
        force, moment = self.tool.resultant(evaluation.found, ranks)
        return float((moment - np.cross(point, force)) @ axis)

    def strip(self, bare: Any, twins: Twins) -> None:
        """Of the twin of its tool."""
        bare.tool = twins.of(self.tool)


@dataclass(eq=False, repr=False)
class ToolForce(Control):
    """A force (or moment) that presses a tool along one of its ways, which is an unknown then."""

    way: Any = None

    def strip(self, bare: Any, twins: Twins) -> None:
        """On the twin of its way."""
        bare.way = twins.of(self.way)


@dataclass(eq=False)
class Press:
    """What presses a tool along a way: forces, and a spring.

    Attributes
    ----------
    unknown : Global
        The way that is found.
    way : ToolMotion
        The control that it moves.
    forces : list of ToolForce
        Controls of the forces on the tool along the way.
    stiffness, free : float
        Of a spring that holds the tool, and the way at which the spring has no force.
    """

    unknown: Global
    way: ToolMotion
    forces: list[ToolForce]
    stiffness: float = 0.0
    free: float = 0.0


def turn_of(name: str, tool: Any, axis: Direction, about: ArrayLike) -> ToolTurn:
    """A turn of a tool, checked."""
    point = vector3(about, f"turn of tool {tool.name}")
    return ToolTurn(name, axis=unit_vector(axis, "turn"), about=tuple(point.tolist()), tool=tool)


def check_spring(stiffness: float, preload: float, where: str) -> None:
    """Refuse a spring that is none."""
    if not np.isfinite([stiffness, preload]).all():
        raise NotFinite(
            "a spring needs finite numbers",
            where=where,
            value=f"stiffness {stiffness}, preload {preload}",
            cause="an earlier computation",
            remedy="give a finite stiffness and a finite preload",
        )
    if not stiffness > 0.0:
        raise InvalidValue(
            "the stiffness of a spring must be positive",
            where=where,
            value=stiffness,
            cause="a sign, or a tool that a force alone presses",
            remedy="a force per length; for a force alone model.press(tool, direction)",
        )

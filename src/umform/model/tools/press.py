"""Force-driven tools: force or moment, spring and stops along an unknown travel; its equation. docs/theory, 4.18"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Annotated, Any

from annotated_types import Gt

from umform.model.terms.control import Twins
from umform.model.terms.into import Global
from umform.model.tools.tool_controls import ToolForce, ToolWay
from umform.spec import About

#: Force per length of a spring.
Stiffness = Annotated[
    float,
    Gt(0.0),
    About(
        cause="a sign, or a tool that a force alone presses",
        remedy="a force per length; for a force alone model.press(tool, direction)",
    ),
]


@dataclass(frozen=True)
class Stop:
    """A stop of a tool: distance blocks, the end of a spring.

    Attributes
    ----------
    at : float
        Travel at which the tool touches it.
    stiffness : float
        Force per length beyond; infinite for a rigid stop, which limits the travel.
    side : float
        1 for an upper limit of the travel, -1 for a lower one.
    """

    at: float
    stiffness: float
    side: float

    @property
    def rigid(self) -> bool:
        """Whether it limits the travel rigidly."""
        return math.isinf(self.stiffness)

    def reached(self, way: float) -> bool:
        """Whether a tool at this travel rests on it."""
        return self.side * (way - self.at) >= -1e-9 * abs(self.at)

    def push(self, way: float) -> tuple[float, float]:
        """Force on the tool along its travel, and minus its derivative."""
        beyond = 0.0 if self.rigid else self.side * (way - self.at)
        return (-self.side * self.stiffness * beyond, self.stiffness) if beyond > 0.0 else (0.0, 0.0)


@dataclass(eq=False)
class Press:
    """Force or moment, spring and stops of a tool with unknown travel.

    Attributes
    ----------
    unknown : Global
        The unknown travel.
    way : ToolMotion or ToolTurn
        Its control.
    force : ToolForce
        Control of the force on the tool along the travel, or of the moment about its axis.
    stiffness, free : float
        Stiffness of a spring that holds the tool, and the travel at which it is unloaded.
    stops : list of Stop
        Limits of the travel.
    held : bool
        Whether the travel is prescribed at present and the force is its reaction.
    gaps : list of Tool
        Tools to which one of the stops keeps a gap.
    """

    unknown: Global
    way: ToolWay
    force: ToolForce
    stiffness: float = 0.0
    free: float = 0.0
    stops: list[Stop] = field(default_factory=list)
    held: bool = False
    gaps: list[Any] = field(default_factory=list)

    def takes(self, way: float, sheet: float) -> tuple[float, float]:
        """Force of the press for equilibrium of the tool at a travel, and its derivative. eqs. (4.41), (4.61)

        Parameters
        ----------
        way : float
            Value of the travel.
        sheet : float
            Force of the sheet on the tool along the travel.
        """
        pushes = [stop.push(way) for stop in self.stops]
        force = self.stiffness * (way - self.free) - sum(push for push, _ in pushes) - sheet
        return force, self.stiffness + sum(slope for _, slope in pushes)

    @contextmanager
    def driven(self) -> Iterator[None]:
        """Prescribe the travel within this block; the force is then its reaction."""
        self.held = True
        try:
            yield
        finally:
            self.held = False

    @property
    def rigid(self) -> bool:
        """Whether one of its stops is rigid."""
        return any(stop.rigid for stop in self.stops)

    @property
    def bounds(self) -> tuple[float, float]:
        """Range of the travel between rigid stops."""
        rigid = [stop for stop in self.stops if stop.rigid]
        least = max((stop.at for stop in rigid if stop.side < 0.0), default=-math.inf)
        return least, min((stop.at for stop in rigid if stop.side > 0.0), default=math.inf)

    def room(self, sense: float) -> float:
        """Travel to the rigid stop ahead, in the sense +1 or -1; infinite if there is none."""
        least, largest = self.bounds
        return largest - self.way.value if sense > 0.0 else self.way.value - least

    def bearing(self, way: float, rest: float, measure: float) -> float | None:
        """Position of the active rigid stop; None where forces alone balance the tool. eq. (4.140)

        Parameters
        ----------
        way : float
            Value of the travel.
        rest : float
            Residual of the other forces: the force that a stop would have to exert on the tool along the travel.
        measure : float
            A stiffness that scales travel against force; equilibria do not depend on it.
        """
        least, largest = self.bounds
        if measure * (way - least) <= rest:
            return least
        return largest if measure * (way - largest) >= rest else None

    def twin(self, twins: Twins) -> Press:
        """The same of the twins of its controls."""
        way, force = twins.of(self.way), twins.of(self.force)
        gaps = [twins.of(tool) for tool in self.gaps]
        return Press(twins.of(self.unknown), way, force, self.stiffness, self.free, list(self.stops), self.held, gaps)

"""Several bends in one part: where, in which direction, how far, in which tools."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType

from umform.processes.air_bending.parameters import AirBending
from umform.processes.bend_sequence.checks import check_bend, check_sequence

#: Parameters of the tools that a bend may have of its own.
TOOLS = ("opening", "die_angle", "die_radius", "punch_angle", "punch_radius")


@dataclass(frozen=True)
class Bend:
    """One bend of a part.

    Parameters
    ----------
    position : float
        Distance of the bend line from the left end of the flat strip, in mm.
    angle : float, optional
        Wanted angle between the legs after unloading, in degrees; or
    stroke : float, optional
        the stroke in mm.
    direction : {"up", "down"}
        Where the legs go: "down" is bent with the part turned over.
    tools : mapping of str to float
        Tools of this bend that differ from those of the sequence: `TOOLS`.
    """

    position: float
    angle: float | None = None
    stroke: float | None = None
    direction: str = "up"
    tools: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "tools", MappingProxyType(dict(self.tools)))
        check_bend(self, TOOLS)

    @property
    def over(self) -> bool:
        """Whether the part is turned over for it."""
        return self.direction == "down"


@dataclass(frozen=True)
class Bodies:
    """What a part may collide with beside the tips and the V: bodies of punch and die, ram and table, in mm.

    Parameters
    ----------
    punch_width, punch_height : float
        Width of the punch above its flanks, and height from the tip to the ram.
    ram_width : float
        Width of what holds the punch.
    die_width, die_height : float
        Width of the die beyond the opening, on both sides together, and height from its top to the table.
    table_width : float
        Width of what carries the die.
    """

    punch_width: float = 16.0
    punch_height: float = 90.0
    ram_width: float = 60.0
    die_width: float = 24.0
    die_height: float = 60.0
    table_width: float = 90.0


@dataclass(frozen=True)
class BendSequence:
    """A strip that is bent several times, in the order of the bends.

    Parameters
    ----------
    length : float
        Length of the flat strip in mm.
    bends : sequence of Bend
        The bends in their order.
    sheet : AirBending
        Thickness, material, mesh, and the tools of all bends that have none of their own; in plane strain.
    bodies : Bodies
        What the part may collide with.
    """

    length: float
    bends: tuple[Bend, ...]
    sheet: AirBending = AirBending()
    bodies: Bodies = Bodies()

    def __post_init__(self) -> None:
        object.__setattr__(self, "bends", tuple(self.bends))
        check_sequence(self)

    def case(self, bend: Bend) -> AirBending:
        """Sheet and tools of a bend."""
        return replace(self.sheet, **dict(bend.tools), stroke=bend.stroke)  # type: ignore[arg-type]

    def zone(self, bend: Bend) -> float:
        """Length on each side of a bend line that touches the tools and is measured.

        Half of the sheet of a single bend; less where the bent metal of another bend is nearer.
        """
        here = bend.position
        others = [abs(other.position - here) - self.bent(other) for other in self.bends if other.position != here]
        return min([self.case(bend).half_length, *others])

    def bent(self, bend: Bend) -> float:
        """Length on each side of a bend line, at most, that is not straight after the bend."""
        return max(0.25 * self.case(bend).opening, 2.0 * self.sheet.thickness)

"""Several bends in one part: position, direction, goal, tools."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType

from umform.processes.air_bending.spec import AirBending
from umform.processes.bend_sequence.checks import check_bend, check_sequence

#: Parameters of the tools that may differ between bends.
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
        Direction of the legs: for "down" the part is turned over.
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
        """Whether the part is turned over for this bend."""
        return self.direction == "down"


@dataclass(frozen=True)
class Bodies:
    """Bodies for the detection of collisions, besides tips and V: punch and die, ram and table, in mm.

    Parameters
    ----------
    punch_width, punch_height : float
        Width of the punch above its flanks, and height from the tip to the ram.
    ram_width : float
        Width of the punch holder.
    die_width, die_height : float
        Width of the die in excess of the opening, both sides together, and height from its top to the table.
    table_width : float
        Width of the die support.
    """

    punch_width: float = 16.0
    punch_height: float = 90.0
    ram_width: float = 60.0
    die_width: float = 24.0
    die_height: float = 60.0
    table_width: float = 90.0


@dataclass(frozen=True)
class BendSequence:
    """A strip with several bends, in order.

    Parameters
    ----------
    length : float
        Length of the flat strip in mm.
    bends : sequence of Bend
        The bends, in order.
    sheet : AirBending
        Thickness, material, mesh, and the default tools; in plane strain.
    bodies : Bodies
        Bodies for the detection of collisions.
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

        Half of the sheet of a single bend; less if the metal of another bend is nearer.
        """
        here = bend.position
        others = [abs(other.position - here) - self.bent(other) for other in self.bends if other.position != here]
        return min([self.case(bend).half_length, *others])

    def bent(self, bend: Bend) -> float:
        """Largest length on each side of a bend line that is not straight after the bend."""
        return max(0.25 * self.case(bend).opening, 2.0 * self.sheet.thickness)

"""Several bends in one part: position, direction, goal and tools of each, and what does not fit together."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Annotated, ClassVar, Literal

from umform.errors import InvalidValue
from umform.processes.air_bending.goal import check_angle
from umform.processes.air_bending.spec import AirBending, sizes_of
from umform.processes.air_bending.stack import refuse_stack
from umform.spec import About, check_fields, listed, names_its_words
from umform.spec.types import Degrees, Length

#: Parameters of the tools that may differ between bends.
TOOLS = (*sizes_of("die").values(), *sizes_of("punch").values())
#: Largest number of bends.
MOST_BENDS = 50


@names_its_words
@dataclass(frozen=True)
class Bend:
    """One bend of a part, to an angle or to a stroke.

    Examples
    --------
    >>> from umform.processes.bend_sequence import Bend
    >>> Bend(position=20.0, angle=90.0, direction="down").over
    True
    """

    position: Annotated[Length, About(remedy="in mm from the left end of the flat strip")]
    """Distance of the bend line from the left end of the flat strip."""
    angle: Degrees | None = None
    """Angle between the legs after unloading."""
    stroke: Length | None = None
    """Stroke of the punch."""
    direction: Literal["up", "down"] = "up"
    """Direction of the legs; for down the part is turned over."""
    tools: Mapping[str, float] = field(default_factory=dict)
    """Tools of this bend that differ from those of the sequence; their names are `TOOLS`."""

    def __post_init__(self) -> None:
        check_fields(self)
        object.__setattr__(self, "tools", dict(self.tools))
        _check_bend(self)

    @property
    def over(self) -> bool:
        """Whether the part is turned over for this bend."""
        return self.direction == "down"


@names_its_words
@dataclass(frozen=True)
class Bodies:
    """Bodies for the detection of collisions, besides tips and V: punch and die, ram and table."""

    __pydantic_config__: ClassVar = {"extra": "forbid"}

    punch_width: Length = 16.0
    """Width of the punch above its flanks."""
    punch_height: Length = 90.0
    """Height of the punch, from its tip to the ram."""
    ram_width: Length = 60.0
    """Width of the punch holder."""
    die_width: Length = 24.0
    """Width of the die in excess of the opening, both sides together."""
    die_height: Length = 60.0
    """Height of the die, from its top to the table."""
    table_width: Length = 90.0
    """Width of the die support."""

    def __post_init__(self) -> None:
        check_fields(self)


@names_its_words
@dataclass(frozen=True)
class BendSequence:
    """A strip with several bends, in order.

    Examples
    --------
    >>> from umform.processes.bend_sequence import Bend, BendSequence
    >>> case = BendSequence(length=60.0, bends=[Bend(20.0, angle=90.0), Bend(40.0, angle=90.0)])
    >>> len(case.bends)
    2
    """

    groups: ClassVar = {"length": "Part"}
    """Group of the parameters from each of these on."""

    length: Length
    """Length of the flat strip."""
    bends: tuple[Bend, ...]
    """Bends, in order."""
    sheet: AirBending = field(default_factory=AirBending)
    """Thickness, material, mesh, and the default tools; in plane strain."""
    bodies: Bodies = field(default_factory=Bodies)
    """Bodies for the detection of collisions."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "bends", listed(self.bends))
        check_fields(self)
        refuse_stack(self.sheet, "sheet")
        _check_sequence(self)

    @property
    def some_strokes(self) -> BendSequence:
        """The sequence with half of the largest stroke where an angle is wanted: for what does not depend on it."""
        bends = (
            replace(bend, angle=None, stroke=bend.stroke or 0.5 * self.case(bend).largest_stroke) for bend in self.bends
        )
        return replace(self, bends=tuple(bends))

    @property
    def strokes(self) -> dict[str, str]:
        """Paths of the strokes that are looked for, by the names of the angles that they give."""
        bends = enumerate(self.bends)
        return {f"bend {k + 1}: angle": f"bends.{k}.stroke" for k, bend in bends if bend.angle is not None}

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


def _check_bend(bend: Bend) -> None:
    """Refuse a bend without a goal or with two, or with unknown tools.

    Raises
    ------
    InvalidValue
    """
    where = f"bend at {bend.position:g}"
    if (bend.angle is None) == (bend.stroke is None):
        raise InvalidValue(
            "give the angle of a bend or its stroke, one of them",
            where=where,
            cause="none of them is given" if bend.angle is None else "both are given",
            remedy="angle = 90",
        )
    unknown = sorted(set(bend.tools) - set(TOOLS), key=str)
    if unknown:
        raise InvalidValue(
            "this is no size of the tools of a bend",
            where=where,
            value=", ".join(map(str, unknown)),
            cause="another spelling",
            remedy="one of " + ", ".join(TOOLS),
        )


def _check_sequence(sequence: BendSequence) -> None:
    """Refuse bends outside the strip, at the same place, or so near that their dies lack flat sheet.

    Raises
    ------
    InvalidValue
    """
    if not 1 <= len(sequence.bends) <= MOST_BENDS:
        raise InvalidValue(
            f"a part has 1 to {MOST_BENDS} bends",
            where="bends",
            value=len(sequence.bends),
            cause="no bend, or bends of several parts",
            remedy="bends of one part",
        )
    if sequence.sheet.width is not None:
        raise InvalidValue(
            "a sequence of bends is in plane strain",
            where="width",
            value=sequence.sheet.width,
            remedy="leave the width out; forces are those for each mm of the bend",
        )
    places = [bend.position for bend in sequence.bends]
    twice = sorted({place for place in places if places.count(place) > 1})
    if twice:
        raise InvalidValue(
            "a bend line is bent once",
            where="bends",
            value=twice,
            cause="two bends at one position",
            remedy="one of them, or another position",
        )
    for count, bend in enumerate(sequence.bends, start=1):
        _check_place(sequence, bend, count)


def _check_place(sequence: BendSequence, bend: Bend, count: int) -> None:
    """Refuse a bend whose shoulders do not support flat sheet."""
    case = sequence.case(bend)
    if bend.angle is not None:
        try:
            check_angle(case, bend.angle)
        except InvalidValue as error:
            error.where = f"bend {count}, angle"
            raise
    if bend.position >= sequence.length:
        raise InvalidValue(
            "the bend line lies beyond the strip",
            where=f"bend {count}",
            value=bend.position,
            cause="another unit",
            remedy=f"less than the length {sequence.length:g} of the strip",
        )
    least, at = case.reach + case.thickness, bend.position
    nearest = min(at, sequence.length - at, sequence.zone(bend))
    if nearest < least:
        raise InvalidValue(
            "a flange is too short for the die",
            where=f"bend {count} at {at:g}",
            value=nearest,
            cause=f"with an opening of {case.opening:g} the sheet rests on the shoulders up to {case.reach:.4g} from "
            "the bend line; the flange must go on straight by a thickness",
            remedy=f"{least:.4g} at least up to an end or the metal of another bend, or a narrower die for this bend",
        )

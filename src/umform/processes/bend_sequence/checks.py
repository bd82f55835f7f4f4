"""Checks of bends and sequences; errors name the likely cause and remedy."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from typing import Any, Protocol

from umform.errors import InvalidValue
from umform.processes.air_bending.goal import check_angle
from umform.processes.air_bending.spec import AirBending
from umform.processes.rules import length


class Bend(Protocol):
    """Parameters of :class:`umform.processes.bend_sequence.Bend` that the checks use."""

    @property
    def position(self) -> float:
        """Distance of the bend line from the left end."""

    @property
    def angle(self) -> float | None:
        """Wanted angle."""

    @property
    def stroke(self) -> float | None:
        """Stroke instead of the angle."""

    @property
    def direction(self) -> str:
        """Up or down."""

    @property
    def tools(self) -> Mapping[str, float]:
        """Tools of this bend."""


class BendSequence(Protocol):
    """Parameters of :class:`umform.processes.bend_sequence.BendSequence` that the checks use."""

    @property
    def length(self) -> float:
        """Length of the flat strip."""

    @property
    def bends(self) -> Sequence[Any]:
        """The bends."""

    @property
    def sheet(self) -> AirBending:
        """Sheet and tools."""

    @property
    def bodies(self) -> Any:
        """Bodies of the tools."""

    def case(self, bend: Any) -> AirBending:
        """Sheet and tools of a bend."""

    def zone(self, bend: Any) -> float:
        """Length on each side of a bend line that touches the tools."""


#: Largest number of bends.
_MOST_BENDS = 50
_LENGTH = length("the length of the flat strip", "in mm, such as 80")
_POSITION = length("the position of a bend line", "in mm from the left end of the flat strip")
_BODY = length("a size of the bodies of the tools", "in mm")


def check_bend(bend: Bend, tools: Iterable[str]) -> None:
    """Refuse a bend without a goal or with two, or with unknown tools.

    Raises
    ------
    InvalidValue
    """
    _POSITION.check("position", bend.position)
    where = f"bend at {bend.position:g}"
    if (bend.angle is None) == (bend.stroke is None):
        raise InvalidValue(
            "give the angle of a bend or its stroke, one of them",
            where=where,
            cause="none of them is given" if bend.angle is None else "both are given",
            remedy="angle = 90",
        )
    if bend.direction not in ("up", "down"):
        raise InvalidValue(
            "a bend goes up or down",
            where=where,
            value=bend.direction,
            cause="another word",
            remedy="direction = 'down'",
        )
    unknown = sorted(set(bend.tools) - set(tools))
    if unknown:
        raise InvalidValue(
            "this is no size of the tools of a bend",
            where=where,
            value=", ".join(unknown),
            remedy="one of " + ", ".join(tools),
        )


def check_sequence(sequence: BendSequence) -> None:
    """Refuse bends outside the strip, at the same place, or so near that their dies lack flat sheet.

    Raises
    ------
    InvalidValue
    """
    _LENGTH.check("length", sequence.length)
    for name, value in asdict(sequence.bodies).items():
        _BODY.check(name, value)
    if not 1 <= len(sequence.bends) <= _MOST_BENDS:
        raise InvalidValue(f"a part has 1 to {_MOST_BENDS} bends", where="bends", value=len(sequence.bends))
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
        raise InvalidValue("a bend line is bent once", where="bends", value=twice, cause="two bends at one position")
    for count, bend in enumerate(sequence.bends, start=1):
        _check_place(sequence, bend, count)


def _check_place(sequence: BendSequence, bend: Bend, count: int) -> None:
    """Refuse a bend whose shoulders do not support flat sheet."""
    case = sequence.case(bend)
    if bend.angle is not None:
        check_angle(case, bend.angle)
    if bend.position >= sequence.length:
        raise InvalidValue(
            "the bend line lies beyond the strip", where=f"bend {count}", value=bend.position, cause="another unit"
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

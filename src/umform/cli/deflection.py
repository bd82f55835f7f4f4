"""The deflection of the press brake in ``umform bend``: the angle along the bend."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from umform.errors import InvalidValue
from umform.spec import parameters
from umform.studies.deflection.press_brake import PressBrake

if TYPE_CHECKING:
    from umform.processes.air_bending.bend import AirBend


def press_brake(given: dict[str, Any], length: float | None, *, sequence: bool, bottoming: bool) -> PressBrake | None:
    """The press brake of the options, which are taken out of the given values; None without one."""
    brake = PressBrake(**{name: given.pop(name) for name in parameters(PressBrake)})
    if brake.span is None:
        return None
    if sequence or bottoming:
        raise InvalidValue(
            "the deflection along the bend is that of one air bend",
            where="--span",
            value="--sequence" if sequence else "--bottoming",
            remedy="each bend of the sequence alone, with --angle or --stroke",
        )
    if length is None or length > brake.span:
        raise InvalidValue(
            "the deflection along the bend needs its length, at most the span",
            where="--length",
            value=length,
            cause="it is missing" if length is None else f"the side frames are {brake.span:g} apart",
            remedy="--length 2500, for instance",
        )
    return brake


def deflected(bend: AirBend, brake: PressBrake | None, place: Path) -> tuple[AirBend, list[Path]]:
    """The bend with the angle along it, and its files; without a press brake the bend itself."""
    if brake is None:
        return bend, []
    from umform.studies.deflection import angle_along

    assert bend.bend_length is not None
    found = angle_along(bend.case, brake, bend.bend_length, bend)
    return bend.with_annex(found.annex), found.write(place)

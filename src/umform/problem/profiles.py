"""The profiles of a deck: sections of tools, by corners with radii or by segments."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import reduce
from pathlib import Path as File
from typing import Annotated, Any, Literal

from umform import surfaces
from umform.problem.notes import Built, Discriminator, Field, Tag
from umform.problem.parts import NotNegative, Pair, Part, number_or_array
from umform.problem.reading import read
from umform.spec import OneOf, Scalar, scalars
from umform.surfaces import Profile

Segment = Annotated[surfaces.Line | surfaces.Arc, OneOf("kind", lambda: {"line": surfaces.Line, "arc": surfaces.Arc})]
Radii = Annotated[
    Annotated[NotNegative, Tag("number")] | Annotated[list[NotNegative], Tag("array")], Discriminator(number_or_array)
]


class ByCorners(Part):
    """Lines between rounded corners; the solid is on the left of the direction of travel."""

    corners: Annotated[list[Pair], Field(min_length=2, max_length=1000)]
    """Corners in order."""
    radii: Radii = 0.0
    """Radius at all corners, or at each of them."""
    closed: bool = True
    """The last corner is followed by the first."""

    def build(self, folder: File = File()) -> Profile:
        """The profile."""
        del folder
        return Profile.from_corners(self.corners, self.radii, self.closed)


class BySegments(Part):
    """Lines and arcs, one after the other; the solid is on the left of the direction of travel."""

    segments: Annotated[list[Segment], Field(min_length=1, max_length=1000)]
    """In order, each starting where the previous one ends."""
    closed: bool = True
    """The end of the last one is the start of the first one."""

    def build(self, folder: File = File()) -> Profile:
        """The profile."""
        del folder
        return Profile(self.segments, self.closed)


class FromDxf(Part, of=Profile.from_dxf, leave=("path",)):
    """The lines and arcs of a DXF drawing."""

    file: Annotated[str, Field(min_length=1)]
    """Path, from the folder of the deck."""
    layer: str | None
    solid: Literal["inside", "outside", "below", "above", "left", "right"] | None
    origin: Pair
    unit: Literal["mm", "cm", "m", "um", "in", "ft"]

    def build(self, folder: File = File()) -> Profile:
        """The profile."""
        return Profile.from_dxf(folder / self.file, **self.of_spec())


_KEYS: dict[str, type[ByCorners | BySegments | FromDxf]] = {
    "corners": ByCorners,
    "segments": BySegments,
    "file": FromDxf,
}


def _kind(value: Any) -> str | None:
    if isinstance(value, str):
        return "name"
    if isinstance(value, dict):
        return next((key for key in _KEYS if key in value), None)
    return next((key for key, kind in _KEYS.items() if isinstance(value, kind)), None)


ProfilePart = Annotated[
    Annotated[ByCorners, Tag("corners")]
    | Annotated[BySegments, Tag("segments")]
    | Annotated[FromDxf, Tag("file")]
    | Annotated[str, Field(min_length=1), Tag("name")],
    Discriminator(
        _kind,
        custom_error_type="profile",
        custom_error_message="a profile has corners, segments or file, or is the name of a DXF file",
    ),
]


def profile_of(part: ProfilePart, folder: File) -> Profile:
    """The profile; a name alone means a drawing that contains only the section."""
    return (FromDxf.of_values(file=part) if isinstance(part, str) else part).build(folder)


#: A section that is read at once.
ReadProfile = Annotated[ProfilePart, Built(Profile, profile_of)]


def as_written(numbers: Iterable[Scalar], data: Mapping[str, Any]) -> Iterator[Scalar]:
    """Numbers of a problem, those of its profiles by corners or from drawings under the keys that its data have.

    Parameters
    ----------
    numbers : iterable of Scalar
        Those of its content.
    data : mapping
        Its data.
    """
    done = set()
    for one in numbers:
        path, inside, _ = one.path.partition(".segments.")
        table = reduce(_entry, path.split("."), data) if inside else None
        if not inside or _kind(table) == "segments":
            yield one
        elif path not in done and isinstance(table, Mapping):
            done.add(path)
            yield from scalars(read(_KEYS[_kind(table) or ""], table, {}), path)


def _entry(table: Any, key: str) -> Any:
    """An entry of a table or an array of the data."""
    return table[int(key)] if isinstance(table, list) else table.get(key)


def profile_table(profile: Profile) -> dict[str, Any]:
    """The table of a profile: its lines and arcs; no drawing is needed beside it."""
    return {"segments": [_segment(segment) for segment in profile.segments], "closed": profile.closed}


def _segment(segment: surfaces.Line | surfaces.Arc) -> dict[str, Any]:
    ends = {"start": segment.start, "end": segment.end}
    if isinstance(segment, surfaces.Arc):
        return {"kind": "arc", **ends, "centre": segment.centre, "clockwise": bool(segment.clockwise)}
    return {"kind": "line", **ends}

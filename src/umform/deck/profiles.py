"""The profiles of a deck: sections of tools, by corners with radii or by segments."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from umform import surfaces
from umform.deck.parts import NotNegative, Pair, Part, number_or_array
from umform.surfaces import Profile


class Line(Part):
    """Straight segment."""

    kind: Literal["line"]
    """The word line."""
    start: Pair
    """First end."""
    end: Pair
    """Second end."""

    def build(self) -> surfaces.Line:
        """The segment."""
        return surfaces.Line(self.start, self.end)


class Arc(Part):
    """Circular segment; where start and end are the same it is the whole circle."""

    kind: Literal["arc"]
    """The word arc."""
    start: Pair
    """First end."""
    end: Pair
    """Second end."""
    centre: Pair
    """Centre, at the same distance from both ends."""
    clockwise: bool = False
    """Turns to the right: a concave arc."""

    def build(self) -> surfaces.Arc:
        """The segment."""
        return surfaces.Arc(self.start, self.end, self.centre, self.clockwise)


Segment = Annotated[Line | Arc, Field(discriminator="kind")]
Radii = Annotated[
    Annotated[NotNegative, Tag("number")] | Annotated[list[NotNegative], Tag("array")], Discriminator(number_or_array)
]


class ByCorners(Part):
    """Lines between corners that are rounded; the solid is on the left of who walks along them."""

    corners: Annotated[list[Pair], Field(min_length=2, max_length=1000)]
    """Corners in the order of the walk."""
    radii: Radii = 0.0
    """Radius at all corners, or at each of them."""
    closed: bool = True
    """The last corner is followed by the first."""

    def build(self) -> Profile:
        """The profile."""
        return Profile.from_corners(self.corners, self.radii, self.closed)


class BySegments(Part):
    """Lines and arcs, one after the other; the solid is on the left of who walks along them."""

    segments: Annotated[list[Segment], Field(min_length=1, max_length=1000)]
    """In the order of the walk, each starting where the one before has ended."""
    closed: bool = True
    """The last one ends where the first one starts."""

    def build(self) -> Profile:
        """The profile."""
        return Profile([segment.build() for segment in self.segments], self.closed)


def _kind(value: Any) -> str | None:
    if isinstance(value, dict):
        return next((key for key in ("corners", "segments") if key in value), None)
    return "corners" if isinstance(value, ByCorners) else "segments" if isinstance(value, BySegments) else None


ProfilePart = Annotated[
    Annotated[ByCorners, Tag("corners")] | Annotated[BySegments, Tag("segments")],
    Discriminator(_kind, custom_error_type="profile", custom_error_message="a profile has corners or segments"),
]

"""Tools of a deck from profiles and from files."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path as File
from typing import Annotated, Literal

from pydantic import Field

from umform import surfaces
from umform.problem.parts import Positive, Vector, Way
from umform.problem.placeable import ORIGIN, Placeable
from umform.problem.profiles import ProfilePart, profile_of
from umform.surfaces import Tool

#: Sine of the angle between two segments of a section above which they form an edge.
_EDGE = 1e-3


class Profiled(Placeable):
    """A tool with a profile."""

    profile: ProfilePart
    """Its section."""

    def convex_radii(self, own: Tool) -> Iterator[float]:
        """Radii of convex arcs, and 0 if there is a sharp edge."""
        assert isinstance(own, surfaces.Extruded | surfaces.Revolved | surfaces.LedAround)
        segments, closed = own.profile.segments, own.profile.closed
        for i, segment in enumerate(segments):
            if isinstance(segment, surfaces.Arc) and not segment.clockwise:
                yield segment.radius
            if i + 1 < len(segments) or closed:
                one, other = segment.tangents()[1], segments[(i + 1) % len(segments)].tangents()[0]
                if one[0] * other[1] - one[1] * other[0] > _EDGE:
                    yield 0.0


class Extruded(Profiled):
    """An extruded profile; by default its plane is the xz-plane and the tool extends along y."""

    shape: Literal["Extruded"]
    """The word Extruded."""
    origin: Vector = ORIGIN
    """Where the origin of the profile lies."""
    x: Way = "x"
    """First direction of the profile."""
    y: Way = "z"
    """Second direction of the profile."""

    def _tool(self, folder: File) -> Tool:
        return surfaces.Extruded(profile_of(self.profile, folder), self.origin, self.x, self.y)


class Revolved(Profiled):
    """A profile revolved about an axis: its first coordinate is the radius, its second one lies along the axis."""

    shape: Literal["Revolved"]
    """The word Revolved."""
    origin: Vector = ORIGIN
    """Where the origin of the profile lies."""
    axis: Way = "z"
    """Direction of the axis."""

    def _tool(self, folder: File) -> Tool:
        return surfaces.Revolved(profile_of(self.profile, folder), self.origin, self.axis)


class LedAround(Profiled):
    """A profile swept around a rectangle with rounded corners: its first coordinate is the distance outwards."""

    shape: Literal["LedAround"]
    """The word LedAround."""
    size: Annotated[tuple[Positive, Positive], Field(strict=False)]
    """Sides of the rectangle."""
    corner: Positive
    """Radius of its corners."""
    origin: Vector = ORIGIN
    """Centre of the rectangle, at the origin of the profile."""
    x: Way = "x"
    """First side."""
    y: Way = "y"
    """Second side, at right angles; the second coordinate of the profile lies along x cross y."""

    def _tool(self, folder: File) -> Tool:
        return surfaces.LedAround(profile_of(self.profile, folder), self.size, self.corner, self.origin, self.x, self.y)


class Drawing(Placeable):
    """The faces of a STEP or IGES file, or the triangles of an STL file."""

    shape: Literal["Drawing"]
    """The word Drawing."""
    file: Annotated[str, Field(min_length=1)]
    """Path, from the folder of the deck; it ends in .step, .stp, .iges, .igs or .stl."""
    tolerance: Positive = 1e-3
    """Largest distance of the tool from free-form faces of a STEP or IGES file."""
    sharp: Annotated[float, Field(gt=0, lt=90)] | None = None
    """Angle in degrees from which an edge is sharp: by default 30 between triangles of STL, 2 between faces."""
    open: bool = False
    """The surface may have rims; beyond them there is no contact."""
    scale: Positive = 1.0
    """Factor to the unit of the model: from millimetres for STEP and IGES, from the unit of an STL file."""

    def convex_radii(self, own: Tool) -> Iterator[float]:
        """One over the largest curvature."""
        assert isinstance(own, surfaces.CadTool | surfaces.Triangulated)
        if own.largest_curvature > 0.0:
            yield 1.0 / own.largest_curvature

    def _tool(self, folder: File) -> Tool:
        return surfaces.read_tool(
            folder / self.file, tolerance=self.tolerance, sharp=self.sharp, open=self.open, scale=self.scale
        )

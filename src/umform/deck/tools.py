"""The tools of a deck: all those of umform.surfaces, each of which may be turned and shifted."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path as File
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field

from umform import surfaces
from umform.deck.parts import NotNegative, Part, Positive, Vector, Way
from umform.deck.profiles import ProfilePart, profile_of
from umform.surfaces import Tool
from umform.surfaces.directions import rotation_matrix

Angle = Annotated[float, Field(gt=0, lt=180)]
ORIGIN = (0.0, 0.0, 0.0)
#: Sine of the angle between two segments of a section from which they make an edge.
_EDGE = 1e-3


class Placeable(Part):
    """A tool, which may be turned about the origin and then shifted."""

    rotation: Vector = ORIGIN
    """Rotation vector in degrees: [0, 90, 0] turns by 90 degrees about y."""
    translation: Vector = ORIGIN
    """Shift after the rotation."""

    offset: float = 0.0
    """Distance by which the tool is grown on all sides; a sheet of this thickness lies between it and the drawn one."""
    other_side: bool = False
    """The tool is what lies beyond this distance: the punch of a die."""

    def build(self, folder: File = File()) -> Tool:
        """The tool in its place.

        Parameters
        ----------
        folder : Path
            Where files are looked for.
        """
        tool = self._tool(folder)
        if self.other_side:
            tool = tool.counterpart(self.offset)
        elif self.offset:
            tool = tool.offset(self.offset)
        if self.rotation == ORIGIN and self.translation == ORIGIN:
            return tool
        x, y, z = (math.radians(angle) for angle in self.rotation)
        return tool.moved(self.translation, (x, y, z))

    def _tool(self, folder: File) -> Tool:
        del folder
        own = {name: getattr(self, name) for name in type(self).model_fields if name not in _NOT_OF_THE_TOOL}
        made: Tool = getattr(surfaces, type(self).__name__)(**own)
        return made

    def convex_radii(self, own: Tool) -> Iterator[float]:
        """Radii that a sheet may be bent around, 0 at an edge, of the tool as it is without offset and place."""
        yield from ()


_NOT_OF_THE_TOOL = ("shape", "rotation", "translation", "offset", "other_side")


class Plane(Placeable):
    """Half-space behind a plane."""

    shape: Literal["Plane"]
    """The word Plane."""
    point: Vector = ORIGIN
    """A point of the plane."""
    normal: Way = "z"
    """Normal out of the tool, towards the sheet."""


class Cylinder(Placeable):
    """Round bar of endless length, or the space around a bore."""

    shape: Literal["Cylinder"]
    """The word Cylinder."""
    centre: Vector
    """A point of the axis."""
    axis: Way
    """Direction of the axis."""
    radius: Positive
    """Radius."""
    inside: bool = False
    """The sheet lies inside of the bore."""

    def convex_radii(self, own: Tool) -> Iterator[float]:
        """Radius of the bar."""
        if not self.inside:
            yield self.radius


class Sphere(Placeable):
    """Ball, or the space around a bowl."""

    shape: Literal["Sphere"]
    """The word Sphere."""
    centre: Vector
    """Centre."""
    radius: Positive
    """Radius."""
    inside: bool = False
    """The sheet lies inside of the bowl."""

    def convex_radii(self, own: Tool) -> Iterator[float]:
        """Radius of the ball."""
        if not self.inside:
            yield self.radius


class Torus(Placeable):
    """Ring of round section."""

    shape: Literal["Torus"]
    """The word Torus."""
    centre: Vector
    """Centre of the ring."""
    axis: Way
    """Direction across the ring."""
    major: Positive
    """Radius of the ring."""
    minor: Positive
    """Radius of the section."""

    def convex_radii(self, own: Tool) -> Iterator[float]:
        """Radius of the section."""
        yield self.minor


class Box(Placeable):
    """Box with rounded edges and corners."""

    shape: Literal["Box"]
    """The word Box."""
    centre: Vector
    """Centre."""
    size: Annotated[tuple[Positive, Positive, Positive], Field(strict=False)]
    """Length along its three directions, over all."""
    radius: NotNegative = 0.0
    """Radius of edges and corners; 0 leaves them sharp."""
    x: Way = "x"
    """First direction."""
    y: Way = "y"
    """Second direction, at right angles."""

    def convex_radii(self, own: Tool) -> Iterator[float]:
        """Radius of the edges."""
        yield self.radius


class Section(Placeable):
    """Tool of one section all along."""

    origin: Vector = ORIGIN
    """Where the origin of the section lies."""
    x: Way = "x"
    """Direction across the tool."""
    y: Way = "z"
    """Direction upwards."""


class VDie(Section):
    """Die with a V; its top is the plane z = 0, its middle x = 0."""

    shape: Literal["VDie"]
    """The word VDie."""
    opening: Positive
    """Distance of the lines in which flanks and top meet."""
    angle: Angle
    """Angle between the flanks in degrees."""
    shoulder_radius: NotNegative
    """Radius between top and flanks."""
    bottom_radius: NotNegative = 0.0
    """Radius at the bottom."""
    depth: Positive | None = None
    """Depth of a flat bottom."""

    def convex_radii(self, own: Tool) -> Iterator[float]:
        """Radius of the shoulders."""
        yield self.shoulder_radius


class UDie(Section):
    """Die with a rectangular channel; its top is the plane z = 0, its middle x = 0."""

    shape: Literal["UDie"]
    """The word UDie."""
    opening: Positive
    """Distance of the walls."""
    depth: Positive
    """Depth of the bottom."""
    shoulder_radius: NotNegative
    """Radius between top and walls."""
    bottom_radius: NotNegative = 0.0
    """Radius between walls and bottom."""

    def convex_radii(self, own: Tool) -> Iterator[float]:
        """Radius of the shoulders."""
        yield self.shoulder_radius


class WipingDie(Section):
    """Block with one rounded edge: its top is the plane z = 0, its side the plane x = 0, the block at x < 0."""

    shape: Literal["WipingDie"]
    """The word WipingDie."""
    radius: NotNegative
    """Radius of the edge."""

    def convex_radii(self, own: Tool) -> Iterator[float]:
        """Radius of the edge."""
        yield self.radius


class Punch(Section):
    """Punch for air bending; its lowest line is z = 0, x = 0."""

    shape: Literal["Punch"]
    """The word Punch."""
    tip_radius: NotNegative
    """Radius of the tip."""
    angle: Angle
    """Angle between the flanks in degrees."""
    width: Positive | None = None
    """Width of the body above the flanks."""

    def convex_radii(self, own: Tool) -> Iterator[float]:
        """Radius of the tip."""
        yield self.tip_radius


class Profiled(Placeable):
    """A tool that is made of a profile."""

    profile: ProfilePart
    """Its section."""

    def convex_radii(self, own: Tool) -> Iterator[float]:
        """Radii of the arcs that turn to the left, and 0 if there is a sharp edge."""
        assert isinstance(own, surfaces.Extruded | surfaces.Revolved)
        segments, closed = own.profile.segments, own.profile.closed
        for i, segment in enumerate(segments):
            if isinstance(segment, surfaces.Arc) and not segment.clockwise:
                yield segment.radius
            if i + 1 < len(segments) or closed:
                one, other = segment.tangents()[1], segments[(i + 1) % len(segments)].tangents()[0]
                if one[0] * other[1] - one[1] * other[0] > _EDGE:
                    yield 0.0


class Extruded(Profiled):
    """A profile that is drawn out; by default its plane is the xz-plane and the tool goes along y."""

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
    """A profile that is turned about an axis: its first coordinate is the radius, its second that along the axis."""

    shape: Literal["Revolved"]
    """The word Revolved."""
    origin: Vector = ORIGIN
    """Where the origin of the profile lies."""
    axis: Way = "z"
    """Direction of the axis."""

    def _tool(self, folder: File) -> Tool:
        return surfaces.Revolved(profile_of(self.profile, folder), self.origin, self.axis)


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
    """The surface may have rims; beyond them nothing is touched."""
    scale: Positive = 1.0
    """Factor to the unit of the model: from millimetres for STEP and IGES, from what stands in an STL file."""

    def convex_radii(self, own: Tool) -> Iterator[float]:
        """One over the largest curvature."""
        assert isinstance(own, surfaces.CadTool | surfaces.Triangulated)
        if own.largest_curvature > 0.0:
            yield 1.0 / own.largest_curvature

    def _tool(self, folder: File) -> Tool:
        return surfaces.read_tool(
            folder / self.file, tolerance=self.tolerance, sharp=self.sharp, open=self.open, scale=self.scale
        )


ToolPart = Annotated[
    Plane | Cylinder | Sphere | Torus | Box | VDie | UDie | WipingDie | Punch | Extruded | Revolved | Drawing,
    Field(discriminator="shape"),
]


def smallest_radius(tool: ToolPart, built: Tool) -> float | None:
    """The smallest radius that a sheet may be bent around: 0 at an edge, None of a tool without any.

    That of a tool on the other side of another one is not known.
    """
    if tool.other_side:
        return None
    own: object = built
    while isinstance(own, surfaces.Placed | surfaces.Offset):
        own = own.tool
    assert isinstance(own, Tool)
    least = min(tool.convex_radii(own), default=None)
    return None if least is None else max(least + tool.offset, 0.0)


def along(tool: ToolPart) -> np.ndarray[Any, np.dtype[np.float64]] | None:
    """Direction that a tool of one section goes along, None of any other."""
    if isinstance(tool, Cylinder):
        axis = np.array(surfaces.unit_vector(tool.axis, "axis"))
    elif isinstance(tool, Section | Extruded):
        axis = np.cross(surfaces.unit_vector(tool.x, "x"), surfaces.unit_vector(tool.y, "y"))
    else:
        return None
    return np.asarray(rotation_matrix(np.radians(tool.rotation)) @ axis)

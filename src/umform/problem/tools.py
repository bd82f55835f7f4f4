"""The tools of a deck: all those of umform.surfaces, each with a pose."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field

from umform import surfaces
from umform.problem.drawn_tools import Drawing, Extruded, LedAround, Revolved
from umform.problem.parts import NotNegative, Positive, Vector, Way
from umform.problem.placeable import ORIGIN, Placeable
from umform.surfaces import Tool
from umform.surfaces.directions import rotation_matrix

Angle = Annotated[float, Field(gt=0, lt=180)]


class Plane(Placeable):
    """Half-space behind a plane."""

    shape: Literal["Plane"]
    """The word Plane."""
    point: Vector = ORIGIN
    """A point of the plane."""
    normal: Way = "z"
    """Normal out of the tool, towards the sheet."""


class Cylinder(Placeable):
    """Infinitely long round bar, or the space around a bore."""

    shape: Literal["Cylinder"]
    """The word Cylinder."""
    centre: Vector
    """A point of the axis."""
    axis: Way
    """Direction of the axis."""
    radius: Positive
    """Radius."""
    inside: bool = False
    """The sheet lies inside the bore."""

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
    """The sheet lies inside the bowl."""

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
    """Prismatic tool."""

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
    """Distance of the lines in which the extended flanks and the top meet."""
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


ToolPart = Annotated[
    Plane
    | Cylinder
    | Sphere
    | Torus
    | Box
    | VDie
    | UDie
    | WipingDie
    | Punch
    | Extruded
    | Revolved
    | LedAround
    | Drawing,
    Field(discriminator="shape"),
]


def smallest_radius(tool: ToolPart, built: Tool) -> float | None:
    """Smallest radius over which a sheet may bend: 0 at an edge, None for a tool without any.

    That of the counterpart of a tool is unknown.
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
    """Direction of extrusion of a prismatic tool, None for any other."""
    if isinstance(tool, Cylinder):
        axis = np.array(surfaces.unit_vector(tool.axis, "axis"))
    elif isinstance(tool, Section | Extruded):
        axis = np.cross(surfaces.unit_vector(tool.x, "x"), surfaces.unit_vector(tool.y, "y"))
    else:
        return None
    return np.asarray(rotation_matrix(np.radians(tool.rotation)) @ axis)

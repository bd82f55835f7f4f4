"""Plane, cylinder, sphere."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from umform import _core
from umform.spec.types import Positive
from umform.surfaces.directions import Direction, Point, point, unit_vector
from umform.surfaces.profile import Profile
from umform.surfaces.segments import Line
from umform.surfaces.swept import Extruded, Revolved
from umform.surfaces.tool import ToolSpec
from umform.surfaces.triangles import Floats, Triangles, across, rectangle


@dataclass(frozen=True)
class Plane(ToolSpec):
    """Half-space behind a plane.

    Examples
    --------
    >>> import umform as uf
    >>> floor = uf.Plane((0, 0, 0), (0, 0, 1))
    >>> float(floor.gap([(5.0, 2.0, 0.5)])[0][0])
    0.5
    """

    point: Point = (0.0, 0.0, 0.0)
    """A point of the plane."""
    normal: Direction = "z"
    """Normal out of the tool, towards the sheet."""

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""
        return _core.plane(point(self.point), unit_vector(self.normal))

    def facets(self, centre: Floats, reach: float, chord: float) -> Triangles:
        """Two triangles around the foot of ``centre``."""
        return rectangle(centre, reach, point(self.point), unit_vector(self.normal))

    def section(self) -> Extruded:
        """A line; it is extruded along y if the plane contains this direction."""
        n = unit_vector(self.normal)
        x = (n[2], 0.0, -n[0]) if n[1] == 0.0 else across(n)[0]
        return Extruded(Profile([Line((1.0, 0.0), (-1.0, 0.0))], closed=False), self.point, x, n)


@dataclass(frozen=True)
class Cylinder(ToolSpec):
    """Infinitely long round bar, or with ``inside`` the space around a bore.

    Examples
    --------
    >>> import umform as uf
    >>> bar = uf.Cylinder(centre=(0, 0, 0), axis="y", radius=20)
    >>> float(bar.gap([(0.0, 3.0, 20.5)])[0][0])
    0.5
    """

    centre: Point
    """A point of the axis."""
    axis: Direction
    """Direction of the axis."""
    radius: Positive
    """Radius."""
    inside: bool = False
    """The sheet lies inside the bore."""

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""
        return _core.cylinder(point(self.centre), unit_vector(self.axis), self.radius, self.inside)

    def section(self) -> Extruded:
        """A circle."""
        x, y = across(unit_vector(self.axis))
        return Extruded(Profile.circle((0.0, 0.0), self.radius, hole=self.inside), self.centre, x, y)

    def along(self) -> Point:
        """Its axis."""
        return unit_vector(self.axis)

    def convex_radii(self) -> Iterator[float]:
        """Radius of the bar."""
        if not self.inside:
            yield self.radius


@dataclass(frozen=True)
class Sphere(ToolSpec):
    """Ball, or with ``inside`` the space around a bowl.

    Examples
    --------
    >>> import umform as uf
    >>> ball = uf.Sphere((0, 0, 0), 5)
    >>> float(ball.gap([(0.0, 0.0, 4.5)])[0][0])
    -0.5
    """

    centre: Point
    """Centre."""
    radius: Positive
    """Radius."""
    inside: bool = False
    """The sheet lies inside the bowl."""

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""
        return _core.sphere(point(self.centre), self.radius, self.inside)

    def section(self) -> Revolved:
        """Half of a circle."""
        return Revolved(Profile.half_circle(self.radius, hole=self.inside), self.centre, "z")

    def convex_radii(self) -> Iterator[float]:
        """Radius of the ball."""
        if not self.inside:
            yield self.radius

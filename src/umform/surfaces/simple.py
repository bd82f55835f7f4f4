"""Plane, cylinder, sphere."""

from __future__ import annotations

from dataclasses import dataclass

from umform import _core
from umform.surfaces.directions import Direction, Point, point, positive, unit_vector
from umform.surfaces.profile import Profile
from umform.surfaces.swept import Extruded, Revolved
from umform.surfaces.tool import Tool
from umform.surfaces.triangles import Floats, Triangles, across, rectangle


@dataclass(frozen=True)
class Plane(Tool):
    """Half-space behind a plane.

    Parameters
    ----------
    point : tuple of float
        A point of the plane.
    normal : str or tuple of float
        Normal out of the tool, towards the sheet.

    Examples
    --------
    >>> import umform as uf
    >>> floor = uf.Plane((0, 0, 0), (0, 0, 1))
    >>> float(floor.gap([(5.0, 2.0, 0.5)])[0][0])
    0.5
    """

    point: Point = (0.0, 0.0, 0.0)
    normal: Direction = "z"

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""
        return _core.plane(point(self.point, "Plane.point"), unit_vector(self.normal, "Plane.normal"))

    def facets(self, centre: Floats, reach: float, chord: float) -> Triangles:
        """Two triangles around the foot of ``centre``."""
        return rectangle(centre, reach, point(self.point, "Plane.point"), unit_vector(self.normal, "Plane.normal"))


@dataclass(frozen=True)
class Cylinder(Tool):
    """Infinitely long round bar, or with ``inside`` the space around a bore.

    Parameters
    ----------
    centre : tuple of float
        A point of the axis.
    axis : str or tuple of float
        Direction of the axis.
    radius : float
        Radius.
    inside : bool
        The sheet lies inside the bore.

    Examples
    --------
    >>> import umform as uf
    >>> bar = uf.Cylinder(centre=(0, 0, 0), axis="y", radius=20)
    >>> float(bar.gap([(0.0, 3.0, 20.5)])[0][0])
    0.5
    """

    centre: Point
    axis: Direction
    radius: float
    inside: bool = False

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""
        return _core.cylinder(
            point(self.centre, "Cylinder.centre"),
            unit_vector(self.axis, "Cylinder.axis"),
            positive(self.radius, "Cylinder.radius"),
            self.inside,
        )

    def facets(self, centre: Floats, reach: float, chord: float) -> Triangles:
        """Strips along the axis."""
        x, y = across(unit_vector(self.axis, "Cylinder.axis"))
        circle = Profile.circle((0.0, 0.0), self.radius, hole=self.inside)
        return Extruded(circle, self.centre, x, y).facets(centre, reach, chord)


@dataclass(frozen=True)
class Sphere(Tool):
    """Ball, or with ``inside`` the space around a bowl.

    Parameters
    ----------
    centre : tuple of float
        Centre.
    radius : float
        Radius.
    inside : bool
        The sheet lies inside the sphere.

    Examples
    --------
    >>> import umform as uf
    >>> ball = uf.Sphere((0, 0, 0), 5)
    >>> float(ball.gap([(0.0, 0.0, 4.5)])[0][0])
    -0.5
    """

    centre: Point
    radius: float
    inside: bool = False

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""
        return _core.sphere(point(self.centre, "Sphere.centre"), positive(self.radius, "Sphere.radius"), self.inside)

    def facets(self, centre: Floats, reach: float, chord: float) -> Triangles:
        """Belts about the z direction."""
        half = Profile.half_circle(self.radius, hole=self.inside)
        return Revolved(half, self.centre, "z").facets(centre, reach, chord)

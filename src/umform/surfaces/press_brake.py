"""Tools of a press brake: dies, punch, wiping die, from their catalogue dimensions."""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass, field
from functools import cached_property

from umform import _core
from umform.errors import InvalidValue
from umform.surfaces.directions import Direction, Point, not_negative, positive
from umform.surfaces.profile import Profile
from umform.surfaces.segments import Point2
from umform.surfaces.swept import Extruded
from umform.surfaces.tool import Tool
from umform.surfaces.triangles import Floats, Triangles


@dataclass(frozen=True)
class Section(Tool):
    """Prismatic tool; by default the section lies in the xz-plane and the tool extends along y."""

    origin: Point = field(default=(0.0, 0.0, 0.0), kw_only=True)
    x: Direction = field(default="x", kw_only=True)
    y: Direction = field(default="z", kw_only=True)

    @property
    @abstractmethod
    def profile(self) -> Profile:
        """Section of the tool."""

    def extruded(self) -> Extruded:
        """The extruded section."""
        return Extruded(self.profile, self.origin, self.x, self.y)

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""
        return self.extruded().kernel()

    def facets(self, centre: Floats, reach: float, chord: float) -> Triangles:
        """Strips along the tool."""
        return self.extruded().facets(centre, reach, chord)


@dataclass(frozen=True)
class VDie(Section):
    r"""Die with a V; its top is the plane z = 0, its middle x = 0.

    Its section::

               |<--- opening --->|
        --------.       +       .--------  z = 0
                 \      |      /
                  \   angle   /            shoulders and bottom rounded
                   \         /
                    '-.___.-'              z = -depth (a flat bottom), or the point of the V

    Parameters
    ----------
    opening : float
        Distance of the two lines in which the extended flanks meet the top: the width of the V without rounded
        shoulders.
    angle : float
        Angle between the flanks in degrees.
    shoulder_radius : float
        Radius between top and flanks.
    bottom_radius : float
        Radius at the bottom of the V, or between flanks and a flat bottom; 0 leaves a sharp line.
    depth : float, optional
        Depth of a flat bottom; by default the flanks meet.
    origin : tuple of float
        Middle of the V at the height of the top.
    x, y : str or tuple of float
        Directions across the die and upwards.

    Examples
    --------
    >>> import umform as uf
    >>> die = uf.VDie(opening=16, angle=84, shoulder_radius=2)
    >>> float(die.gap([(30.0, 0.0, 0.5)])[0][0])
    0.5
    """

    opening: float
    angle: float
    shoulder_radius: float
    bottom_radius: float = 0.0
    depth: float | None = None

    @cached_property
    def profile(self) -> Profile:
        """Section, from right to left."""
        half = 0.5 * positive(self.opening, "VDie.opening", "opening")
        slope = math.tan(0.5 * _angle(self.angle, "VDie.angle"))
        if self.depth is None:
            bottom: list[Point2] = [(0.0, -half / slope)]
        else:
            left = half - slope * positive(self.depth, "VDie.depth", "depth")
            if left <= 1e-9 * half:
                raise InvalidValue(
                    "a flat bottom must lie above the point of the V",
                    where="VDie.depth",
                    value=self.depth,
                    cause=f"the flanks meet at a depth of {half / slope:.6g}",
                    remedy="a smaller depth, or none",
                )
            bottom = [(left, -self.depth), (-left, -self.depth)]
        return _die(half, bottom, self.shoulder_radius, self.bottom_radius, "VDie")

    @property
    def tangent_width(self) -> float:
        """Distance of the two lines in which the shoulders meet the top. eq. (4.24)"""
        turn = 0.5 * (math.pi - math.radians(self.angle))
        return self.opening + 2.0 * self.shoulder_radius * math.tan(0.5 * turn)


@dataclass(frozen=True)
class UDie(Section):
    """Die with a rectangular channel; its top is the plane z = 0, its middle x = 0.

    Parameters
    ----------
    opening : float
        Distance of the walls.
    depth : float
        Depth of the bottom.
    shoulder_radius : float
        Radius between top and walls.
    bottom_radius : float
        Radius between walls and bottom; half of the opening makes the bottom round.
    origin : tuple of float
        Middle of the channel at the height of the top.
    x, y : str or tuple of float
        Directions across the die and upwards.

    Examples
    --------
    >>> import umform as uf
    >>> die = uf.UDie(opening=8, depth=6, shoulder_radius=2, bottom_radius=1.5)
    >>> float(die.gap([(0.0, 0.0, -5.5)])[0][0])
    0.5
    """

    opening: float
    depth: float
    shoulder_radius: float
    bottom_radius: float = 0.0

    @cached_property
    def profile(self) -> Profile:
        """Section, from right to left."""
        half = 0.5 * positive(self.opening, "UDie.opening", "opening")
        depth = positive(self.depth, "UDie.depth", "depth")
        return _die(half, [(half, -depth), (-half, -depth)], self.shoulder_radius, self.bottom_radius, "UDie")


@dataclass(frozen=True)
class WipingDie(Section):
    """Block with one rounded edge: its top is the plane z = 0, its side the plane x = 0, the block at x < 0.

    Parameters
    ----------
    radius : float
        Radius of the edge.
    origin : tuple of float
        Where the extended top and side meet.
    x, y : str or tuple of float
        Directions out of the side and out of the top.

    Examples
    --------
    >>> import umform as uf
    >>> die = uf.WipingDie(radius=2)
    >>> float(die.gap([(-10.0, 0.0, 0.5)])[0][0])
    0.5
    """

    radius: float

    @cached_property
    def profile(self) -> Profile:
        """Section, up the side and along the top."""
        radius = not_negative(self.radius, "WipingDie.radius")
        far = 2.0 * radius or 1.0
        return Profile.from_corners([(0.0, -far), (0.0, 0.0), (-far, 0.0)], (0.0, radius, 0.0), closed=False)


@dataclass(frozen=True)
class Punch(Section):
    r"""Punch for air bending; its lowest line is z = 0, x = 0.

    Its section::

         |         |
         |<-width->|
          \       /
           \angle/
            '-.-'     tip radius; z = 0

    Parameters
    ----------
    tip_radius : float
        Radius of the tip; 0 makes an edge.
    angle : float
        Angle between the flanks in degrees.
    width : float, optional
        Width of the body above the flanks; by default the flanks extend to infinity.
    origin : tuple of float
        Lowest line of the tip.
    x, y : str or tuple of float
        Directions across the punch and upwards.

    Examples
    --------
    >>> import umform as uf
    >>> punch = uf.Punch(tip_radius=1.5, angle=84)
    >>> round(float(punch.gap([(0.0, 0.0, -0.5)])[0][0]), 6)
    0.5
    """

    tip_radius: float
    angle: float
    width: float | None = None

    @cached_property
    def profile(self) -> Profile:
        """Section, down the left side and up the right one."""
        half_angle = 0.5 * _angle(self.angle, "Punch.angle")
        radius = not_negative(self.tip_radius, "Punch.tip_radius")
        tip = radius - radius / math.sin(half_angle)
        tangent = radius * math.cos(half_angle)  # half of the width between the ends of the round tip
        if self.width is None:
            far = 2.0 * tangent or 1.0
            right: list[Point2] = [(far, tip + far / math.tan(half_angle))]
        else:
            half = 0.5 * positive(self.width, "Punch.width", "width")
            if half <= tangent:
                raise InvalidValue(
                    "the body of a punch must be wider than its round tip",
                    where="Punch.width",
                    value=self.width,
                    cause=f"the tip is round on a width of {2.0 * tangent:.6g}",
                    remedy="a wider body, or a smaller tip_radius",
                )
            edge = tip + half / math.tan(half_angle)
            right = [(half, edge), (half, edge + half)]
        left = [(-x, z) for x, z in reversed(right)]
        radii = [0.0] * len(left) + [radius] + [0.0] * len(right)
        return Profile.from_corners([*left, (0.0, tip), *right], radii, closed=False)


def _die(half: float, bottom: list[Point2], shoulder: float, radius: float, where: str) -> Profile:
    """Top, shoulders and bottom of a die, from right to left."""
    shoulder, radius = (
        not_negative(shoulder, f"{where}.shoulder_radius"),
        not_negative(radius, f"{where}.bottom_radius"),
    )
    far = 2.0 * (half + shoulder)
    corners = [(far, 0.0), (half, 0.0), *bottom, (-half, 0.0), (-far, 0.0)]
    return Profile.from_corners(corners, [0.0, shoulder, *[radius] * len(bottom), shoulder, 0.0], closed=False)


def _angle(degrees: float, where: str) -> float:
    """Angle in radians, between 0 and 180 degrees."""
    if not 0.0 < degrees < 180.0:
        raise InvalidValue(
            "the angle must lie between 0 and 180 degrees",
            where=where,
            value=degrees,
            cause="radians, or the angle of bending in place of that between the flanks",
            remedy="degrees between the flanks, 85 for instance",
        )
    return math.radians(degrees)

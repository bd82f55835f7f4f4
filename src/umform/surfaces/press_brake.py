"""Tools of a press brake: dies, punch, wiping die, from their catalogue dimensions."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property

from umform import _core
from umform.errors import InvalidValue
from umform.spec.types import Degrees, NotNegative, Positive
from umform.surfaces.directions import Direction, Point, Point2
from umform.surfaces.profile import Profile
from umform.surfaces.swept import Extruded
from umform.surfaces.tool import ToolSpec


@dataclass(frozen=True)
class Section(ToolSpec):
    """Prismatic tool; by default the section lies in the xz-plane and the tool extends along y."""

    origin: Point = field(default=(0.0, 0.0, 0.0), kw_only=True)
    """Where the origin of the section lies."""
    x: Direction = field(default="x", kw_only=True)
    """Direction across the tool."""
    y: Direction = field(default="z", kw_only=True)
    """Direction upwards."""

    @property
    @abstractmethod
    def profile(self) -> Profile:
        """Section of the tool."""

    def section(self) -> Extruded:
        """The extruded section."""
        return Extruded(self.profile, self.origin, self.x, self.y)

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""
        return self.section().kernel()

    def along(self) -> Point:
        """Direction in which it extends."""
        return self.section().along()


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

    Examples
    --------
    >>> import umform as uf
    >>> die = uf.VDie(opening=16, angle=84, shoulder_radius=2)
    >>> float(die.gap([(30.0, 0.0, 0.5)])[0][0])
    0.5
    """

    opening: Positive
    """Opening: distance of the lines in which the extended flanks meet the top, the width of the V without rounded
    shoulders."""
    angle: Degrees
    """Angle between the flanks."""
    shoulder_radius: NotNegative
    """Radius between top and flanks."""
    bottom_radius: NotNegative = 0.0
    """Radius at the bottom of the V, or between flanks and a flat bottom; 0 leaves a sharp line."""
    depth: Positive | None = None
    """Depth of a flat bottom; by default the flanks meet."""

    @cached_property
    def profile(self) -> Profile:
        """Section, from right to left."""
        half = 0.5 * self.opening
        slope = math.tan(0.5 * math.radians(self.angle))
        if self.depth is None:
            bottom: list[Point2] = [(0.0, -half / slope)]
        else:
            left = half - slope * self.depth
            if left <= 1e-9 * half:
                raise InvalidValue(
                    "a flat bottom must lie above the point of the V",
                    where="depth",
                    value=self.depth,
                    cause=f"the flanks meet at a depth of {half / slope:.6g}",
                    remedy="a smaller depth, or none",
                )
            bottom = [(left, -self.depth), (-left, -self.depth)]
        return _die(half, bottom, self.shoulder_radius, self.bottom_radius)

    @property
    def tangent_width(self) -> float:
        """Distance of the two lines in which the shoulders meet the top. eq. (4.24)"""
        turn = 0.5 * (math.pi - math.radians(self.angle))
        return self.opening + 2.0 * self.shoulder_radius * math.tan(0.5 * turn)

    def convex_radii(self) -> Iterator[float]:
        """Radius of the shoulders."""
        yield self.shoulder_radius


@dataclass(frozen=True)
class UDie(Section):
    """Die with a rectangular channel; its top is the plane z = 0, its middle x = 0.

    Examples
    --------
    >>> import umform as uf
    >>> die = uf.UDie(opening=8, depth=6, shoulder_radius=2, bottom_radius=1.5)
    >>> float(die.gap([(0.0, 0.0, -5.5)])[0][0])
    0.5
    """

    opening: Positive
    """Opening: distance of the walls."""
    depth: Positive
    """Depth of the bottom."""
    shoulder_radius: NotNegative
    """Radius between top and walls."""
    bottom_radius: NotNegative = 0.0
    """Radius between walls and bottom; half of the opening makes the bottom round."""

    @cached_property
    def profile(self) -> Profile:
        """Section, from right to left."""
        half = 0.5 * self.opening
        bottom: list[Point2] = [(half, -self.depth), (-half, -self.depth)]
        return _die(half, bottom, self.shoulder_radius, self.bottom_radius)

    def convex_radii(self) -> Iterator[float]:
        """Radius of the shoulders."""
        yield self.shoulder_radius


@dataclass(frozen=True)
class WipingDie(Section):
    """Block with one rounded edge: its top is the plane z = 0, its side the plane x = 0, the block at x < 0.

    Examples
    --------
    >>> import umform as uf
    >>> die = uf.WipingDie(radius=2)
    >>> float(die.gap([(-10.0, 0.0, 0.5)])[0][0])
    0.5
    """

    radius: NotNegative
    """Radius of the edge."""

    @cached_property
    def profile(self) -> Profile:
        """Section, up the side and along the top."""
        far = 2.0 * self.radius or 1.0
        return Profile.from_corners([(0.0, -far), (0.0, 0.0), (-far, 0.0)], (0.0, self.radius, 0.0), closed=False)

    def convex_radii(self) -> Iterator[float]:
        """Radius of the edge."""
        yield self.radius


@dataclass(frozen=True)
class Punch(Section):
    r"""Punch for air bending; its lowest line is z = 0, x = 0.

    Its section::

         |         |
         |<-width->|
          \       /
           \angle/
            '-.-'     tip radius; z = 0

    Examples
    --------
    >>> import umform as uf
    >>> punch = uf.Punch(tip_radius=1.5, angle=84)
    >>> round(float(punch.gap([(0.0, 0.0, -0.5)])[0][0]), 6)
    0.5
    """

    tip_radius: NotNegative
    """Radius of the tip; 0 makes an edge."""
    angle: Degrees
    """Angle between the flanks."""
    width: Positive | None = None
    """Width of the body above the flanks; by default the flanks extend to infinity."""

    @cached_property
    def profile(self) -> Profile:
        """Section, down the left side and up the right one."""
        half_angle, radius = 0.5 * math.radians(self.angle), self.tip_radius
        tip = radius - radius / math.sin(half_angle)
        tangent = radius * math.cos(half_angle)  # half of the width between the ends of the round tip
        if self.width is None:
            far = 2.0 * tangent or 1.0
            right: list[Point2] = [(far, tip + far / math.tan(half_angle))]
        else:
            half = 0.5 * self.width
            if half <= tangent:
                raise InvalidValue(
                    "the body of a punch must be wider than its round tip",
                    where="width",
                    value=self.width,
                    cause=f"the tip is round on a width of {2.0 * tangent:.6g}",
                    remedy="a wider body, or a smaller tip_radius",
                )
            edge = tip + half / math.tan(half_angle)
            right = [(half, edge), (half, edge + half)]
        left = [(-x, z) for x, z in reversed(right)]
        radii = [0.0] * len(left) + [radius] + [0.0] * len(right)
        return Profile.from_corners([*left, (0.0, tip), *right], radii, closed=False)

    def convex_radii(self) -> Iterator[float]:
        """Radius of the tip."""
        yield self.tip_radius


def _die(half: float, bottom: list[Point2], shoulder: float, radius: float) -> Profile:
    """Top, shoulders and bottom of a die, from right to left."""
    far = 2.0 * (half + shoulder)
    corners = [(far, 0.0), (half, 0.0), *bottom, (-half, 0.0), (-far, 0.0)]
    return Profile.from_corners(corners, [0.0, shoulder, *[radius] * len(bottom), shoulder, 0.0], closed=False)

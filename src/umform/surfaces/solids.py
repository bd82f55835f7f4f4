"""Torus and rounded box."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from umform import _core
from umform.errors import InvalidValue
from umform.spec.types import NotNegative, Positive
from umform.surfaces.directions import Direction, Point, Size, point, right_angle
from umform.surfaces.profile import Profile
from umform.surfaces.swept import Extruded, Revolved
from umform.surfaces.tool import ToolSpec
from umform.surfaces.triangles import Floats, Triangles, grid


@dataclass(frozen=True)
class Torus(ToolSpec):
    """Ring of round section.

    Examples
    --------
    >>> import umform as uf
    >>> ring = uf.Torus((0, 0, 0), "z", major=10, minor=2)
    >>> float(ring.gap([(10.0, 0.0, 2.5)])[0][0])
    0.5
    """

    centre: Point
    """Centre of the ring."""
    axis: Direction
    """Direction across the ring."""
    major: Positive
    """Radius of the ring: of the circle on which the section has its centre."""
    minor: Positive
    """Radius of the section, less than ``major``."""

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.minor < self.major:
            raise InvalidValue(
                "a ring must have a hole",
                where="minor",
                value=f"minor {self.minor}, major {self.major}",
                cause="minor and major radius exchanged",
                remedy="minor < major; for a solid disc with a round edge turn a profile of your own",
            )

    def section(self) -> Revolved:
        """The circle that is revolved."""
        return Revolved(Profile.circle((self.major, 0.0), self.minor), self.centre, self.axis)

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""
        return self.section().kernel()

    def convex_radii(self) -> Iterator[float]:
        """Radius of the section."""
        yield self.minor


@dataclass(frozen=True)
class Box(ToolSpec):
    """Box with rounded edges and corners. eq. (4.27)

    Examples
    --------
    >>> import umform as uf
    >>> block = uf.Box((0, 0, 0), (9, 6, 7), 1.2)
    >>> round(float(block.gap([(0.0, 0.0, 4.5)])[0][0]), 6)
    1.0
    """

    centre: Point
    """Centre."""
    size: Size
    """Length along its three directions, over all."""
    radius: NotNegative = 0.0
    """Radius of edges and corners, at most half of the smallest length; 0 leaves them sharp."""
    x: Direction = "x"
    """First direction."""
    y: Direction = "y"
    """Second direction, at right angles."""

    def __post_init__(self) -> None:
        super().__post_init__()
        right_angle(self.x, self.y)
        half = 0.5 * min(self.size)
        if self.radius > half * (1.0 + 1e-12):
            raise InvalidValue(
                "the radius of a box must be at most half of its smallest length",
                where="radius",
                value=f"{self.radius}, half of the length {half}",
                cause="the box is thinner than its roundings",
                remedy="a smaller radius, or a larger box",
            )

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""
        axes, core = self._frame()
        return _core.rounded_box(point(self.centre), axes, [float(c) for c in core], float(self.radius))

    def facets(self, centre: Floats, reach: float, chord: float) -> Triangles:
        """Octants of a sphere, moved apart; edges and faces fill the gaps."""
        axes, core = self._frame()
        step = 2.0 * math.acos(max(1.0 - 0.5 * chord / self.radius, 0.5)) if self.radius else math.pi
        parts = math.ceil(0.5 * math.pi / step)
        quarter = np.linspace(0.0, 0.5 * math.pi, parts + 1)
        polar = np.concatenate([quarter - 0.5 * math.pi, quarter])  # -90 degrees at the lower, 90 at the upper face
        height = np.repeat([-1.0, 1.0], parts + 1)
        around = np.concatenate([quarter + 0.5 * math.pi * k for k in range(4)] + [np.zeros(1)])
        sides = np.repeat([[1, 1], [-1, 1], [-1, -1], [1, -1], [1, 1]], [parts + 1] * 4 + [1], axis=0)
        direction = np.empty((len(polar), len(around), 3))
        direction[:, :, 0] = np.cos(polar)[:, None] * np.cos(around)
        direction[:, :, 1] = np.cos(polar)[:, None] * np.sin(around)
        direction[:, :, 2] = np.sin(polar)[:, None]
        offset = np.empty_like(direction)
        offset[:, :, :2] = core[:2] * sides
        offset[:, :, 2] = core[2] * height[:, None]
        belts = offset + self.radius * direction
        middle = np.broadcast_to([0.0, 0.0, 1.0], (1, len(around), 3)) * (core[2] + self.radius)
        return grid(np.array(self.centre) + np.concatenate([-middle, belts, middle]) @ axes)

    def section(self) -> Extruded:
        """The rounded rectangle in its middle, seen along its second direction: the box itself ends there."""
        x, y = right_angle(self.x, self.y)
        a, _, c = (0.5 * length for length in self.size)
        corners = [(-a, -c), (a, -c), (a, c), (-a, c)]
        return Extruded(Profile.from_corners(corners, self.radius), self.centre, x, tuple(np.cross(x, y).tolist()))

    def convex_radii(self) -> Iterator[float]:
        """Radius of the edges."""
        yield self.radius

    def _frame(self) -> tuple[Floats, Floats]:
        """Rows of its directions, and half-lengths of the box without the roundings."""
        x, y = right_angle(self.x, self.y)
        half = 0.5 * np.array(self.size, dtype=float)
        return np.array([x, y, np.cross(x, y)]), np.maximum(half - self.radius, 0.0)

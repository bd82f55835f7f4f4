"""A profile swept around a rectangle with rounded corners: punch and die of a square cup."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from umform import _core
from umform.errors import InvalidValue
from umform.spec.types import Positive
from umform.surfaces.crossings import refuse_crossings
from umform.surfaces.directions import Direction, Point, Size2, point, right_angle
from umform.surfaces.profile import Profile
from umform.surfaces.segments import Arc, Line
from umform.surfaces.swept import Profiled, refuse_endless_arcs


@dataclass(frozen=True)
class LedAround(Profiled):
    """A profile swept around a rectangle with rounded corners. eqs. (4.26), (4.27)

    Examples
    --------
    >>> import umform as uf
    >>> section = uf.Profile.from_corners([(-9, 0), (0, 0), (0, 50)], radii=[0, 8, 0], closed=False)
    >>> punch = uf.LedAround(section, size=(70, 70), corner=10)
    >>> float(punch.gap([(36.0, 3.0, 20.0)])[0][0])
    1.0
    """

    profile: Profile
    """Section: x is the distance outwards from the outline of the rectangle, y is normal to its plane. It is open,
    begins and ends with a line that extends to infinity, and is flat where it lies deeper inside the rectangle than the
    corner radius."""
    size: Size2
    """Sides of the rectangle."""
    corner: Positive
    """Radius of its corners."""
    origin: Point = (0.0, 0.0, 0.0)
    """Centre of the rectangle, at the origin of the profile."""
    x: Direction = "x"
    """First side."""
    y: Direction = "y"
    """Second side, at right angles; the second coordinate of the profile lies along x cross y."""

    def __post_init__(self) -> None:
        super().__post_init__()
        right_angle(self.x, self.y)
        half = 0.5 * min(self.size)
        if self.corner > half * (1.0 + 1e-12):
            raise InvalidValue(
                "the radius of the corners must be at most half of the shorter side",
                where="corner",
                value=f"{self.corner}, half of the side {half}",
                cause="a diameter for a radius, or half of the sides in place of the sides",
                remedy="a smaller radius, or a larger rectangle",
            )

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""
        x, y = right_angle(self.x, self.y)
        half = 0.5 * np.array(self.size, dtype=float)
        self._refuse_profile()
        rows = np.array([segment.row() for segment in self.profile.segments])
        core = np.maximum(half - self.corner, 0.0)
        axes = np.array([x, y, np.cross(x, y)])
        return _core.led_around(rows, point(self.origin), axes, core.tolist(), float(self.corner))

    def _refuse_profile(self) -> None:
        """Open, its ends infinite lines, and flat further inside than the centres of the corners."""
        if self.profile.closed:
            raise InvalidValue(
                "a profile that is led around a rectangle must be open",
                where="LedAround.profile",
                cause="the section of a whole body in place of the line that goes around",
                remedy="closed=False; its first and last line extend to infinity",
            )
        segments = self.profile.segments
        refuse_endless_arcs(segments[0], segments[-1], "LedAround")
        refuse_crossings(segments, False, (True, True), "LedAround")
        least = -self.corner - 1e-9 * self.profile.size
        outwards = -segments[0].tangents()[0][0], segments[-1].tangents()[1][0]
        for i, segment in enumerate(segments):
            deepest = _deepest(segment)
            endless = (i == 0 and outwards[0] < 0.0) or (i == len(segments) - 1 and outwards[1] < 0.0)
            flat = isinstance(segment, Line) and segment.start[1] == segment.end[1]
            if not flat and (endless or deepest < least):
                raise InvalidValue(
                    "the profile must be flat where it is deeper inside of the rectangle than its corners are round",
                    where=f"segment {i} of LedAround.profile",
                    value=f"x = {deepest:.6g}, corners of radius {self.corner:g}",
                    cause="there the tool would have an edge along the diagonals",
                    remedy="a larger radius of the corners, or smaller ones of the profile",
                )


def _deepest(segment: Line | Arc) -> float:
    """Smallest x of a segment; an arc may bulge beyond its ends."""
    ends = min(segment.start[0], segment.end[0])
    if isinstance(segment, Line):
        return ends
    start = math.atan2(segment.start[1] - segment.centre[1], segment.start[0] - segment.centre[0])
    passes = (segment.turn * (math.pi - start)) % (2.0 * math.pi) < segment.angle
    return segment.centre[0] - segment.radius if passes else ends

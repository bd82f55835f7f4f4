"""Rounded corners of a drawn section: an arc between two straight lines, wherever it lies."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from umform.surfaces.directions import Point2
from umform.surfaces.profile import Profile
from umform.surfaces.segments import Arc, Line, Segment

#: Degrees by which an arc and its line may miss being tangent, and by which a top may be tilted.
_BENT, _TILTED = 1.0, 0.05


@dataclass(frozen=True)
class Corner:
    """A convex arc between two lines that are tangent to it; the solid is on the left of the walk."""

    before: Line
    arc: Arc
    after: Line

    @property
    def bottom(self) -> float:
        """Height of the lowest place of the circle."""
        return self.arc.centre[1] - self.arc.radius

    @property
    def is_lowest(self) -> bool:
        """Whether the walk comes down before the arc and goes up after it: the tip of a punch."""
        return _direction(self.before)[1] < 0.0 < _direction(self.after)[1]

    @property
    def from_vertical(self) -> tuple[float, float]:
        """Degrees of both lines from the vertical."""
        return _steepness(self.before), _steepness(self.after)

    @property
    def goes_down(self) -> bool:
        """Whether the flank is the second line: the right shoulder of a die."""
        return abs(_direction(self.after)[1]) > abs(_direction(self.before)[1])

    @property
    def flank(self) -> Line:
        """The line that is not level."""
        return self.after if self.goes_down else self.before

    @property
    def level(self) -> Line:
        """The other line, the top of a shoulder."""
        return self.before if self.goes_down else self.after

    @property
    def steepness(self) -> float:
        """Degrees of the flank from the vertical."""
        return _steepness(self.flank)

    def is_shoulder(self, top: float) -> bool:
        """Whether it lies between a level line at a height and a flank below it."""
        dx, dz = _direction(self.level)
        near = abs(0.5 * (self.level.start[1] + self.level.end[1]) - top) <= 1e-3 * self.arc.radius + 1e-9
        return near and dx < 0.0 and abs(math.degrees(dz)) <= _TILTED and abs(_direction(self.flank)[1]) > 0.05

    def meeting(self, height: float) -> float:
        """Where the flank, drawn on, is at a height."""
        (x, z), (dx, dz) = self.flank.start, _direction(self.flank)
        return x + (height - z) * dx / dz


def corners_of(segments: list[Segment], closed: bool) -> list[Corner]:
    """All convex arcs between two lines that are tangent to them."""
    count, found = len(segments), []
    for i in range(count) if closed else range(1, count - 1):
        before, arc, after = segments[i - 1], segments[i], segments[(i + 1) % count]
        if isinstance(before, Line) and isinstance(after, Line) and isinstance(arc, Arc) and not arc.clockwise:
            first, last = arc.tangents()
            smooth = math.cos(math.radians(_BENT))
            if before.tangents()[1] @ first >= smooth and last @ after.tangents()[0] >= smooth:
                found.append(Corner(before, arc, after))
    return found


def merged(profile: Profile) -> list[Segment]:
    """Lines and arcs of a section; pieces of one line or circle, as a mirrored half has them, are joined."""
    near = 1e-4 * profile.size
    found: list[Segment] = []
    for segment in profile.segments:
        joined = _joined(found[-1], segment, near) if found else None
        if joined is None:
            found.append(segment)
        else:
            found[-1] = joined
    if profile.closed and len(found) > 1:
        joined = _joined(found[-1], found[0], near)
        if joined is not None:
            found = [joined, *found[1:-1]]
    return found


def moved(profile: Profile, by: Point2) -> Profile:
    """The section at another place."""
    return Profile([segment.shifted(by) for segment in profile.segments], profile.closed)


def levelled(profile: Profile) -> Profile:
    """The section with ends at the height zero that were there but for round-off: a sheet lies on them."""
    near = 1e-9 * profile.size

    def at(p: Point2) -> Point2:
        return (p[0], 0.0) if abs(p[1]) <= near else p

    segments = [replace(segment, start=at(segment.start), end=at(segment.end)) for segment in profile.segments]
    return Profile(segments, profile.closed)


def _joined(one: Segment, other: Segment, near: float) -> Segment | None:
    """Two segments as one, if they are parts of one line or circle."""
    if isinstance(one, Line) and isinstance(other, Line):
        straight = float(one.tangents()[1] @ other.tangents()[0]) > 1.0 - 1e-9
        return Line(one.start, other.end) if straight else None
    if isinstance(one, Arc) and isinstance(other, Arc) and one.clockwise == other.clockwise:
        same = math.dist(one.centre, other.centre) <= near and abs(one.radius - other.radius) <= near
        if same and one.angle + other.angle < 2.0 * math.pi - 1e-6:
            centre = np.mean([one.centre, other.centre], axis=0)
            return Arc(one.start, other.end, (float(centre[0]), float(centre[1])), one.clockwise)
    return None


def _direction(line: Line) -> tuple[float, float]:
    t = line.tangents()[0]
    return float(t[0]), float(t[1])


def _steepness(line: Line) -> float:
    dx, dz = _direction(line)
    return math.degrees(math.atan2(abs(dx), abs(dz)))

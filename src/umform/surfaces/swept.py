"""Tools from profiles: extruded along an axis, or revolved about one."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from umform import _core
from umform.errors import InvalidValue
from umform.mesh import graded
from umform.surfaces.block import refuse_other
from umform.surfaces.crossings import refuse_crossings
from umform.surfaces.directions import Direction, Point, Point2, point, right_angle, unit_vector
from umform.surfaces.profile import Profile
from umform.surfaces.segments import Arc, Line, Segment
from umform.surfaces.tool import Swept, ToolSpec
from umform.surfaces.triangles import Floats, Triangles, across, grid

JOINED, ENDLESS, ON_AXIS = _core.ProfileEnd.joined, _core.ProfileEnd.endless, _core.ProfileEnd.on_axis


@dataclass(frozen=True)
class Profiled(ToolSpec):
    """A tool with a section."""

    profile: Profile
    """Section."""

    def convex_radii(self) -> Iterator[float]:
        """Radii of convex arcs, and 0 if there is a sharp edge."""
        return self.profile.convex_radii()


@dataclass(frozen=True)
class Extruded(Profiled, Swept):
    """A profile extruded to infinity normal to its plane. eq. (4.25)

    Examples
    --------
    >>> import umform as uf
    >>> section = uf.Profile.from_corners([(0, 0), (20, 0), (20, 10), (0, 10)], [1, 1, 2, 2])
    >>> rail = uf.Extruded(section, origin=(-10, 0, -10))
    >>> float(rail.gap([(0.0, 7.0, 0.5)])[0][0])
    0.5
    """

    profile: Profile
    """Section; an open one must begin and end with a line."""
    origin: Point = (0.0, 0.0, 0.0)
    """Where the origin of the profile lies."""
    x: Direction = "x"
    """First direction of the profile."""
    y: Direction = "z"
    """Second direction of the profile, at right angles."""

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""
        segments = self.profile.segments
        end = JOINED if self.profile.closed else ENDLESS
        if not self.profile.closed:
            refuse_endless_arcs(segments[0], segments[-1], "Extruded")
            refuse_crossings(segments, False, (True, True), "Extruded")
        x, y = right_angle(self.x, self.y)
        rows = np.array([segment.row() for segment in segments])
        return _core.extruded(rows, end, end, point(self.origin), x, y)

    def facets(self, centre: Floats, reach: float, chord: float) -> Triangles:
        """Strips along the tool."""
        x, y = (np.array(v) for v in right_angle(self.x, self.y))
        along = np.cross(y, x)
        d = centre - point(self.origin)
        far = 2.0 * (self.profile.size + float(np.linalg.norm(d)) + reach)
        curve = self.profile.points(chord, far)
        section = self.origin + curve[:, :1] * x + curve[:, 1:] * y
        ends = np.array([d @ along - reach, d @ along + reach])
        return grid(section[:, None, :] + ends[None, :, None] * along)

    def section(self) -> Extruded:
        """Itself."""
        return self

    def placed(self, Q: Floats, c: Floats) -> Extruded:
        """The same whose points X lie at Q X + c, with an orthogonal matrix Q."""
        x, y = (_triple(Q @ v) for v in right_angle(self.x, self.y))
        return replace(self, origin=_triple(Q @ point(self.origin) + c), x=x, y=y)

    def along(self) -> Point:
        """Direction of the extrusion."""
        x, y = right_angle(self.x, self.y)
        return _triple(np.cross(x, y))

    @property
    def right_handed(self) -> bool:
        """Whether the extrusion points towards positive coordinates."""
        return max(self.along(), key=abs) > 0.0

    def third(self, width: float | None, sector: float | None, elements: int) -> Floats:
        """Borders of elements over a width."""
        refuse_other("sector", sector, "an extruded", "width")
        return graded(1.0 if width is None else width, elements)

    def in_space(self, plane: Floats, third: Floats) -> Floats:
        """Points of the section at distances from its plane, towards positive coordinates."""
        axes = np.array([*right_angle(self.x, self.y), self.along()])
        axes[2] *= 1.0 if self.right_handed else -1.0
        return np.asarray(self.origin + np.column_stack([plane, third]) @ axes)


@dataclass(frozen=True)
class Revolved(Profiled, Swept):
    """A profile revolved about an axis: its x is the distance to the axis, its y lies along the axis. eq. (4.26)

    Examples
    --------
    >>> import umform as uf
    >>> meridian = uf.Profile.from_corners([(0, -10), (10, -10), (10, 0), (0, 0)], [0, 2, 2, 0], closed=True)
    >>> punch = uf.Revolved(meridian)
    >>> float(punch.gap([(3.0, 4.0, 0.5)])[0][0])
    0.5
    """

    profile: Profile
    """Meridian, at x >= 0. An open one may begin or end on the axis x = 0; elsewhere it begins and ends with a line
    that extends to infinity. A closed one may have one line on the axis, which is no surface."""
    origin: Point = (0.0, 0.0, 0.0)
    """Where the origin of the profile lies."""
    axis: Direction = "z"
    """Direction of the axis."""

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""
        meridian, start, end = self.meridian()
        rows = np.array([segment.row() for segment in meridian.segments])
        return _core.revolved(rows, start, end, point(self.origin), unit_vector(self.axis))

    def facets(self, centre: Floats, reach: float, chord: float) -> Triangles:
        """Belts around the axis."""
        axis = np.array(unit_vector(self.axis))
        d = centre - point(self.origin)
        meridian, start, end = self.meridian()
        beyond = 2.0 * (meridian.size + float(np.linalg.norm(d)) + reach)
        curve = meridian.points(0.5 * chord)
        first, last = meridian.segments[0].tangents()[0], meridian.segments[-1].tangents()[1]
        curve[0] -= beyond * first if start == ENDLESS else 0.0
        curve[-1] += beyond * last if end == ENDLESS else 0.0
        widest = min(float(curve[:, 0].max()), float(np.linalg.norm(d)) + reach)
        step = 2.0 * math.acos(max(1.0 - 0.5 * chord / widest, 0.5))
        angles = np.linspace(0.0, 2.0 * math.pi, math.ceil(2.0 * math.pi / step) + 1)
        x, y = (np.array(v) for v in across(unit_vector(self.axis)))
        ring = np.cos(angles)[:, None] * x + np.sin(angles)[:, None] * y
        return grid(np.array(self.origin) + curve[:, None, :1] * ring + curve[:, None, 1:] * axis)

    def section(self) -> Revolved:
        """Itself."""
        return self

    def placed(self, Q: Floats, c: Floats) -> Revolved:
        """The same whose points X lie at Q X + c, with an orthogonal matrix Q."""
        return replace(
            self, origin=_triple(Q @ point(self.origin) + c), axis=_triple(Q @ np.array(unit_vector(self.axis)))
        )

    @property
    def right_handed(self) -> bool:
        """Radius, axis and the direction of growing angles are a left-handed frame."""
        return False

    def third(self, width: float | None, sector: float | None, elements: int) -> Floats:
        """Borders of elements over a sector, in radians."""
        refuse_other("width", width, "a revolved", "sector")
        return graded(math.radians(90.0 if sector is None else sector), elements)

    def in_space(self, plane: Floats, third: Floats) -> Floats:
        """Points of the meridian turned by angles from the plane of x and the axis; of the axis x, from any plane."""
        axis = np.array(unit_vector(self.axis))
        x = np.cross(axis, np.cross((1.0, 0.0, 0.0), axis))
        x = x / np.linalg.norm(x) if x.any() else np.array(across(unit_vector(self.axis))[0])
        out = np.cos(third)[:, None] * x + np.sin(third)[:, None] * np.cross(axis, x)
        return np.asarray(self.origin + plane[:, :1] * out + plane[:, 1:] * axis)

    def meridian(self) -> tuple[Profile, _core.ProfileEnd, _core.ProfileEnd]:
        """The segments that are surfaces, and the type of both ends."""
        near = 1e-12 * self.profile.size
        segments = [_snapped(segment, near) for segment in self.profile.segments]
        for i, segment in enumerate(segments):
            _refuse_beyond_axis(segment, near, f"segment {i} of Revolved.profile")
        on_axis = [i for i, s in enumerate(segments) if isinstance(s, Line) and s.start[0] == s.end[0] == 0.0]
        if len(on_axis) > self.profile.closed:
            raise InvalidValue(
                "a line on the axis of revolution is no surface: none in an open profile, one at most in a closed one",
                where="Revolved.profile",
                value=f"segments {on_axis}",
                cause="a part of the outline that the turning makes a line in space",
                remedy="omit it: an open profile may end on the axis",
            )
        if not self.profile.closed:
            return self._open_meridian(segments)
        if not on_axis:
            return Profile(segments), JOINED, JOINED
        k = on_axis[0]
        return Profile(segments[k + 1 :] + segments[:k], closed=False), ON_AXIS, ON_AXIS

    def _open_meridian(self, segments: list[Segment]) -> tuple[Profile, _core.ProfileEnd, _core.ProfileEnd]:
        """Check that each end is on the axis, or a line to infinity away from it."""
        start = ON_AXIS if segments[0].start[0] == 0.0 else ENDLESS
        end = ON_AXIS if segments[-1].end[0] == 0.0 else ENDLESS
        outwards = -segments[0].tangents()[0][0], segments[-1].tangents()[1][0]
        for kind, i, slope in ((start, 0, outwards[0]), (end, -1, outwards[1])):
            if kind == ENDLESS:
                refuse_endless_arcs(segments[i], segments[i], "Revolved")
                if slope < 0.0:
                    raise InvalidValue(
                        "an open end of a profile must not run through the axis of revolution",
                        where=f"{'first' if i == 0 else 'last'} segment of Revolved.profile",
                        cause="the end goes on beyond the axis, and would enter the solid again",
                        remedy="let it end on the axis, at x = 0",
                    )
        refuse_crossings(segments, False, (start == ENDLESS, end == ENDLESS), "Revolved")
        return Profile(segments, closed=False), start, end


def _triple(v: Floats) -> Point:
    a, b, c = (float(part) for part in v)
    return a, b, c


def refuse_endless_arcs(first: Segment, last: Segment, where: str) -> None:
    """Refuse an open profile that does not begin and end with a line."""
    for name, segment in (("first", first), ("last", last)):
        if not isinstance(segment, Line):
            raise InvalidValue(
                "an open profile must begin and end with a line, that goes on for ever",
                where=f"{name} segment of {where}.profile",
                value=segment,
                cause="an arc at an end, which would stop in space",
                remedy="add a line, or close the profile",
            )


def _snapped(segment: Segment, near: float) -> Segment:
    """Move ends and centre exactly onto the axis if they are there up to round-off."""

    def snap(at: Point2) -> Point2:
        return (0.0, at[1]) if abs(at[0]) <= near else at

    if isinstance(segment, Line):
        return Line(snap(segment.start), snap(segment.end))
    return replace(segment, start=snap(segment.start), end=snap(segment.end), centre=snap(segment.centre))


def _refuse_beyond_axis(segment: Segment, near: float, where: str) -> None:
    """Reject points at x < 0, including the leftmost one of an arc."""
    least = min(segment.start[0], segment.end[0])
    if isinstance(segment, Arc) and -segment.middle[0] >= math.cos(0.5 * segment.angle):
        least = min(least, segment.centre[0] - segment.radius)
    if least < -near:
        raise InvalidValue(
            "a profile must stay on one side of the axis of revolution, x >= 0",
            where=where,
            value=f"x = {least:.6g}",
            cause="the first coordinate is not the distance from the axis",
            remedy="an open profile may end on the axis",
        )

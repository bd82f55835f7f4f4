"""Punch and die of a press brake from their drawn sections: put in place, with radii, angles and opening measured."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from umform.errors import InvalidValue, OpenSection
from umform.processes.air_bending.outline import corners_of, levelled, merged, moved
from umform.surfaces.profile import Profile
from umform.surfaces.segments import Segment
from umform.surfaces.swept import Extruded

#: Degrees by which two flanks may differ, and part of the opening by which shoulders may lie at other heights.
_ASKEW, _UNEVEN = 0.05, 1e-4
#: Most lines and arcs: as many as a deck may have.
_MOST = 1000
#: Ends of a drawing in mm that are one point.
_APART = 0.01


@dataclass(frozen=True)
class DrawnPunch:
    """A punch with its lowest line at the origin.

    Attributes
    ----------
    profile : Profile
        The section.
    angle, radius : float
        Angle between the flanks in degrees, radius of the tip in mm.
    """

    profile: Profile
    angle: float
    radius: float

    @property
    def words(self) -> str:
        """Description in a few words."""
        return f"drawn, {len(self.profile.segments)} lines and arcs"

    @classmethod
    def of(cls, profile: Profile, where: str = "punch") -> DrawnPunch:
        """The punch of a section, wherever it was drawn.

        Raises
        ------
        OpenSection
            If it has no round tip between two straight flanks of the same slope.
        """
        segments = _few(profile, where)
        tips = [corner for corner in corners_of(segments, profile.closed) if corner.is_lowest]
        lowest = min(float(segment.points(_chord(profile))[:, 1].min()) for segment in segments)
        tips = [tip for tip in tips if tip.bottom <= lowest + 1e-6 * profile.size]
        if not tips:
            raise OpenSection(
                "the lowest place of the punch is no round tip between two straight flanks",
                where=where,
                value=f"its lowest place is at y = {lowest:.6g}",
                cause="drawn upside down, a sharp or a flat tip, or the die in place of the punch",
                remedy="draw the punch with its tip downwards: an arc, and straight flanks tangent to it",
            )
        tip = tips[0]
        left, right = tip.from_vertical
        _level(where, "the flanks of the punch", left, right, _ASKEW, "degrees from the vertical")
        x, y = tip.arc.centre
        return cls(moved(profile, (-x, tip.arc.radius - y)), left + right, tip.arc.radius)


@dataclass(frozen=True)
class DrawnDie:
    """A die with the middle of its V at x = 0 and its top at z = 0.

    Attributes
    ----------
    profile : Profile
        The section.
    opening, angle, radius : float
        Distance of the lines where the flanks, drawn on, meet the top, in mm; angle between the flanks in degrees;
        radius of the shoulders in mm.
    depth : float
        Depth of the V in its middle, in mm.
    """

    profile: Profile
    opening: float
    angle: float
    radius: float
    depth: float

    @property
    def words(self) -> str:
        """Description in a few words."""
        return f"drawn, {len(self.profile.segments)} lines and arcs"

    @classmethod
    def of(cls, profile: Profile, where: str = "die") -> DrawnDie:
        """The die of a section, wherever it was drawn.

        Raises
        ------
        OpenSection
            If it has not two round shoulders between a level top and straight flanks, equal on both sides.
        """
        segments = _few(profile, where)
        top = max(float(segment.points(_chord(profile))[:, 1].max()) for segment in segments)
        shoulders = [corner for corner in corners_of(segments, profile.closed) if corner.is_shoulder(top)]
        right = [one for one in shoulders if one.goes_down]
        left = [one for one in shoulders if not one.goes_down]
        if len(right) != 1 or len(left) != 1 or left[0].arc.centre[0] >= right[0].arc.centre[0]:
            raise OpenSection(
                "the top of the die has not one V with two round shoulders",
                where=where,
                value=f"{len(right)} right and {len(left)} left shoulders between top and flank at y = {top:.6g}",
                cause="drawn upside down, sharp shoulders, several V in one block, or the punch in place of the die",
                remedy="draw one V open upwards: level top, arc, straight flank, and the same on the other side",
            )
        one, other = left[0], right[0]
        _level(where, "the flanks of the die", one.steepness, other.steepness, _ASKEW, "degrees from the vertical")
        opening = other.meeting(top) - one.meeting(top)
        _level(where, "the shoulder radii", one.arc.radius, other.arc.radius, _UNEVEN * opening, "mm")
        middle = 0.5 * (one.meeting(top) + other.meeting(top))
        placed = levelled(moved(profile, (-middle, -other.level.end[1])))  # half of the sheet is modelled: on the right
        radius = 0.5 * (one.arc.radius + other.arc.radius)
        return cls(placed, opening, one.steepness + other.steepness, radius, _depth(placed))


def read_punch(path: str | Path, layer: str | None = None) -> DrawnPunch:
    """The punch of a DXF drawing in mm; see `Profile.from_dxf` for what may be in it.

    Raises
    ------
    FileProblem, InvalidValue, OpenSection
        If there is no such file or layer, or its lines and arcs are no outline, or none of a punch.
    """
    return DrawnPunch.of(read_section(path, layer, above=True), str(path))


def read_die(path: str | Path, layer: str | None = None) -> DrawnDie:
    """The die of a DXF drawing in mm; see `Profile.from_dxf` for what may be in it.

    Raises
    ------
    FileProblem, InvalidValue, OpenSection
        If there is no such file or layer, or its lines and arcs are no outline, or none of a die.
    """
    return DrawnDie.of(read_section(path, layer, above=False), str(path))


def read_section(path: str | Path, layer: str | None, *, above: bool) -> Profile:
    """The section in a DXF drawing, where it was drawn; the solid of an open one is above or below it."""
    profile = Profile.from_dxf(path, layer, tolerance=_APART)
    return profile.reversed() if above and not profile.closed else profile


def check_drawn(punch: object, die: object) -> None:
    """Refuse drawn tools that are something else.

    Raises
    ------
    InvalidValue
    """
    for name, tool, kind in (("punch_section", punch, DrawnPunch), ("die_section", die, DrawnDie)):
        if tool is not None and not isinstance(tool, kind):
            raise InvalidValue(
                f"a drawn tool is a {kind.__name__}",
                where=name,
                value=type(tool).__name__,
                cause="a path or a Profile in place of the tool",
                remedy=f"read_{name.partition('_')[0]}(path), or {kind.__name__}.of(profile)",
            )


def check_one_sided(punch: DrawnPunch, reach: float) -> None:
    """Refuse a punch that stands out of its flanks, where a leg may come, on the left and not on the right.

    Half of the sheet is modelled, with the right side of the punch. A neck that lies back behind the flank does not
    matter: the flank is met first.

    Parameters
    ----------
    punch : DrawnPunch
        The punch.
    reach : float
        Length of a leg in mm.
    """
    points = punch.profile.points(1e-3 * reach, reach)
    half = math.radians(0.5 * punch.angle)
    edge = punch.radius / math.sin(half) - punch.radius  # the flanks meet so far below the tip
    near = points[(points[:, 0] < 0.0) & (points[:, 1] < reach)]
    outside = near[-near[:, 0] > (near[:, 1] + edge) * math.tan(half) + 1e-3 * reach]
    if not len(outside):
        return
    mirrored = np.column_stack([-outside[:, 0], np.zeros(len(outside)), outside[:, 1]])
    if float(Extruded(punch.profile).gap(mirrored)[0].max()) > 2e-3 * reach:
        raise InvalidValue(
            "the left side of the punch stands out farther than the right one",
            where="punch_section",
            value=f"at {-float(outside[:, 0].min()):.4g} mm from the middle",
            cause="half of the sheet is modelled, and it meets the right side of the punch",
            remedy="mirror the drawing, or make both sides alike as far as the legs reach",
        )


def _few(profile: Profile, where: str) -> list[Segment]:
    """Lines and arcs, pieces of one line or circle joined; not more than a deck may have."""
    if len(profile.segments) > _MOST:
        raise OpenSection(
            f"a section of a tool has at most {_MOST} lines and arcs",
            where=where,
            value=len(profile.segments),
            cause="a scan, or arcs that were broken into short lines",
            remedy="draw arcs as arcs",
        )
    return merged(profile)


def _chord(profile: Profile) -> float:
    return 1e-7 * profile.size


def _level(where: str, what: str, one: float, other: float, most: float, unit: str) -> None:
    """Refuse sides that differ."""
    if abs(one - other) > most:
        raise OpenSection(
            f"{what} differ",
            where=where,
            value=f"{one:.6g} and {other:.6g} {unit}",
            cause="a tilted drawing, or an asymmetric tool: half of the sheet is modelled, so both sides must be alike",
            remedy="turn the drawing upright, or make both sides alike",
        )


def _depth(profile: Profile) -> float:
    """Depth of the highest place of the section below the origin."""
    points = profile.points(_chord(profile))
    a, b = points[:-1], points[1:]
    across = (a[:, 0] <= 0.0) != (b[:, 0] <= 0.0)
    a, b = a[across], b[across]
    heights = a[:, 1] - a[:, 0] * (b[:, 1] - a[:, 1]) / (b[:, 0] - a[:, 0])
    return float(-heights.max()) if len(heights) else math.inf

"""Join loose lines and arcs of a drawing to one curve."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from umform.errors import OpenSection
from umform.surfaces.directions import Point2
from umform.surfaces.joined import groups, merged
from umform.surfaces.segments import Arc, Floats, Ids, Line, Segment

#: How many places a message names.
_PLACES = 4


def chain(segments: Sequence[Segment], tolerance: float, where: str) -> tuple[list[Segment], bool]:
    """One curve of lines and arcs whose ends meet within a distance, in any order and direction.

    Parameters
    ----------
    segments : sequence of Line or Arc
        As they were drawn.
    tolerance : float
        Ends nearer than this become one point, their mean. Segments that are shorter are left out; a run of them, one
        after the other as polylines and splines have them, becomes lines that are just longer.
    where : str
        For messages.

    Returns
    -------
    segments : list of Line or Arc
        In the order of a walk along the curve.
    closed : bool
        Whether its end is its start.

    Raises
    ------
    OpenSection
        If it is empty, or has a gap, a branch, or several curves; the message has the coordinates.
    """
    drawn, segments = segments, _without_short(segments, tolerance)
    if drawn and not segments:
        raise OpenSection(
            "all lines and arcs are shorter than the tolerance",
            where=where,
            value=f"up to {max(segment.length for segment in drawn):.3g}, the tolerance is {tolerance:.3g}",
            cause="a drawing without its unit, or in another one than it says",
            remedy="the right unit in the drawing, or a smaller tolerance",
        )
    if not segments:
        raise OpenSection(
            "there is no line and no arc",
            where=where,
            cause="another layer, a block, or only texts and dimensions",
            remedy="name the layer with the section; lines, arcs, circles, polylines, ellipses and splines are read",
        )
    points, ends = _points(segments, tolerance)
    degree = np.bincount(ends.ravel(), minlength=len(points))
    if (degree > 2).any():
        raise OpenSection(
            "more than two ends meet in a point",
            where=where,
            value=_places(points[degree > 2]),
            cause="a line drawn twice, or a centre line that meets the section",
            remedy="put the section on a layer of its own",
        )
    count, label = groups(ends[:, 0], ends[:, 1], len(points))
    if count > 1:
        _refuse_many(segments, points, label, degree, ends, where)
    return _walked(segments, points, ends, degree)


def _without_short(segments: Sequence[Segment], tolerance: float) -> list[Segment]:
    """The segments with chords in place of runs of short ones, no farther from them than the tolerance."""
    kept, start, end = list[Segment](), None, None
    for segment in segments:
        if segment.length > tolerance:
            kept.append(segment)
            start = end = None
            continue
        one, other = segment.start, segment.end
        if end is not None and math.dist(end, other) < math.dist(end, one):  # drawn the other way round
            one, other = other, one
        if start is None or end is None or math.dist(end, one) > tolerance:
            start = one
        end = other
        if math.dist(start, end) > tolerance:
            kept.append(Line(start, end))
            start = end
    return kept


def _points(segments: Sequence[Segment], tolerance: float) -> tuple[Floats, Ids]:
    """Points, and those at the start and the end of each segment."""
    at = np.array([end for segment in segments for end in (segment.start, segment.end)])
    points, label = merged(at, tolerance)
    return points, label.reshape(-1, 2)


def _walked(segments: Sequence[Segment], points: Floats, ends: Ids, degree: Ids) -> tuple[list[Segment], bool]:
    """Segments in the order of a walk from a free end, or from the first one."""
    free = np.flatnonzero(degree == 1)
    at = int(free[0]) if len(free) else int(ends[0, 0])
    left, walk = [list[int]() for _ in points], list[Segment]()
    for k in reversed(range(len(segments))):
        for one in set(ends[k].tolist()):
            left[one].append(k)
    while left[at]:
        i = left[at][-1]
        for one in set(ends[i].tolist()):
            left[one].remove(i)
        forward = ends[i, 0] == at
        segment = segments[i] if forward else segments[i].reversed()
        following = int(ends[i, 1] if forward else ends[i, 0])
        walk.append(_between(segment, points[at], points[following], closed=at == following))
        at = following
    return walk, not len(free)


def _between(segment: Segment, start: Floats, end: Floats, *, closed: bool) -> Segment:
    """The segment with its ends moved to two points: an arc keeps its angle."""
    p, q = (float(start[0]), float(start[1])), (float(end[0]), float(end[1]))
    if isinstance(segment, Line):
        return Line(p, q)
    if closed:
        return Arc(p, p, segment.centre, segment.clockwise)
    half = 0.5 * segment.turn * segment.angle
    d = end - start
    centre = 0.5 * (start + end) + 0.5 / math.tan(half) * np.array([-d[1], d[0]])
    return Arc(p, q, (float(centre[0]), float(centre[1])), segment.clockwise)


def _refuse_many(segments: Sequence[Segment], points: Floats, label: Ids, degree: Ids, ends: Ids, where: str) -> None:
    """Gaps if a curve is open, else several loops."""
    free = points[degree == 1]
    if len(free):
        near = np.linalg.norm(free[:, None] - free, axis=2)
        np.fill_diagonal(near, np.inf)
        near = near.min(axis=1)
        order = np.argsort(near, kind="stable")
        gaps = f"{len(free)} free ends, the nearest pair {near[order[0]]:.3g} apart: " if len(free) > 2 else ""
        raise OpenSection(
            "the lines and arcs do not make one curve",
            where=where,
            value=gaps + _places(free[order]),
            cause="ends that miss each other, or parts that do not belong to the section",
            remedy="a larger tolerance if these ends should meet, or the section on a layer of its own",
        )
    loops = []
    for k in range(int(label.max()) + 1):
        own, first = points[label == k], segments[int(np.flatnonzero(label[ends[:, 0]] == k)[0])]
        if isinstance(first, Arc) and first.start == first.end:
            loops.append(f"a circle around {_point(first.centre)}, radius {first.radius:.6g}")
        else:
            loops.append(f"one from {_point(own.min(axis=0))} to {_point(own.max(axis=0))}")
    raise OpenSection(
        f"there are {len(loops)} closed curves",
        where=where,
        value="; ".join(loops[:_PLACES]) + ("; ..." if len(loops) > _PLACES else ""),
        cause="holes, or several views in one drawing",
        remedy="put the section on a layer of its own and name it",
    )


def _places(at: Floats) -> str:
    return ", ".join(_point(x) for x in at[:_PLACES]) + (", ..." if len(at) > _PLACES else "")


def _point(x: Floats | Point2) -> str:
    return f"({x[0]:.6g}, {x[1]:.6g})"

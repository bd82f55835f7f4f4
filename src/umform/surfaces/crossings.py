"""Detect self-intersections of a plane curve."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from umform.errors import InvalidValue
from umform.surfaces.segments import Arc, Floats, Line, Segment

#: Segments nearer than this part of the profile's size touch; tangency and crossing are distinguished up to its root.
_TOUCH = 1e-9


def refuse_crossings(segments: Sequence[Segment], closed: bool, endless: tuple[bool, bool], where: str) -> None:
    """Reject a curve that meets itself anywhere but at the joints of successive segments.

    Parameters
    ----------
    segments : sequence of Line or Arc
        In the order of the walk.
    closed : bool
        The last segment is followed by the first.
    endless : tuple of bool
        Whether the first and the last line extend to infinity.
    where : str
        For the message.

    Raises
    ------
    InvalidValue
        With the two segments and the point.
    """
    size = max(float(np.abs([segment.start, segment.end]).max()) for segment in segments)
    size = max(size, max((segment.radius for segment in segments if isinstance(segment, Arc)), default=0.0))
    last = len(segments) - 1
    for i, k in _near(segments, endless, 1e3 * _TOUCH * size):
        one, other = segments[i], segments[k]
        joints = [one.end] if k == i + 1 else []
        if closed and i == 0 and k == last:
            joints.append(one.start)
        for at in _meetings(one, other, size):
            on_both = all(
                _holds(segment, at, _TOUCH * size, (number == 0 and endless[0], number == last and endless[1]))
                for number, segment in ((i, one), (k, other))
            )
            if on_both and all(math.dist(at, joint) > 1e3 * _TOUCH * size for joint in joints):
                raise InvalidValue(
                    "a profile must not meet itself",
                    where=where,
                    value=f"segments {i} and {k} at ({at[0]:.6g}, {at[1]:.6g})",
                    cause="corners in another order, or the open ends go on for ever towards each other"
                    if any(endless)
                    else "corners in another order",
                    remedy="give the corners in the order of a walk with the solid on the left",
                )


def _near(segments: Sequence[Segment], endless: tuple[bool, bool], reach: float) -> Iterator[tuple[int, int]]:
    """Pairs of segments whose surrounding rectangles, made larger by a distance, overlap."""
    ends = np.array([(segment.start, segment.end) for segment in segments], dtype=float)
    beyond = np.array([[reach + _rise(segment)] for segment in segments])
    low, high = ends.min(axis=1) - beyond, ends.max(axis=1) + beyond
    for number in (k for k, goes_on in zip((0, -1), endless, strict=True) if goes_on):
        low[number], high[number] = -np.inf, np.inf
    for i in range(len(segments) - 1):
        near = (low[i + 1 :] <= high[i]) & (high[i + 1 :] >= low[i])
        yield from ((i, i + 1 + int(k)) for k in np.flatnonzero(near.all(axis=1)))


def _rise(segment: Segment) -> float:
    """Largest distance of a segment from the rectangle around its ends, or more."""
    if isinstance(segment, Line):
        return 0.0
    return 2.0 * segment.radius if segment.angle > math.pi else segment.radius * (1.0 - math.cos(0.5 * segment.angle))


def _meetings(one: Segment, other: Segment, size: float) -> list[Floats]:
    """Common points of the two infinite lines or whole circles; for coinciding ones the ends of both segments."""
    if isinstance(one, Line) and isinstance(other, Line):
        return _of_lines(one, other, size)
    if isinstance(one, Arc) and isinstance(other, Arc):
        return _of_circles(one, other, size)
    line, arc = (one, other) if isinstance(one, Line) else (other, one)
    assert isinstance(line, Line)
    assert isinstance(arc, Arc)
    t = line.tangents()[0]
    d = np.subtract(arc.centre, line.start)
    foot = np.array(line.start) + (d @ t) * t
    return _chord(foot, t, arc.radius, float(t[0] * d[1] - t[1] * d[0]))


def _of_lines(one: Line, other: Line, size: float) -> list[Floats]:
    t, s = one.tangents()[0], other.tangents()[0]
    d = np.subtract(other.start, one.start)
    sine = t[0] * s[1] - t[1] * s[0]
    if abs(sine) > 1e-12:
        return [np.array(one.start) + (d[0] * s[1] - d[1] * s[0]) / sine * t]
    return _ends(one, other) if abs(t[0] * d[1] - t[1] * d[0]) < _TOUCH * size else []


def _of_circles(one: Arc, other: Arc, size: float) -> list[Floats]:
    d = np.subtract(other.centre, one.centre)
    distance = float(np.hypot(*d))
    if distance < _TOUCH * size:
        return _ends(one, other) if abs(one.radius - other.radius) < _TOUCH * size else []
    along = (distance**2 + one.radius**2 - other.radius**2) / (2.0 * distance)
    e = d / distance
    return _chord(np.array(one.centre) + along * e, np.array([-e[1], e[0]]), one.radius, along)


def _chord(foot: Floats, direction: Floats, radius: float, offset: float) -> list[Floats]:
    """Points of a circle on a line that passes its centre at ``offset``; one if it is tangent."""
    square = radius**2 - offset**2
    if abs(square) < 1e-12 * radius**2:
        return [foot]
    if square < 0.0:
        return []
    return [foot + math.sqrt(square) * direction, foot - math.sqrt(square) * direction]


def _ends(one: Segment, other: Segment) -> list[Floats]:
    """Ends of both, and a point between them, for segments on the same line or circle."""
    return [
        np.array(at, dtype=float) for segment in (one, other) for at in (segment.start, _middle(segment), segment.end)
    ]


def _middle(segment: Segment) -> Floats:
    if isinstance(segment, Line):
        return 0.5 * np.add(segment.start, segment.end)
    return np.array(segment.centre) + segment.radius * segment.middle


def _holds(segment: Segment, at: Floats, tolerance: float, endless: tuple[bool, bool]) -> bool:
    """Whether a point of its line or circle belongs to a segment."""
    if isinstance(segment, Line):
        along = float(np.subtract(at, segment.start) @ segment.tangents()[0])
        return (endless[0] or along > -tolerance) and (endless[1] or along < segment.length + tolerance)
    height = float(np.subtract(at, segment.centre) @ segment.middle)
    return height >= segment.radius * math.cos(0.5 * segment.angle) - tolerance

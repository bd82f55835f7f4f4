"""Checks of a flat pattern: overlap, holes near bends, flanges too short for the die."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from umform.flat_pattern.pattern import FlatBend, FlatPattern

Floats = NDArray[np.float64]

#: Parts of a length that count as a touch.
_TOUCH = 1e-6


def overlap(pattern: FlatPattern) -> Floats | None:
    """A place where contours cross, (2,); None if the pattern lies flat without overlap."""
    curves = [one.points() for one in (pattern.outer, *pattern.holes)]
    low, high = (np.array([reduce(x, axis=0) for x in curves]) for reduce in (np.min, np.max))
    for k, x in enumerate(curves):
        near = ((low[k:] <= high[k]) & (high[k:] >= low[k])).all(axis=1)
        others = [curves[n] for n in (k + np.flatnonzero(near)).tolist()]
        ends = [np.roll(other, -1, axis=0) for other in others]
        found = _crossing(x, np.roll(x, -1, axis=0), np.concatenate(others), np.concatenate(ends))
        if found is not None:
            return found
    return None


def _crossing(a: Floats, b: Floats, c: Floats, d: Floats) -> Floats | None:
    """A point inside of both a segment from a to b and one from c to d."""
    way, other = b - a, d - c
    for start, along in zip(a, way, strict=True):
        cross = along[0] * other[:, 1] - along[1] * other[:, 0]
        away = c - start
        with np.errstate(divide="ignore", invalid="ignore"):
            s = (away[:, 0] * other[:, 1] - away[:, 1] * other[:, 0]) / cross
            r = (away[:, 0] * along[1] - away[:, 1] * along[0]) / cross
        inside = (s > _TOUCH) & (s < 1.0 - _TOUCH) & (r > _TOUCH) & (r < 1.0 - _TOUCH)
        if inside.any():
            return np.asarray(start + s[int(np.flatnonzero(inside)[0])] * along)
    return None


def holes_near_bends(pattern: FlatPattern) -> Iterator[str]:
    """Warnings of holes nearer than 2 t + R to a bend line."""
    for number, hole in enumerate(pattern.holes, start=1):
        x = hole.points()
        for bend in pattern.bends:
            least = 2.0 * pattern.thickness + bend.radius
            away = _distance(x, np.array([bend.lines[0][0], bend.lines[-1][1]]))
            if away < least:
                middle = x.mean(axis=0)
                how = "lies across" if away == 0.0 else f"is {away:.3g} mm from"
                yield (
                    f"hole {number} at {middle[0]:.4g}, {middle[1]:.4g} {how} the line of bend {bend.number}, nearer "
                    f"than 2 t + R = {least:.3g} mm: it will be distorted"
                )


def _distance(x: Floats, line: Floats) -> float:
    """Distance of a closed curve from a line; 0 if the line crosses it."""
    along = line[1] - line[0]
    length = float(np.linalg.norm(along))
    along = along / length
    way = x - line[0]
    s, h = way @ along, way @ np.array([-along[1], along[0]])
    between = (s > 0.0) & (s < length)
    if between.any() and h[between].min() < 0.0 < h[between].max():
        return 0.0
    return float(np.hypot(h, np.maximum(np.maximum(-s, s - length), 0.0)).min())


def shortest_flange(pattern: FlatPattern, bend: FlatBend) -> float:
    """Shortest flange of a bend: flat length, square to its line, to the contour or to the next bend."""
    return min(length for line in bend.lines for length in _flanges(pattern, bend, line))


def _flanges(pattern: FlatPattern, bend: FlatBend, line: Floats, places: int = 9) -> list[float]:
    across = np.array([-bend.along[1], bend.along[0]])
    x = pattern.outer.points()
    ends = np.roll(x, -1, axis=0)
    others = [
        (one[0], one[1], 0.5 * other.allowance.length)
        for other in pattern.bends
        if other is not bend
        for one in other.lines
    ]
    found = list[float]()
    for share in (np.arange(places) + 0.5) / places:
        at = line[0] + share * (line[1] - line[0])
        ways = crossings(at, across, x, ends)
        more = [
            way - np.sign(way) * half
            for a, b, half in others
            for way in crossings(at, across, a[None], b[None]).tolist()
        ]
        all_ways = np.concatenate([ways, more])
        found += [float(all_ways[all_ways > 0.0].min()), float(-all_ways[all_ways < 0.0].max())]
    return found


def crossings(at: Floats, way: Floats, a: Floats, b: Floats) -> Floats:
    """Distances along a straight line at which it crosses segments from a to b."""
    side = np.array([-way[1], way[0]])
    h, g = (a - at) @ side, (b - at) @ side
    hit = (h > 0.0) != (g > 0.0)
    h, g = h[hit], g[hit]
    x = a[hit] + (h / (h - g))[:, None] * (b[hit] - a[hit])
    return np.asarray((x - at) @ way)

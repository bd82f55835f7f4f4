"""The contours of a flat pattern: free edges laid flat as lines and arcs, joined to closed curves."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from umform.errors import DrawingError
from umform.flat_pattern.unfold import BendMap, PlaneMap, Unfolded
from umform.surfaces.cad.solid import SolidEdge
from umform.surfaces.directions import pair
from umform.surfaces.segments import Arc, Line, Segment

Floats = NDArray[np.float64]

#: Distance in mm below which ends of pieces are one point.
_JOINT = 2e-4
#: Sine of the angle below which lines go on straight.
_STRAIGHT = 1e-6


@dataclass(frozen=True, eq=False)
class Contour:
    """A closed curve, counter-clockwise.

    Attributes
    ----------
    segments : tuple of Line or Arc
        Lines and arcs, each from the end of the one before; a circle is one arc.
    """

    segments: tuple[Segment, ...]

    @property
    def area(self) -> float:
        """Area within it."""
        return sum(segment.area for segment in self.segments)

    def points(self, chord: float = 0.02) -> Floats:
        """Points along it (n, 2), the first one once; arcs within a distance of a chord."""
        return np.concatenate([segment.points(chord)[:-1] for segment in self.segments])

    @property
    def circle(self) -> Arc | None:
        """The arc if the whole curve is a circle."""
        only = self.segments[0]
        return only if len(self.segments) == 1 and isinstance(only, Arc) else None


def contours_of(flat: Unfolded) -> tuple[list[Contour], float]:
    """Closed curves of the free edges, the largest first, and the largest distance of polylines from the curves.

    Raises
    ------
    DrawingError
        If the free edges do not close.
    """
    skin = flat.skin
    shared = {k for pairs in skin.neighbours.values() for k, _ in pairs}
    pieces, deviation = list[list[Segment]](), 0.0
    for place, patch in enumerate(skin.patches):
        for k in patch.edges:
            if k not in shared:
                piece, away = _flat_edge(skin.solid.edges[k], flat.maps[place])
                pieces.append(piece)
                deviation = max(deviation, away)
    closed = [_oriented(_simplified(loop)) for loop in _joined(pieces, str(skin.solid.path))]
    return sorted(closed, key=lambda one: -one.area), deviation


def _flat_edge(edge: SolidEdge, lay: PlaneMap | BendMap) -> tuple[list[Segment], float]:
    """Segments of an edge laid flat, and their distance from the curve."""
    x = lay(edge.points)
    if edge.kind == "Circle" and isinstance(lay, PlaneMap):
        assert edge.centre is not None
        centre = lay(edge.centre[None])[0]
        arms = x - centre
        left = arms[0, 0] * arms[1, 1] - arms[0, 1] * arms[1, 0] > 0.0
        whole = np.linalg.norm(x[0] - x[-1]) < _JOINT
        end = x[0] if whole else x[-1]
        return [Arc(pair(x[0]), pair(end), pair(centre), clockwise=not left)], 0.0
    turns = [_beside(a, b, c) for a, b, c in zip(x[:-2], x[1:-1], x[2:], strict=True)]
    if not turns or max(turns) < 1e-6:
        return [Line(pair(x[0]), pair(x[-1]))], 0.0
    # Two chords are about four times as far from the curve as one.
    return [Line(pair(a), pair(b)) for a, b in pairwise(x)], 0.25 * max(turns)


def _beside(a: Floats, b: Floats, c: Floats) -> float:
    """Distance of the middle one of three points from the chord."""
    way = c - a
    length = float(np.hypot(*way))
    return abs(float(way[0] * (b - a)[1] - way[1] * (b - a)[0])) / length if length > 0.0 else 0.0


def _joined(pieces: list[list[Segment]], where: str) -> Iterable[list[Segment]]:
    """Closed curves; where more than two ends meet, the sharpest turn to the right leaves parts that only touch."""
    ends = np.array([(p[0].start, p[-1].end) for p in pieces]).reshape(-1, 2)
    free = set(range(len(pieces)))
    while free:
        first = min(free)
        free.discard(first)
        loop = list(pieces[first])
        while math.dist(loop[0].start, loop[-1].end) > _JOINT:
            near = np.flatnonzero(np.hypot(*(ends - loop[-1].end).T) < _JOINT)
            onward = [(k // 2, k % 2) for k in near.tolist() if k // 2 in free]
            if not onward:
                raise DrawingError(
                    "the contour of the flat pattern does not close",
                    where=where,
                    value=f"at {loop[-1].end[0]:.3f}, {loop[-1].end[1]:.3f} of the flat pattern",
                    cause="faces that overlap in the flat, or an edge of the solid that is missing",
                    remedy="repair the solid in the program that wrote the file",
                )
            piece, backward = onward[0]
            free.discard(piece)
            loop += [s.reversed() for s in reversed(pieces[piece])] if backward else pieces[piece]
        yield loop


def _simplified(loop: list[Segment]) -> list[Segment]:
    """Lines that go on straight, and arcs about one centre, joined."""
    done = True
    while done and len(loop) > 1:
        done = False
        for k in range(len(loop)):
            both = _one(loop[k - 1], loop[k])
            if both is not None and (len(loop) > 2 or isinstance(both, Arc)):
                loop = (
                    [both, *(s for n, s in enumerate(loop) if n not in (k, (k - 1) % len(loop)))]
                    if k == 0
                    else [*loop[: k - 1], both, *loop[k + 1 :]]
                )
                done = True
                break
    return loop


def _one(a: Segment, b: Segment) -> Segment | None:
    if isinstance(a, Line) and isinstance(b, Line):
        (t, _), (s, _) = a.tangents(), b.tangents()
        straight = abs(t[0] * s[1] - t[1] * s[0]) < _STRAIGHT and t @ s > 0.0
        return Line(a.start, b.end) if straight else None
    if isinstance(a, Arc) and isinstance(b, Arc) and a.clockwise == b.clockwise:
        same = math.dist(a.centre, b.centre) < _JOINT and abs(a.radius - b.radius) < _JOINT
        whole = math.dist(a.start, b.end) < _JOINT
        return Arc(a.start, a.start if whole else b.end, a.centre, a.clockwise) if same else None
    return None


def _oriented(loop: list[Segment]) -> Contour:
    made = Contour(tuple(loop))
    return made if made.area > 0.0 else Contour(tuple(segment.reversed() for segment in reversed(loop)))

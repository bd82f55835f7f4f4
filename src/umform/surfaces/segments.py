"""Lines and arcs of a plane curve: tangents, lengths, areas, points."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.surfaces.directions import Point2, point

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]


@dataclass(frozen=True)
class Line:
    """Straight segment."""

    start: Point2
    """First end."""
    end: Point2
    """Second end."""

    def check(self, where: str) -> None:
        """Reject a line of no length."""
        if self._vector(where).any():
            return
        raise InvalidValue(
            "a line must have a length",
            where=where,
            value=f"both ends at {self.start}",
            cause="a point was given twice",
            remedy="take the line out",
        )

    def _vector(self, where: str = "Line") -> Floats:
        return np.subtract(point(self.end, f"{where}.end", 2), point(self.start, f"{where}.start", 2))

    @property
    def length(self) -> float:
        """Length."""
        return float(np.hypot(*self._vector()))

    def tangents(self) -> tuple[Floats, Floats]:
        """Unit tangents at start and end."""
        t = self._vector() / self.length
        return t, t

    @property
    def area(self) -> float:
        """Area between the segment and the origin, positive if it runs counter-clockwise about the origin."""
        return 0.5 * (self.start[0] * self.end[1] - self.start[1] * self.end[0])

    def points(self, chord: float) -> Floats:
        """Points along the segment, both ends among them."""
        return np.array([self.start, self.end], dtype=float)

    def reversed(self) -> Line:
        """The same line, reversed."""
        return Line(self.end, self.start)

    def shifted(self, by: Point2) -> Line:
        """The same line, transformed."""
        return Line(_sum(self.start, by), _sum(self.end, by))

    def seen(self, matrix: Floats, shift: Floats) -> Line:
        """The same line with its points p at M p + c, M orthogonal."""
        return Line(_seen(self.start, matrix, shift), _seen(self.end, matrix, shift))

    def row(self) -> list[float]:
        """Start, end, centre and turn, as the kernels take them."""
        return [*self.start, *self.end, 0.0, 0.0, 0.0]


@dataclass(frozen=True)
class Arc:
    """Circular segment about a centre; where start and end are the same point it is the whole circle."""

    start: Point2
    """First end."""
    end: Point2
    """Second end."""
    centre: Point2
    """Centre, at the same distance from both ends."""
    clockwise: bool = False
    """Turns to the right: a concave arc, its centre on the side of the void. Otherwise it turns to the left and is
    convex, its centre on the side of the solid."""

    def check(self, where: str) -> None:
        """Reject an arc whose ends have different distances from the centre."""
        centre = point(self.centre, f"{where}.centre", 2)
        first = math.dist(point(self.start, f"{where}.start", 2), centre)
        last = math.dist(point(self.end, f"{where}.end", 2), centre)
        if min(first, last) == 0.0:
            raise InvalidValue(
                "an arc must have a radius",
                where=where,
                value=f"an end at the centre {self.centre}",
                cause="the centre is given in place of an end",
                remedy="the centre has the distance of the radius from both ends",
            )
        if abs(first - last) > 1e-9 * max(first, last):
            raise InvalidValue(
                "the ends of an arc must be at the same distance from its centre",
                where=where,
                value=f"{first:.12g} and {last:.12g}",
                cause="rounded coordinates of the centre or of an end",
                remedy="compute the centre from the ends and the radius",
            )

    @property
    def turn(self) -> int:
        """1 to the left, -1 to the right."""
        return -1 if self.clockwise else 1

    @property
    def radius(self) -> float:
        """Distance of the ends to the centre."""
        return 0.5 * (math.dist(self.start, self.centre) + math.dist(self.end, self.centre))

    @property
    def angle(self) -> float:
        """Angle of the arc, positive and at most 2 pi."""
        if self.start == self.end:
            return 2.0 * math.pi
        p, q = np.subtract(self.start, self.centre), np.subtract(self.end, self.centre)
        return float(math.atan2(self.turn * (p[0] * q[1] - p[1] * q[0]), p @ q) % (2.0 * math.pi))

    @property
    def length(self) -> float:
        """Length."""
        return self.radius * self.angle

    def tangents(self) -> tuple[Floats, Floats]:
        """Unit tangents at start and end."""
        p, q = np.subtract(self.start, self.centre), np.subtract(self.end, self.centre)
        left = self.turn * np.array([[0.0, -1.0], [1.0, 0.0]])
        return left @ p / np.hypot(*p), left @ q / np.hypot(*q)

    @property
    def area(self) -> float:
        """Area between the segment and the origin, positive if it runs counter-clockwise about the origin."""
        cap = 0.5 * self.radius**2 * (self.angle - math.sin(self.angle))
        return Line(self.start, self.end).area + self.turn * cap

    @property
    def middle(self) -> Floats:
        """Unit vector from the centre to the middle of the arc."""
        p = np.subtract(self.start, self.centre) / self.radius
        half = 0.5 * self.turn * self.angle
        return np.array([p[0] * math.cos(half) - p[1] * math.sin(half), p[0] * math.sin(half) + p[1] * math.cos(half)])

    def points(self, chord: float) -> Floats:
        """Points along the segment, both ends included, with chords that deviate by at most ``chord``."""
        step = 2.0 * math.acos(max(1.0 - chord / self.radius, 0.5))
        angles = self.turn * np.linspace(0.0, self.angle, math.ceil(self.angle / step) + 1)
        p = np.subtract(self.start, self.centre)
        x = self.centre[0] + p[0] * np.cos(angles) - p[1] * np.sin(angles)
        y = self.centre[1] + p[0] * np.sin(angles) + p[1] * np.cos(angles)
        inner = np.stack([x, y], axis=1)[1:-1]
        return np.vstack([self.start, inner, self.end])

    def reversed(self) -> Arc:
        """The same arc, reversed."""
        return Arc(self.end, self.start, self.centre, not self.clockwise)

    def shifted(self, by: Point2) -> Arc:
        """The same arc, transformed."""
        return Arc(_sum(self.start, by), _sum(self.end, by), _sum(self.centre, by), self.clockwise)

    def seen(self, matrix: Floats, shift: Floats) -> Arc:
        """The same arc with its points p at M p + c, M orthogonal."""
        start, end, centre = (_seen(p, matrix, shift) for p in (self.start, self.end, self.centre))
        return Arc(start, end, centre, self.clockwise != bool(np.linalg.det(matrix) < 0.0))

    def row(self) -> list[float]:
        """Start, end, centre and turn, as the kernels take them."""
        return [*self.start, *self.end, *self.centre, float(self.turn)]


def _sum(a: Point2, b: Point2) -> Point2:
    return a[0] + b[0], a[1] + b[1]


def _seen(p: Point2, matrix: Floats, shift: Floats) -> Point2:
    x, y = (float(part) for part in matrix @ p + shift)
    return x, y


Segment = Line | Arc

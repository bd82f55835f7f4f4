"""Plane curve of lines and arcs: the section of a tool."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from umform.errors import InvalidValue
from umform.spec.types import Positive
from umform.surfaces.corners import rounded
from umform.surfaces.crossings import refuse_crossings
from umform.surfaces.directions import Point2, point, positive
from umform.surfaces.segments import Arc, Floats, Segment

#: Sine of the angle between two segments above which they form an edge.
_EDGE = 1e-3


@dataclass(frozen=True)
class Profile:
    r"""Lines and arcs, one after the other, with the solid on the left of the direction of travel.

    A closed profile is solid inside if it runs counter-clockwise (its :attr:`area` is positive); clockwise it is a
    hole in the solid. An open one divides the plane: its first and last line extend to infinity. ::

                 void                                  .---<---.
        -----<-----.       .-----<-----                |       |
          solid     \  v  /     solid                  | solid |  void
                     '-<-'                             '--->---'

    Parameters
    ----------
    segments : sequence of Line or Arc
        In order, each starting where the previous one ends.
    closed : bool
        The last one ends where the first one starts.

    Raises
    ------
    InvalidValue
        If segments do not meet, turn back, have no length, or if the curve meets itself.

    Examples
    --------
    >>> import umform as uf
    >>> section = uf.Profile.from_corners([(0, 0), (20, 0), (20, 10), (0, 10)], [1, 1, 2, 2])
    >>> block = uf.Extruded(section)
    >>> float(block.gap([(10.0, 0.0, 10.5)])[0][0])
    0.5
    """

    segments: Sequence[Segment]
    closed: bool = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "segments", tuple(self.segments))
        if not self.segments:
            raise InvalidValue(
                "a profile needs at least one segment",
                where="Profile",
                cause="an empty list",
                remedy="give lines and arcs, or corners to Profile.from_corners",
            )
        for i, segment in enumerate(self.segments):
            segment.check(f"segment {i} of a profile")
        self._check_joints()
        refuse_crossings(self.segments, self.closed, (False, False), "Profile")

    @classmethod
    def from_corners(
        cls, corners: Sequence[Point2], radii: float | Sequence[float] = 0.0, closed: bool = True
    ) -> Profile:
        """Lines between corners that are rounded by arcs.

        Parameters
        ----------
        corners : sequence of (x, y)
            Corners in order; the ends of an open profile only define the directions of its infinite lines.
        radii : float or sequence of float
            Radius at all corners or at each; 0 leaves a corner sharp.
        closed : bool
            The last corner is followed by the first.

        Raises
        ------
        InvalidValue
            If a fillet does not fit; the message names the corners.
        """
        return cls(rounded(corners, radii, closed), closed)

    @classmethod
    def from_dxf(
        cls,
        path: str | Path,
        layer: str | None = None,
        *,
        solid: str | None = None,
        origin: Point2 = (0.0, 0.0),
        unit: str = "mm",
        tolerance: Positive | None = None,
    ) -> Profile:
        """The section in a DXF drawing: lines, arcs, circles and polylines as they are, ellipses and splines as arcs.

        Needs ezdxf: `pip install "umform[cad]"`.

        Parameters
        ----------
        path : str or Path
            The drawing, in its xy-plane.
        layer : str, optional
            The layer with the section; by default all of the drawing is the section.
        solid : str, optional
            Where the solid is: inside (by default) or outside of a closed curve; below (by default), above, left or
            right of an open one, that is of the line from its one end to the other.
        origin : (x, y)
            The point of the drawing, in the unit of the model, that becomes the origin of the profile.
        unit : str
            Unit of the model: mm, cm, m, um, in or ft; a drawing without a unit is taken as it is.
        tolerance : float
            Ends nearer than this are one point; arcs deviate by at most this from ellipses and splines. By default
            0.001 mm, in the unit of the model.

        Raises
        ------
        FileProblem
            If the file cannot be read.
        OpenSection
            If lines and arcs do not form one curve; the message has the coordinates of gaps and branches.
        """
        from umform.surfaces.chains import chain  # slow to import
        from umform.surfaces.dxf import read_dxf

        segments, closed = chain(*read_dxf(path, layer, unit, tolerance), str(path))
        shift = tuple(-c for c in point(origin, "from_dxf.origin", 2))
        made = cls([segment.shifted((shift[0], shift[1])) for segment in segments], closed)
        return made if made._has_solid(solid, str(path)) else made.reversed()

    def convex_radii(self) -> Iterator[float]:
        """Radii of convex arcs, and 0 if there is a sharp edge."""
        for i, segment in enumerate(self.segments):
            if isinstance(segment, Arc) and not segment.clockwise:
                yield segment.radius
            if i + 1 < len(self.segments) or self.closed:
                one, other = segment.tangents()[1], self.segments[(i + 1) % len(self.segments)].tangents()[0]
                if one[0] * other[1] - one[1] * other[0] > _EDGE:
                    yield 0.0

    @classmethod
    def circle(cls, centre: Point2, radius: float, hole: bool = False) -> Profile:
        """A whole circle, solid inside or a hole."""
        x, y = point(centre, "circle", 2)
        start = (x + positive(radius, "circle"), y)
        return cls([Arc(start, start, (x, y), clockwise=hole)])

    @classmethod
    def half_circle(cls, radius: float, hole: bool = False) -> Profile:
        """The meridian of a sphere about the origin."""
        top = positive(radius, "half circle")
        arc = Arc((0.0, -top), (0.0, top), (0.0, 0.0))
        return cls([arc.reversed() if hole else arc], closed=False)

    @property
    def area(self) -> float:
        """Enclosed area, negative if the profile is a hole.

        Raises
        ------
        InvalidValue
            If the profile is open.
        """
        if not self.closed:
            raise InvalidValue(
                "an open profile has no area",
                where="Profile.area",
                cause="it goes on for ever",
                remedy="close it: closed=True with a last segment that ends where the first begins",
            )
        return sum(segment.area for segment in self.segments)

    @property
    def size(self) -> float:
        """Largest coordinate of its points."""
        return float(np.abs([(segment.start, segment.end) for segment in self.segments]).max())

    def reversed(self) -> Profile:
        """The same curve with solid and void exchanged."""
        return Profile([segment.reversed() for segment in reversed(self.segments)], self.closed)

    def _has_solid(self, solid: str | None, where: str) -> bool:
        """Whether the solid is on the named side."""
        sides = {"below": (0, -1), "above": (0, 1), "left": (-1, 0), "right": (1, 0)}
        words = ("inside", "outside") if self.closed else tuple(sides)
        solid = solid or ("inside" if self.closed else "below")
        if solid not in words:
            raise InvalidValue(
                f"the solid of {'a closed' if self.closed else 'an open'} section is one of {', '.join(words)}",
                where=where,
                value=solid,
                cause="a closed section where an open one is meant, or the other way round",
                remedy=f"solid='{words[0]}', or mend the drawing",
            )
        if self.closed:
            return (self.area > 0.0) == (solid == "inside")
        d = np.subtract(self.segments[-1].end, self.segments[0].start)
        toward = float(np.dot((-d[1], d[0]), sides[solid]))
        if abs(toward) <= 1e-9 * self.size:
            raise InvalidValue(
                "the section has no such side",
                where=where,
                value=f"{solid} of the line from {self.segments[0].start} to {self.segments[-1].end}",
                cause="its ends lie above each other or beside each other",
                remedy=", ".join(
                    word for word, (x, y) in sides.items() if abs(-d[1] * x + d[0] * y) > 1e-9 * self.size
                ),
            )
        return toward > 0.0

    def points(self, chord: float, beyond: float = 0.0) -> Floats:
        """Polyline along the curve.

        Parameters
        ----------
        chord : float
            Largest distance of a chord from its arc.
        beyond : float
            Length of the infinite lines beyond the ends of an open profile.

        Returns
        -------
        ndarray, shape (n, 2)
            Points in order; for a closed profile the last point is the first.
        """
        parts = [self.segments[0].points(chord)] + [segment.points(chord)[1:] for segment in self.segments[1:]]
        points = np.vstack(parts)
        if not self.closed and beyond > 0.0:
            points[0] -= beyond * self.segments[0].tangents()[0]
            points[-1] += beyond * self.segments[-1].tangents()[1]
        return points

    def _check_joints(self) -> None:
        """Check that each segment starts where the previous one ends, and does not turn back there."""
        count, size = len(self.segments), self.size
        for i in range(count if self.closed else count - 1):
            one, other = self.segments[i], self.segments[(i + 1) % count]
            where = f"end of segment {i} of a profile"
            if np.hypot(*np.subtract(other.start, one.end)) > 1e-9 * size:
                raise InvalidValue(
                    "segments of a profile must meet",
                    where=where,
                    value=f"{one.end} and {other.start}",
                    cause="a coordinate that was rounded, or segments in another order",
                    remedy="let each segment start where the one before has ended, or say closed=False",
                )
            before, after = one.tangents()[1], other.tangents()[0]
            if before @ after < 0.0 and abs(before[0] * after[1] - before[1] * after[0]) < 1e-7:
                raise InvalidValue(
                    "the profile turns back on itself",
                    where=where,
                    value=one.end,
                    cause="two segments lie on each other",
                    remedy="take one of them out",
                )

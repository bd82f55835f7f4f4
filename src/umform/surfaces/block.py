"""A tool as a body of elements: a structured block between its profile and a straight back."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Literal, Protocol

import numpy as np
from annotated_types import Gt, Lt

from umform.errors import FoldedElement, InvalidValue, InvertedElement, WrongNodeOrder
from umform.mesh import Mesh, graded, grid
from umform.mesh.generators import Divisions, Layers
from umform.spec import About, check_arguments
from umform.spec.types import ElementTurn, Positive
from umform.surfaces.directions import Point2, point
from umform.surfaces.profile import Profile
from umform.surfaces.segments import Arc, Floats, Segment

#: A sector of a ring, less than the whole one.
Sector = Annotated[float, Gt(0.0), Lt(360.0), About("degrees", cause="radians, or a whole ring")]


class Section(Protocol):
    """A profile that is extruded or revolved."""

    @property
    def profile(self) -> Profile:
        """The profile."""

    @property
    def right_handed(self) -> bool:
        """Whether the third direction of :meth:`in_space` and the two of the profile are a right-handed frame."""

    def third(self, width: float | None, sector: float | None, elements: int) -> Floats:
        """Borders of elements along the third direction: over a width, or over a sector in degrees; one of both."""

    def in_space(self, plane: Floats, third: Floats) -> Floats:
        """Points of the plane of the profile (n, 2) in space, at distances (n,) from it or turned by angles."""


@dataclass(frozen=True)
class _Piece:
    """Part of a segment of a profile.

    Attributes
    ----------
    segment : Line or Arc
        The segment; the first and the last line of an open profile have no end.
    first, last : float
        Lengths along it, from its start.
    """

    segment: Segment
    first: float
    last: float

    @property
    def length(self) -> float:
        """Length of the part, positive in either direction."""
        return abs(self.last - self.first)

    def cuts(self, size: float, turn: float) -> int:
        """Number of elements: of at most a length, on an arc also of at most an angle in radians."""
        of_turn = self.length / (turn * self.segment.radius) if isinstance(self.segment, Arc) else 0.0
        return max(1, math.ceil(max(self.length / size, of_turn) - 1e-9))

    def at(self, part: Floats) -> Floats:
        """Points at parts 0 to 1 of the piece, shape (n, 2)."""
        way, segment = self.first + part * (self.last - self.first), self.segment
        if not isinstance(segment, Arc):
            return np.asarray(segment.start + way[:, None] * segment.tangents()[0])
        a, (x, y) = segment.turn * way / segment.radius, np.subtract(segment.start, segment.centre)
        turned = np.stack([x * np.cos(a) - y * np.sin(a), x * np.sin(a) + y * np.cos(a)], axis=1)
        return np.asarray(segment.centre + turned)


def elastic_body(
    section: Section,
    face: tuple[Point2, Point2],
    back: tuple[Point2, Point2],
    *,
    size: Positive,
    layers: Layers,
    width: Positive | None = None,
    sector: Sector | None = None,
    wide: Divisions = 1,
    growth: Positive = 1.0,
    turn: ElementTurn = 5.0,
    cell: Literal["hex8", "hex18"] = "hex8",
) -> Mesh:
    """Mesh of a part of an extruded or revolved tool; a method of :class:`umform.surfaces.Tool`.

    The elements lie between the profile of the tool and a straight back. Columns of elements connect points of the
    profile with points of the back that divide it in the same ratio.

    Parameters
    ----------
    section : Extruded or Revolved
        Section of the tool.
    face : tuple of two points
        Where the face begins and ends, in the plane of the section; the nearest points of the profile are taken.
    back : tuple of two points
        Ends of the back, opposite to those of the face.
    size : float
        Largest length of an element along the face.
    layers : int
        Layers of elements from the face to the back.
    width : float, optional
        Width of an extruded tool, from its origin towards positive coordinates; by default 1.
    sector : float, optional
        Sector of a revolved tool, in degrees about its axis from the plane of x and z (of another axis: any plane); by
        default 90.
    wide : int
        Elements over the width or the sector.
    growth : float
        Ratio of the thickness of the last layer, at the back, to that of the first one.
    turn : float
        Largest angle in degrees of an element on an arc. Chords of elements deviate from the arc by 0.1 % of its radius
        at 5 degrees.
    cell : {"hex8", "hex18"}
        Cell type.

    Returns
    -------
    Mesh
        ``upper`` is the face, ``lower`` the back, ``x0`` and ``x1`` are the ends, ``y0`` and ``y1`` the sides; with the
        node sets of :func:`umform.mesh.grid`.

    Raises
    ------
    InvalidValue
        If the face has no length, the tool has a width in place of a sector, or the reverse, or columns cross: the back
        lies in front of the face, or its ends are exchanged.

    Examples
    --------
    >>> import umform as uf
    >>> die = uf.VDie(opening=12, angle=88, shoulder_radius=1.5)
    >>> block = die.elastic_body(((2, -4), (12, 0)), ((2, -15), (12, -15)), size=0.5, layers=8, growth=4)
    >>> len(block.faces["upper"]), float(block.points[:, 2].max())
    (32, 0.0)
    """
    check_arguments(
        elastic_body, size=size, layers=layers, width=width, sector=sector, wide=wide, growth=growth, turn=turn
    )
    pieces, ahead = _pieces(section.profile, *(point(p, "face", 2) for p in face))
    ends = np.array([point(p, "back", 2) for p in back])
    cuts = [piece.cuts(size, math.radians(turn)) for piece in pieces]
    lengths = np.cumsum([0.0, *(piece.length for piece in pieces)])
    along = np.concatenate(
        [[0.0], *(np.linspace(a, b, n + 1)[1:] for a, b, n in zip(lengths[:-1], lengths[1:], cuts, strict=True))]
    )
    around = section.third(width, sector, wide)
    upwards = 1.0 - graded(1.0, layers, growth)[::-1]
    upwards[0], upwards[-1] = 0.0, 1.0
    # the natural coordinates are right-handed with the normal out of the tool: the profile has the solid on its left
    kept = section.right_handed == ahead
    natural = grid(along, around if kept else -around[::-1], upwards, cell)

    def placed(X: Floats) -> Floats:
        top = _on(pieces, lengths, X[:, 0])
        below = ends[0] + (X[:, :1] / lengths[-1]) * (ends[1] - ends[0])
        return section.in_space(below + X[:, 2:] * (top - below), np.abs(X[:, 1]))

    try:
        made = natural.transformed(placed)
    except (InvertedElement, FoldedElement, WrongNodeOrder) as error:
        raise InvalidValue(
            "columns of elements between the face and the back cross, or run out of the tool",
            where="elastic_body, back",
            value=f"{back[0]} and {back[1]}",
            cause="the back lies in front of the face, its ends are exchanged, or it is too near to an arc",
            remedy="a back inside of the tool, with its ends in the order of those of the face",
        ) from error
    return made if kept else _sides_exchanged(made)


def refuse_other(name: str, value: float | None, tool: str, instead: str) -> None:
    """Refuse a width of a revolved tool, and a sector of an extruded one."""
    if value is not None:
        raise InvalidValue(
            f"{tool} tool has a {instead} and no {name}",
            where=f"elastic_body, {name}",
            value=value,
            cause="an extruded tool is as wide as its width, a revolved one as its sector",
            remedy=f"{instead} in place of {name}",
        )


def _pieces(profile: Profile, start: list[float], end: list[float]) -> tuple[list[_Piece], bool]:
    """Parts of the profile between the points nearest to two given ones, and whether they follow its direction."""
    (i, a), (j, b) = (_nearest(profile, np.asarray(p, dtype=float)) for p in (start, end))
    ahead = (i, a) <= (j, b)
    first, last = ((i, a), (j, b)) if ahead else ((j, b), (i, a))
    pieces = [
        _Piece(segment, first[1] if k == first[0] else 0.0, last[1] if k == last[0] else segment.length)
        for k, segment in enumerate(profile.segments)
        if first[0] <= k <= last[0]
    ]
    pieces = [piece for piece in pieces if piece.length > 1e-9 * profile.size]
    if not pieces:
        raise InvalidValue(
            "the face of a body has no length",
            where="face",
            value=f"{tuple(start)} and {tuple(end)}",
            cause="both points are nearest to one point of the profile",
            remedy="two points of the section on either side of what the sheet touches",
        )
    return (pieces if ahead else [_Piece(p.segment, p.last, p.first) for p in reversed(pieces)]), ahead


def _nearest(profile: Profile, p: Floats) -> tuple[int, float]:
    """Segment, and length along it, of the point of a profile that is nearest to a point."""
    found = []
    for k, segment in enumerate(profile.segments):
        if isinstance(segment, Arc):
            d, q = np.subtract(segment.start, segment.centre), p - np.array(segment.centre)
            turned = math.atan2(segment.turn * (d[0] * q[1] - d[1] * q[0]), d @ q) % (2.0 * math.pi)
            beyond = 0.5 * (2.0 * math.pi + segment.angle)  # a point past the end is nearer to the start from here on
            way = segment.radius * (min(turned, segment.angle) if turned <= beyond else 0.0)
        else:
            way = float((p - np.array(segment.start)) @ segment.tangents()[0])
            if profile.closed or k > 0:
                way = max(way, 0.0)
            if profile.closed or k < len(profile.segments) - 1:
                way = min(way, segment.length)
        there = _Piece(segment, way, way).at(np.zeros(1))[0]
        found.append((float(np.hypot(*(there - p))), k, way))
    _, k, way = min(found)
    return k, way


def _on(pieces: list[_Piece], lengths: Floats, way: Floats) -> Floats:
    """Points of the profile at lengths along the face, shape (n, 2)."""
    of = np.clip(np.searchsorted(lengths, way, side="right") - 1, 0, len(pieces) - 1)
    points = np.empty((len(way), 2))
    for k, piece in enumerate(pieces):
        here = of == k
        points[here] = piece.at((way[here] - lengths[k]) / piece.length)
    return points


def _sides_exchanged(mesh: Mesh) -> Mesh:
    """The same mesh with the names of its sides y0 and y1 exchanged."""

    def name(old: str) -> str:
        return {"y0": "y1", "y1": "y0"}.get(old[:2], old[:2]) + old[2:]

    sets = {name(key): ids for key, ids in mesh.sets.items()}
    return Mesh(mesh.points, mesh.cells, sets, {name(key): rows for key, rows in mesh.faces.items()})

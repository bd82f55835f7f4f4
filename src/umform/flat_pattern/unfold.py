"""The faces of a sheet laid flat: a map of each plane and each bend into the plane, from the largest face on."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.errors import DrawingError, InvalidValue
from umform.flat_pattern.allowance import Allowance, AllowanceProvider
from umform.flat_pattern.skin import Patch, Skin

Floats = NDArray[np.float64]

#: Degrees from which a bend is a hem, or of a part that closes.
HEM = 165.0
#: Distance in mm of points that are one.
_MEET = 1e-4
#: Decimals of angles and lengths of bends; the remainder is rounding of the file.
_PLACES = 6


@dataclass(frozen=True, eq=False)
class PlaneMap:
    """Lays a plane flat: a point goes to ``at + axes (x - origin)``."""

    origin: Floats
    at: Floats
    axes: Floats

    def __call__(self, x: Floats) -> Floats:
        """Flat positions (n, 2) of points (n, 3)."""
        return np.asarray(self.at + (x - self.origin) @ self.axes.T)


@dataclass(frozen=True, eq=False)
class BendMap:
    """Lays a bend flat, from the tangent line that was reached first.

    Attributes
    ----------
    origin : ndarray, shape (3,)
        A point of that line.
    axis, arm, ahead : ndarray, shape (3,)
        Unit vectors along the line, from the axis of the bend to it, and along the sheet into the bend.
    radius : float
        Radius of the face.
    at, along, across : ndarray, shape (2,)
        Flat position of the origin; flat directions of ``axis`` and ``ahead``.
    angle : float
        Angle of the bend in radians.
    allowance : Allowance
        Its flat length.
    up : bool
        The flange turns towards the viewer.
    inside_radius, thickness : float
        Inside radius of the drawing; thickness.
    """

    origin: Floats
    axis: Floats
    arm: Floats
    ahead: Floats
    radius: float
    at: Floats
    along: Floats
    across: Floats
    angle: float
    allowance: Allowance
    up: bool
    inside_radius: float
    thickness: float

    def turned(self, x: Floats) -> Floats:
        """Angles (n,) of points (n, 3) about the axis, from the first tangent line."""
        way = x - self.origin + self.radius * self.arm
        return np.arctan2(way @ self.ahead, way @ self.arm)

    def __call__(self, x: Floats) -> Floats:
        """Flat positions (n, 2) of points (n, 3)."""
        share = self.turned(x) / self.angle * self.allowance.length
        return np.asarray(
            self.at + ((x - self.origin) @ self.axis)[:, None] * self.along + share[:, None] * self.across
        )


@dataclass(frozen=True, eq=False)
class Unfolded:
    """All patches of a sheet laid flat.

    Attributes
    ----------
    skin : Skin
        The sheet.
    maps : dict of int to PlaneMap or BendMap
        By the places of the patches.
    parents : dict of int to int
        Patch from which each was reached; the first has none.
    """

    skin: Skin
    maps: dict[int, PlaneMap | BendMap]
    parents: dict[int, int]


def unfold(skin: Skin, allowance: AllowanceProvider) -> Unfolded:
    """Lay the faces of a sheet flat.

    Parameters
    ----------
    skin : Skin
        The sheet.
    allowance : callable
        Gives the flat length of a bend from angle, inside radius and thickness.

    Raises
    ------
    DrawingError
        If a bend is a hem, if the section is closed, or if a bend has more than one angle.
    """
    base = skin.patches[0].face
    first = _first_direction(skin)
    axes = np.stack([first, np.cross(base.direction, first)])
    maps: dict[int, PlaneMap | BendMap] = {0: PlaneMap(base.point, np.zeros(2), axes)}
    parents, waiting = dict[int, int](), deque([0])
    while waiting:
        here = waiting.popleft()
        for k, other in skin.neighbours[here]:
            edge = skin.solid.edges[k]
            if other in maps:
                _check_meets(skin, maps, here, other, edge.points)
                continue
            line = edge.points[[0, -1]]
            if edge.kind != "Line":
                raise _refuse(
                    skin,
                    "two faces of the sheet meet smoothly along a curve",
                    (here, other),
                    "a drawn or rolled shape",
                    "only bends along straight lines unfold",
                )
            if skin.patches[other].is_bend:
                maps[other] = _bend_map(skin, other, maps[here], line, allowance)
            else:
                maps[other] = _plane_map(skin, here, other, maps[here], line)
            parents[other] = here
            waiting.append(other)
    return Unfolded(skin, maps, parents)


def _refuse(skin: Skin, what: str, places: tuple[int, ...], cause: str, remedy: str) -> DrawingError:
    faces = " and ".join(f"face {skin.patches[place].face.number}" for place in places)
    return DrawingError(what, where=str(skin.solid.path), value=faces, cause=cause, remedy=remedy)


def _first_direction(skin: Skin) -> Floats:
    """Flat x: along the longest straight edge of the base."""
    lines = [skin.solid.edges[k].points[[0, -1]] for k in skin.patches[0].edges if skin.solid.edges[k].kind == "Line"]
    ways = [line[1] - line[0] for line in lines] or [np.cross(skin.patches[0].face.direction, [0.3, 0.5, 0.8])]
    way = max(ways, key=lambda w: round(float(np.linalg.norm(w)), 6))
    way = way * (1.0 if tuple(np.round(way, 9)) > tuple(np.round(-way, 9)) else -1.0)
    return np.asarray(way / np.linalg.norm(way))


def _bend_map(
    skin: Skin, place: int, before: PlaneMap | BendMap, line: Floats, allowance: AllowanceProvider
) -> BendMap:
    face = skin.patches[place].face
    axis = (line[1] - line[0]) / np.linalg.norm(line[1] - line[0])
    arm = line[0] - face.point
    arm = arm - (arm @ face.direction) * face.direction
    arm = arm / np.linalg.norm(arm)
    ahead = np.cross(axis, arm)
    inside = face.inside - line[0]
    ahead = ahead * (1.0 if inside @ ahead > 0.0 else -1.0)
    flat = before(line)
    along = (flat[1] - flat[0]) / np.linalg.norm(flat[1] - flat[0])
    # Seen from outside the sheet, axis, ahead and normal have the same hand as along, across and the viewer.
    normal = face.normal(line[0])
    across = np.array([-along[1], along[0]]) * np.sign(np.cross(axis, ahead) @ normal)
    points = _points(skin, skin.patches[place])
    way = points - line[0] + face.radius * arm
    angle = float(np.arctan2(way @ ahead, way @ arm).max())
    up = not face.convex
    radius = round(face.radius if up else face.radius - skin.thickness, _PLACES)
    if math.degrees(angle) > HEM or (np.arctan2(way @ ahead, way @ arm) < -1e-4).any():
        raise _refuse(
            skin,
            f"this bend turns the sheet by more than {HEM:g} degrees",
            (place,),
            "a hem, a curl or a rolled tube, which a press brake does not make by one air bend",
            "take the hem out of the part; `umform hem` computes one, and its flat length is added by hand",
        )
    return BendMap(
        line[0],
        axis,
        arm,
        ahead,
        face.radius,
        flat[0],
        along,
        across,
        angle,
        _allowed(skin, place, allowance(round(math.degrees(angle), _PLACES), radius, skin.thickness)),
        up,
        radius,
        skin.thickness,
    )


def _allowed(skin: Skin, place: int, found: Allowance) -> Allowance:
    """Refuse an allowance that leaves no flat length between the tangent lines of the drawing, and what is none."""
    if not isinstance(found, Allowance):
        raise InvalidValue(
            "the function of the flat lengths returns an Allowance",
            where="allowance",
            value=found,
            cause=f"a value of type {type(found).__name__}",
            remedy='Allowance(length, "our table", radius)',
        )
    if found.length > 0.0:
        return found
    raise InvalidValue(
        "the flat length of a bend must be positive",
        where=str(skin.solid.path),
        value=f"{found.length:.4g} mm for face {skin.patches[place].face.number}, {found.source}",
        cause=f"the bend gets an inside radius of {found.radius:.3g} mm, far from that of the drawing, or the table is "
        "wrong",
        remedy="draw the inside radius that the die gives, or take a die and a punch for that of the drawing",
    )


def _plane_map(skin: Skin, here: int, other: int, before: PlaneMap | BendMap, line: Floats) -> PlaneMap:
    if isinstance(before, PlaneMap):  # two planes that meet smoothly are one
        raise _refuse(
            skin,
            "two flat faces meet at a very small angle",
            (here, other),
            "a bend without a radius",
            "draw the bend with its inside radius",
        )
    turned = float(before.turned(line[:1])[0])
    if min(abs(turned), abs(turned - before.angle)) > 1e-4:
        raise _refuse(
            skin,
            "the flanges of a bend leave it at different angles",
            (here, other),
            "a bend face that two flanges share",
            "separate the bends by a relief",
        )
    ahead = -math.sin(turned) * before.arm + math.cos(turned) * before.ahead
    axes = np.outer(before.along, before.axis) + np.outer(before.across, ahead)
    return PlaneMap(line[0], before(line[:1])[0], axes)


def _points(skin: Skin, patch: Patch) -> Floats:
    return np.concatenate([skin.solid.edges[k].points for k in patch.edges])


def _check_meets(skin: Skin, maps: dict[int, PlaneMap | BendMap], here: int, other: int, points: Floats) -> None:
    if np.abs(maps[here](points) - maps[other](points)).max() > _MEET * 10.0:
        raise _refuse(
            skin,
            "the section is closed: the faces cannot be laid flat in one piece",
            (here, other),
            "a tube, or a frame whose faces are joined all around",
            "cut it open where it is welded, and export it again",
        )

"""The flat pattern of a part: contours, bend lines, checks."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from umform.errors import DrawingError
from umform.flat_pattern.allowance import Allowance, AllowanceProvider
from umform.flat_pattern.contour import Contour, contours_of
from umform.flat_pattern.folding import largest_distance
from umform.flat_pattern.skin import Skin, skin_of
from umform.flat_pattern.unfold import BendMap, Unfolded, unfold
from umform.surfaces.cad.read_solid import DEVIATION, read_solid

Floats = NDArray[np.float64]

#: Part of the area by which contour and faces may differ.
_AREA = 1e-4
#: Thickness over the width of the flat pattern from which a part is no sheet.
_THICK = 0.5
#: Distance in mm of bend lines that are one.
_COLLINEAR = 1e-3


@dataclass(frozen=True, eq=False)
class FlatBend:
    """A bend of a flat pattern.

    Attributes
    ----------
    number : int
        From 1, by place.
    lines : tuple of ndarray, shape (2, 2)
        Ends of its line, in the middle of the bend; several where a slot cuts it.
    angle : float
        Angle in degrees by which the sheet is bent.
    radius : float
        Inside radius of the drawing in mm.
    direction : str
        "up", towards the viewer, or "down".
    allowance : Allowance
        Its flat length.
    faces : tuple of int
        Faces of the STEP file.
    """

    number: int
    lines: tuple[Floats, ...]
    angle: float
    radius: float
    direction: Literal["up", "down"]
    allowance: Allowance
    faces: tuple[int, ...]

    @property
    def along(self) -> Floats:
        """Unit vector of the line."""
        way = self.lines[0][1] - self.lines[0][0]
        return np.asarray(way / np.linalg.norm(way))

    @property
    def length(self) -> float:
        """Length of the line without its gaps."""
        return float(sum(np.linalg.norm(b - a) for a, b in self.lines))


@dataclass(frozen=True, eq=False)
class FlatPattern:
    """The flat pattern of a part.

    Attributes
    ----------
    path : Path
        The STEP file.
    unit : str
        Its unit; all lengths here are in mm.
    thickness : float
        Thickness that was found.
    outer : Contour
        The outer contour.
    holes : tuple of Contour
        The others.
    bends : tuple of FlatBend
        Bends.
    area : float
        Area of the sheet, without holes.
    deviation : float
        Largest distance in mm of polylines from curves that are no lines and arcs.
    folded_back : float
        Largest distance in mm of the pattern, folded again by its angles and radii, from the part.
    warnings : tuple of str
        Warnings.
    order : tuple of int
        Numbers of the bends in an order without collision; empty if none was found or looked for.
    """

    path: Path
    unit: str
    thickness: float
    outer: Contour
    holes: tuple[Contour, ...]
    bends: tuple[FlatBend, ...]
    area: float
    deviation: float
    folded_back: float = math.nan
    warnings: tuple[str, ...] = ()
    order: tuple[int, ...] = field(default=())

    @property
    def size(self) -> Floats:
        """Length and width of the pattern along its axes."""
        x = self.outer.points()
        return np.asarray(x.max(axis=0) - x.min(axis=0))


def pattern_of(path: str | Path, allowance: AllowanceProvider, *, deviation: float = DEVIATION) -> FlatPattern:
    """Unfold the part of a STEP file.

    Parameters
    ----------
    path : str or Path
        The file.
    allowance : callable
        Gives the flat length of a bend.
    deviation : float
        Largest distance in mm of polylines from curves that are no lines and arcs.

    Raises
    ------
    FileProblem, DrawingError
        If the file cannot be read, or the part is no bent sheet of one thickness.
    """
    skin = skin_of(read_solid(path, deviation))
    flat = unfold(skin, allowance)
    curves, away = contours_of(flat)
    outer, holes = curves[0], tuple(curves[1:])
    area = outer.area - sum(hole.area for hole in holes)
    _check_area(flat, area)
    _check_thin(skin, outer)
    return FlatPattern(
        skin.solid.path,
        skin.solid.unit,
        skin.thickness,
        outer,
        holes,
        tuple(_bends(flat)),
        area,
        away,
        folded_back=largest_distance(flat),
        warnings=skin.warnings,
    )


def _check_area(flat: Unfolded, area: float) -> None:
    """Compare the area within the contours with that of the faces: each face lies there once."""
    skin, total = flat.skin, 0.0
    for place, patch in enumerate(skin.patches):
        lay = flat.maps[place]
        share = lay.allowance.length / (lay.radius * lay.angle) if isinstance(lay, BendMap) else 1.0
        total += share * sum(skin.solid.faces[n].area for n in patch.numbers)
    if abs(area / total - 1.0) > _AREA:
        raise DrawingError(
            "the contour of the flat pattern does not hold all faces once",
            where=str(skin.solid.path),
            value=f"area {area:.6g} mm² within the contour, {total:.6g} of the faces",
            cause="faces that lie over each other in the flat",
            remedy="make the part of two pieces, or give its corners a relief",
        )


def _check_thin(skin: Skin, outer: Contour) -> None:
    """Refuse blocks and tubes, whose parallel ends look like the sides of a thick sheet."""
    x = outer.points()
    narrowest = float((x.max(axis=0) - x.min(axis=0)).min())
    if skin.thickness > _THICK * narrowest:
        raise DrawingError(
            "this part is no sheet",
            where=str(skin.solid.path),
            value=f"thickness {skin.thickness:.4g} mm behind face {skin.patches[0].face.number}, which is "
            f"{narrowest:.4g} mm wide",
            cause="a block, a round tube, or a turned part",
            remedy="export the solid of a bent sheet",
        )


def _bends(flat: Unfolded) -> Iterator[FlatBend]:
    """Bends in the order in which they are reached, those on one line together."""
    found = list[tuple[list[BendMap], list[Floats], list[int]]]()
    for place, lay in flat.maps.items():
        if not isinstance(lay, BendMap):
            continue
        lines, faces = _lines(flat, place, lay), list(flat.skin.patches[place].numbers)
        same = next((one for one in found if _one_line(one[0][0], lay)), None)
        if same is None:
            found.append(([lay], lines, faces))
        else:
            same[0].append(lay)
            same[1].extend(lines)
            same[2].extend(faces)
    for number, (maps, lines, faces) in enumerate(found, start=1):
        lay = maps[0]
        lines = sorted(lines, key=lambda line: float(line[0] @ lay.along))
        yield FlatBend(
            number,
            tuple(lines),
            round(math.degrees(lay.angle), 6),
            lay.inside_radius,
            "up" if lay.up else "down",
            lay.allowance,
            tuple(sorted(faces)),
        )


def _middle(lay: BendMap) -> Floats:
    return np.asarray(lay.at + 0.5 * lay.allowance.length * lay.across)


def _one_line(a: BendMap, b: BendMap) -> bool:
    same = a.up == b.up and abs(a.angle - b.angle) < 1e-4 and abs(a.radius - b.radius) < 1e-4
    away = _middle(b) - _middle(a)
    return bool(
        same
        and abs(a.along[0] * b.along[1] - a.along[1] * b.along[0]) < 1e-6
        and abs(a.along[0] * away[1] - a.along[1] * away[0]) < _COLLINEAR
    )


def _lines(flat: Unfolded, place: int, lay: BendMap) -> list[Floats]:
    """Where the middle of a bend lies on the sheet: crossings with the boundary of the bend, in pairs."""
    middle, places = _middle(lay), list[float]()
    for k in flat.skin.patches[place].edges:
        x = lay(flat.skin.solid.edges[k].points) - middle
        s, h = x @ lay.along, x @ lay.across
        for i in np.flatnonzero((h[:-1] > 0.0) != (h[1:] > 0.0)).tolist():
            places.append(float(s[i] - h[i] * (s[i + 1] - s[i]) / (h[i + 1] - h[i])))
    ends = np.sort(places)
    return [np.array([middle + a * lay.along, middle + b * lay.along]) for a, b in zip(ends[::2], ends[1::2])]

"""Reject sheets that overlap at the start, and faces that do not look at each other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue, ModelError
from umform.mesh import Ids, Mesh
from umform.mesh.part import sheets_of
from umform.model.contact.encounter import sheet_thickness
from umform.model.contact.sheets.pair import SheetContact
from umform.surfaces.directions import coordinates

Floats = NDArray[np.float64]

#: Overlap at the start that is refused, that of sheets which go through each other, and how deep it is looked for, in
#: thicknesses of the thinner sheet.
_OVERLAP, _THROUGH, _LOOK = 0.1, 0.85, 0.95
#: Cosine between the normals of two faces from which they look the same way.
_SAME_WAY = 0.5
#: Overlap that is left after a translation, in thicknesses, and steps to find that.
_TOUCHING, _TRIALS = 1e-9, 20


def check_overlap(contact: SheetContact, u: Floats) -> None:
    """Reject sheets that overlap at a displacement by more than a tenth of their thickness, or go through each other.

    Raises
    ------
    ModelError
        With the deepest place, and the translation that removes the overlap.
    """
    found, x = _deepest(contact, u), contact.points_at(u)
    crossed = contact.crossed((contact.opposite_at(u), x), (x, x), _OVERLAP * contact.thickness)
    if crossed is not None and not _OVERLAP < found.depth / contact.thickness < _THROUGH:
        alone = len(contact.sides) == 1
        raise ModelError(
            "a sheet goes through itself at the start" if alone else "a sheet goes through another at the start",
            where=f"contact {contact.name}, near {coordinates(crossed[0])}",
            value=f"a fibre through its thickness ends {crossed[1]:.4g} behind the other face",
            cause="a fold with too small a radius or too long a flank" if alone else "parts laid into each other",
            remedy="open the fold, or shorten the flank" if alone else "move one of them until the faces just touch",
        )
    if found.depth > _OVERLAP * contact.thickness:
        raise ModelError(
            "two sheets overlap at the start",
            where=f"contact {contact.name}, near {coordinates(found.x)}",
            value=f"{found.depth:.4g} deep, the thinner sheet is {contact.thickness:.4g} thick",
            cause="a mid-surface in place of a face, another thickness, or a part that was laid in the wrong place",
            remedy=f"{_way_out(contact, u)}, or start with a gap",
        )


@dataclass(frozen=True)
class _Overlap:
    """The deepest place: how deep, where, normal out of the other side, and the side that it belongs to."""

    depth: float
    x: Floats
    normal: Floats
    side: int


def _deepest(contact: SheetContact, u: Floats) -> _Overlap:
    worst = _Overlap(0.0, np.zeros(3), np.zeros(3), 0)
    for side, found in enumerate(contact.looked(u, _LOOK)):
        gap = np.where(np.isnan(found["gap"]), 0.0, found["gap"])
        if gap.size and -gap.min() > worst.depth:
            at = int(gap.argmin())
            worst = _Overlap(float(-gap[at]), found["x"][at], found["normal"][at], side)
    return worst


def _way_out(contact: SheetContact, u: Floats) -> str:
    """The translation of one of two sheets after which they do not overlap, as a remedy."""
    apart = "move one of them until the faces just touch"
    if len(contact.sides) == 1 or (nodes := contact.nodes_of_sheets(1)) is None:
        return apart
    moved, way = u.reshape(-1, 3).copy(), np.zeros(3)
    for _ in range(_TRIALS):
        found = _deepest(contact, moved.ravel())
        if found.depth <= _TOUCHING * contact.thickness:
            return f"move the second sheet by {coordinates(way)}"
        step = found.depth * found.normal * (1.0 if found.side == 1 else -1.0)
        way += step
        moved[nodes] += step
    return apart


def check_facing(mesh: Mesh, at: Floats, sides: tuple[Ids, Ids], where: str) -> None:
    """Reject faces of two sheets that lie close to each other and look the same way, or away from each other.

    The nodes are at positions (n, 3).

    Raises
    ------
    InvalidValue
        If all faces of the first set that are within their size of the second one do.
    """
    from scipy.spatial import cKDTree  # slow to import

    centres, normals, sizes = zip(*(_middles(at[mesh.facets_of(side)[:, :4]]) for side in sides), strict=True)
    sheet = sheets_of(mesh)
    if np.intersect1d(sheet[sides[0][:, 0]], sheet[sides[1][:, 0]]).size:  # a fold, or a coil: its shape says nothing
        return
    behind = _LOOK * min(sheet_thickness(mesh, side) for side in sides)
    distance, other = cKDTree(centres[1]).query(centres[0])
    close = distance <= 0.5 * (sizes[0] + sizes[1][other])
    way, normal, opposite = (centres[1][other] - centres[0])[close], normals[0][close], normals[1][other][close]
    near = int(close.sum())
    same = int((np.einsum("ij,ij->i", normal, opposite) > _SAME_WAY).sum())
    away = int((np.einsum("ij,ij->i", way, normal) < -behind).sum())
    if near and same == near:
        raise InvalidValue(
            "two faces in contact look the same way, so that they never touch",
            where=where,
            value=f"{near} faces near each other, all of which do",
            cause="the upper faces of both sheets, or the lower ones; or a sheet whose cells are numbered upside down",
            remedy="the upper faces of the one below with the lower faces of the one above",
        )
    if near and away == near:
        raise InvalidValue(
            "two faces in contact look away from each other, so that they never touch",
            where=where,
            value=f"{near} faces near each other, all of which do",
            cause="the outer faces of a stack in place of the inner ones, or the sheets in the wrong order",
            remedy="the upper faces of the one below with the lower faces of the one above",
        )


def _middles(corners: Floats) -> tuple[Floats, Floats, Floats]:
    """Centres, unit normals and longest diagonals of facets (k, 4, 3)."""
    one, other = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    normal = np.cross(one, other)
    size = np.maximum(np.linalg.norm(one, axis=1), np.linalg.norm(other, axis=1))
    return corners.mean(axis=1), normal / np.linalg.norm(normal, axis=1, keepdims=True), size

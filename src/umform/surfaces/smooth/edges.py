"""Connectivity of triangles: the neighbour across each edge; holes and flipped triangles are refused."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from umform.errors import HoleInSurface, TurnedFaces, UnfitTriangles
from umform.surfaces.joined import groups
from umform.surfaces.triangles import Floats, Ids, Triangles

#: Number of places that a message names.
_PLACES = 4
#: A triangle whose height is below this part of its longest edge is degenerate.
_FLAT = 1e-9
#: Cosine between the normals of two triangles beside each other from which one lies folded on the other.
_FOLDED = -0.985


@dataclass(frozen=True)
class Edges:
    """Edges of triangles, seen from each of them: edge e of triangle t has the number 3 t + e, from its corner e on.

    Attributes
    ----------
    start, end : ndarray of int, shape (3 m,)
        Points.
    mate : ndarray of int, shape (3 m,)
        The same edge seen from the other triangle, -1 at a rim.
    """

    start: Ids
    end: Ids
    mate: Ids


def connected(surface: Triangles, where: str, *, rims: bool = False) -> Edges:
    """Neighbours over the edges of triangles.

    Parameters
    ----------
    surface : Triangles
        Points and triangles; points that coincide must be one.
    where : str
        For messages.
    rims : bool
        Edges with a triangle on one side only are allowed.

    Raises
    ------
    UnfitTriangles
        If a triangle has no area, more than two meet in an edge, or the surface is folded on itself.
    TurnedFaces
        If two neighbours have their normals on different sides.
    HoleInSurface
        If the surface has a rim.
    """
    _refuse_lines(surface, where)
    start = surface.triangles.ravel()
    end = np.roll(surface.triangles, -1, axis=1).ravel()
    count = len(surface.points)
    keys = np.minimum(start, end) * count + np.maximum(start, end)
    order = np.argsort(keys, kind="stable")
    _, first, times = np.unique(keys[order], return_index=True, return_counts=True)
    middles = 0.5 * (surface.points[start] + surface.points[end])
    if times.max() > 2:
        at = order[first[times > 2]]
        raise UnfitTriangles(
            "more than two triangles meet in an edge",
            where=where,
            value=_places(middles[at], "edge"),
            cause="faces inside of the solid, or the same face twice",
            remedy="export the outer faces only, each of them once",
        )
    one, other = order[first[times == 2]], order[first[times == 2] + 1]
    mate = np.full(len(start), -1)
    mate[one], mate[other] = other, one
    if not rims and (mate < 0).any():  # before normals: faces around a hole have no orientation of their own
        _refuse_holes(surface.points, start[mate < 0], end[mate < 0], where)
    turned = start[one] == start[other]
    if turned.any():
        raise TurnedFaces(
            "triangles beside each other have their normals on different sides",
            where=where,
            value=_places(middles[one[turned]], "edge"),
            cause="faces whose normals were not unified before the export",
            remedy="unify the normals in the program that wrote the file: out of the tool, towards the sheet",
        )
    _refuse_folds(surface, one // 3, other // 3, middles[one], where)
    return Edges(start, end, mate)


def _refuse_lines(surface: Triangles, where: str) -> None:
    """Reject triangles without area."""
    corners = surface.corners
    longest = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2).max(axis=1)
    flat = 2.0 * np.linalg.norm(surface.area_vectors, axis=1) <= _FLAT * longest**2
    if flat.any():
        raise UnfitTriangles(
            "a triangle has no area",
            where=where,
            value=_places(corners[flat].mean(axis=1), "triangle"),
            cause="needles of a tessellation, or points that coincide",
            remedy="export again with a smaller chord error, or repair the triangles",
        )


def _refuse_folds(surface: Triangles, one: Ids, other: Ids, middles: Floats, where: str) -> None:
    """Reject triangles that lie on their neighbour: beyond the fold the surface faces away from the sheet."""
    n = surface.area_vectors
    n = n / np.linalg.norm(n, axis=1, keepdims=True)
    folded = np.einsum("ei,ei->e", n[one], n[other]) < _FOLDED
    if folded.any():
        raise UnfitTriangles(
            "the surface is folded: triangles lie on their neighbours and face the other way",
            where=where,
            value=_places(middles[folded], "edge"),
            cause="a section swept along a curve, or an offset, that is wider than the radius of the curve",
            remedy="make the surface narrower on the inner side of the curve, or remove the folded part",
        )


def _refuse_holes(points: Floats, start: Ids, end: Ids, where: str) -> None:
    """Reject rims, with the place and the length of each."""
    used, ids = np.unique(np.concatenate([start, end]), return_inverse=True)
    one, other = ids[: len(start)], ids[len(start) :]
    rims, label = groups(one, other, len(used))
    length = np.bincount(label[one], np.linalg.norm(points[end] - points[start], axis=1), rims)
    sums = np.stack([np.bincount(label, points[used, k], rims) for k in range(3)], axis=1)
    middle = sums / np.bincount(label, minlength=rims)[:, None]
    longest = np.argsort(-length, kind="stable")
    edges = np.bincount(label[one], minlength=rims)
    named = [
        f"rim of length {length[i]:.6g}, {edges[i]} open edges, around {_point(middle[i])}" for i in longest[:_PLACES]
    ]
    more = f" and {rims - _PLACES} more" if rims > _PLACES else ""
    raise HoleInSurface(
        "the surface of a tool must be closed",
        where=where,
        value="; ".join(named) + more,
        cause="a hole, a missing face, a gap between faces, or a die face without the block below it",
        remedy="close the surface, weld within a larger distance, or say open=True: the tool then ends at its rims",
    )


def _places(at: Floats, what: str) -> str:
    """The first places of a list, and their number."""
    named = ", ".join(_point(x) for x in at[:_PLACES])
    return f"{len(at)} {what}{'s' if len(at) > 1 else ''}, at {named}{', ...' if len(at) > _PLACES else ''}"


def _point(x: Floats) -> str:
    return "(" + ", ".join(f"{c:.6g}" for c in x) + ")"

"""Faces of sheets in contact: their depth, and which of them lie next to each other in one sheet."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.mesh import Ids, Mesh
from umform.mesh.neighbours import outer_faces
from umform.mesh.numbers import median
from umform.mesh.part import sheets_of
from umform.model.contact.encounter import sheet_thickness

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]

#: Way along a sheet within which its faces touch only if they are turned towards each other, in thicknesses.
ARC = 2.0
#: Most layers of elements of a sheet; a body with more is solid.
SHEET_LAYERS = 4


@dataclass(frozen=True)
class Depth:
    """How deep a body is behind its faces in contact.

    Attributes
    ----------
    thickness : float
        Thickness of a sheet; of a solid body that of as many layers at the face as a sheet has at most.
    reach : float
        The same of a sheet; of a solid body that of four times as many layers: a place within half of it may penetrate.
    layer : float
        Thickness of the layer at the face.
    solid : bool
        Whether it has more layers than a sheet: it deforms near the contact, not across its thickness.
    """

    thickness: float
    reach: float
    layer: float
    solid: bool


def depth_of(mesh: Mesh, faces: Ids) -> Depth:
    """Depth of the bodies that some faces, rows (cell, face), belong to; of several the smallest."""
    sheet, half = sheets_of(mesh), mesh.connectivity.shape[1] // 2
    found = []
    for one in np.unique(sheet[faces[:, 0]]):
        of_one = faces[sheet[faces[:, 0]] == one]
        whole = sheet_thickness(mesh, of_one)
        nodes = mesh.points[mesh.connectivity[of_one[:, 0]]]
        layer = median(np.linalg.norm(nodes[:, half:] - nodes[:, :half], axis=-1))
        solid = whole > (SHEET_LAYERS + 0.5) * layer
        few, many = (min(whole, layers * layer) if solid else whole for layers in (SHEET_LAYERS, 4 * SHEET_LAYERS))
        found.append(Depth(few, many, layer, solid))
    return min(found, key=lambda depth: depth.thickness)


def cut_edges(mesh: Mesh, faces: Ids) -> tuple[Ids, Ids]:
    """Edges of faces where their sheet ends, in rows.

    Returns
    -------
    ndarray of int32, shape (k, 4 or 6)
        Nodes of the edge, ends first, then those across the thickness of the sheet.
    ndarray of int32, shape (k, 2)
        Row of the face and its side: from its corner k to corner k + 1.
    """
    outer = outer_faces(mesh.connectivity)
    key, once = np.unique(
        _sides(np.concatenate([mesh.facets_of(rows) for rows in outer.values()])), axis=0, return_counts=True
    )
    ends = {tuple(side) for side in key[once == 1].tolist()}
    facets = mesh.facets_of(faces)
    cut = np.array([tuple(side) in ends for side in _sides(facets).tolist()], dtype=bool).reshape(-1, 4)
    row, side = np.nonzero(cut)
    nodes = [facets[row, side], facets[row, (side + 1) % 4]]
    if facets.shape[1] > 4:
        nodes.append(facets[row, 4 + side])
    own = np.stack(nodes, axis=1)
    across = np.where(faces[row, 1:] == 0, _through(mesh, own, up=True), _through(mesh, own, up=False))
    return (
        np.ascontiguousarray(np.concatenate([own, across], axis=1), dtype=np.int32),
        np.stack([row, side], axis=1).astype(np.int32),
    )


def _sides(facets: Ids) -> Ids:
    """Ends of the four sides of each facet, the smaller first; shape (4 k, 2)."""
    corners = facets[:, :4]
    return np.sort(np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)


def _through(mesh: Mesh, nodes: Ids, *, up: bool) -> Ids:
    """The last nodes of the fibres that begin at some nodes."""
    half = mesh.connectivity.shape[1] // 2
    lower, upper = mesh.connectivity[:, :half], mesh.connectivity[:, half:]
    following = np.arange(len(mesh.points), dtype=np.int32)
    following[lower if up else upper] = upper if up else lower
    while not np.array_equal(nodes, onward := following[nodes]):
        nodes = onward
    return nodes


def near_in_the_sheet(mesh: Mesh, faces: Ids, others: Ids, way: float) -> list[list[int]]:
    """For each face the rows of the other ones whose cells are within a way along the sheet, ascending.

    Parameters
    ----------
    mesh : Mesh
        The sheets.
    faces, others : ndarray of int, shapes (k, 2) and (m, 2)
        Rows (cell, face).
    way : float
        Sum of the distances between the centres of neighbouring cells.
    """
    source, cell = _within(mesh, np.unique(faces[:, 0]), way)
    order = np.argsort(others[:, 0], kind="stable")
    first, last = (np.searchsorted(others[order, 0], cell, side) for side in ("left", "right"))
    rows: dict[int, list[int]] = {}
    for one, begin, end in zip(source.tolist(), first.tolist(), last.tolist(), strict=True):
        rows.setdefault(one, []).extend(order[begin:end].tolist())
    return [sorted(rows.get(int(one), [])) for one in faces[:, 0]]


def _within(mesh: Mesh, cells: Numbers, way: float) -> tuple[Numbers, Numbers]:
    """Pairs of cells that are within a way of each other, from some cells on; each with itself."""
    first, neighbours = _neighbours(mesh)
    centres, count = mesh.points[mesh.connectivity].mean(axis=1), len(mesh.connectivity)
    known = {int(pair): 0.0 for pair in cells.astype(np.int64) * count + cells}
    source, at, distance = cells.astype(np.int64), cells.astype(np.int64), np.zeros(len(cells))
    while len(source):
        many = first[at + 1] - first[at]
        behind = np.repeat(np.arange(len(at)), many)
        step = np.arange(len(behind)) - np.repeat(np.cumsum(many) - many, many)
        onward = neighbours[first[at[behind]] + step]
        far = distance[behind] + np.linalg.norm(centres[onward] - centres[at[behind]], axis=1)
        better = np.flatnonzero(far <= way)
        fresh: dict[int, float] = {}
        for pair, length in zip(
            (source[behind[better]] * count + onward[better]).tolist(), far[better].tolist(), strict=True
        ):
            if length < min(known.get(pair, np.inf), fresh.get(pair, np.inf)):
                fresh[pair] = length
        known |= fresh
        pairs = np.fromiter(fresh.keys(), dtype=np.int64, count=len(fresh))
        source, at = np.divmod(pairs, count)
        distance = np.fromiter(fresh.values(), dtype=float, count=len(fresh))
    every = np.sort(np.fromiter(known.keys(), dtype=np.int64, count=len(known)))
    return tuple(np.divmod(every, count))  # type: ignore[return-value]


def _neighbours(mesh: Mesh) -> tuple[Numbers, Numbers]:
    """Cells that share a node with each cell: where those of a cell begin, and their numbers."""
    cells = mesh.connectivity
    count, nodes = cells.shape
    node, cell = cells.ravel(), np.repeat(np.arange(count), nodes)
    order = np.argsort(node, kind="stable")
    node, cell = node[order], cell[order]
    many = np.bincount(node, minlength=len(mesh.points))
    start = np.cumsum(many) - many
    one = np.repeat(np.arange(len(node)), many[node])
    other = start[node[one]] + np.arange(len(one)) - np.repeat(np.cumsum(many[node]) - many[node], many[node])
    pairs = np.unique(cell[one].astype(np.int64) * count + cell[other])
    left, right = np.divmod(pairs, count)
    return np.searchsorted(left, np.arange(count + 1)), right

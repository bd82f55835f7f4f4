"""Surfaces of quadrilaterals: consistent orientation, and normals at the nodes."""

from __future__ import annotations

import numpy as np

from umform import _core
from umform.errors import InvalidValue, MeshError
from umform.mesh.mesh import FACE_NODES, Floats
from umform.mesh.neighbours import Whole, connected, place, shared_sides

#: Nodes of a reversed quadrilateral of 4, 8 or 9 nodes.
TURNED = {4: [0, 3, 2, 1], 8: [0, 3, 2, 1, 7, 6, 5, 4], 9: [0, 3, 2, 1, 7, 6, 5, 4, 8]}


def alike(points: Floats, quads: Whole) -> Whole:
    """Orient quadrilaterals so that neighbours have the same side up.

    Each connected part keeps the orientation of most of its quadrilaterals.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        Positions.
    quads : ndarray of int, shape (m, 4), (m, 8) or (m, 9)
        Corners first.

    Returns
    -------
    ndarray of int
        The same quadrilaterals, some of them reversed.

    Raises
    ------
    MeshError
        If an edge has more than two quadrilaterals, or the surface is one-sided, as a Möbius strip.
    """
    edges = np.stack([quads[:, :4], np.roll(quads[:, :4], -1, axis=1)], axis=2).reshape(-1, 2)
    pairs = shared_sides(points, edges, "edge")
    same_way = edges[pairs[:, 0], 0] == edges[pairs[:, 1], 0]  # consistent neighbours run in opposite directions
    sign = _signs(len(quads), pairs // 4, np.where(same_way, -1, 1))
    wrong = np.flatnonzero(sign[pairs[:, 0] // 4] * sign[pairs[:, 1] // 4] != np.where(same_way, -1, 1))
    if wrong.size:
        both = np.sort(pairs[wrong[0]] // 4)
        raise MeshError(
            "the surface has one side only",
            where=f"{place(points[edges[pairs[wrong[0], 0]]])}, quadrilaterals {both.tolist()}",
            cause="it is closed with a twist, as the band of Moebius",
            remedy="cut the surface along a line",
        )
    return np.where(sign[:, None] < 0, quads[:, TURNED[quads.shape[1]]], quads)


def _signs(count: int, links: Whole, relation: Whole) -> Whole:
    """Breadth-first search over the neighbours: 1 as given, -1 reversed; in each part most are kept."""
    from scipy.sparse import coo_array  # slow to import
    from scipy.sparse.csgraph import breadth_first_order

    a, b = links.T
    graph = coo_array((np.ones(len(a)), (a, b)), shape=(count, count)).tocsr()
    between = {(int(i), int(j)): int(r) for i, j, r in zip(a, b, relation)}
    between |= {(j, i): r for (i, j), r in between.items()}
    part = connected(count, links)
    sign = np.ones(count, dtype=int)
    for label in range(part.max() + 1):
        members = np.flatnonzero(part == label)
        order, before = breadth_first_order(graph, int(members[0]), directed=False)
        for k in order[1:]:
            sign[k] = sign[before[k]] * between[int(before[k]), int(k)]
        if sign[members].sum() < 0:
            sign[members] *= -1
    return sign


def directors(points: Floats, quads: Whole, kink: float) -> Floats:
    """Vectors at the nodes along which a surface of unit thickness is thickened.

    The normals of the quadrilaterals at a node are averaged, weighted by their angles at the node. The mean normal is
    scaled so that the mean distance along the normals of the quadrilaterals is one: at a kink between two of them it is
    one on both sides (a mitre).

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        Positions; every one belongs to a quadrilateral.
    quads : ndarray of int, shape (m, 4) or (m, 9)
        Consistently oriented.
    kink : float
        Largest angle in degrees between two quadrilaterals that meet in a node, measured as twice the angle from the
        mean normal.

    Returns
    -------
    ndarray, shape (n, 3)

    Raises
    ------
    InvalidValue
        If a kink is sharper.
    MeshError
        If a quadrilateral has no normal at one of its nodes.
    """
    count = quads.shape[1]
    natural = np.column_stack([FACE_NODES[:count], np.full(count, -1.0)])
    dN = np.asarray(_core.shell_functions(2 * count, natural)[1])[:, :2, :count]
    tangents = np.einsum("qia,eak->eqik", dN, points[quads])
    normal = np.cross(tangents[:, :, 0], tangents[:, :, 1])
    sizes = np.linalg.norm(tangents, axis=3).prod(axis=2)
    area = np.linalg.norm(normal, axis=2)
    if (area <= 1e-9 * sizes).any():
        quad = int(np.flatnonzero((area <= 1e-9 * sizes).any(axis=1))[0])
        raise MeshError(
            "a quadrilateral has no normal in one of its nodes",
            where=f"quadrilateral {quad}, {place(points[quads[quad]])}",
            cause="two nodes at the same place, or two sides on one line",
            remedy="look at the nodes of this quadrilateral",
        )
    normal /= area[..., None]
    angle = np.arctan2(area, np.einsum("eqk,eqk->eq", tangents[:, :, 0], tangents[:, :, 1]))
    # the angle between r and s; if only one of them reverses at the corner, its supplement
    weight = np.where(FACE_NODES[:count].prod(axis=1) < 0, np.pi - angle, angle)
    weight[:, 4:8] = np.pi
    mean = np.zeros_like(points)
    np.add.at(mean, quads, weight[..., None] * normal)
    mean /= np.maximum(np.linalg.norm(mean, axis=1), 1e-300)[:, None]
    cosine = np.einsum("eqk,eqk->eq", normal, mean[quads])
    _check_kinks(points, quads, cosine, kink)
    total, along = np.zeros(len(points)), np.zeros(len(points))
    np.add.at(total, quads, weight)
    np.add.at(along, quads, weight * cosine)
    return np.asarray(mean * (total / along)[:, None])


def _check_kinks(points: Floats, quads: Whole, cosine: Floats, kink: float) -> None:
    """Reject a kink that is too sharp for a mitre."""
    sharpest = np.unravel_index(np.argmin(cosine), cosine.shape)
    angle = 2.0 * np.degrees(np.arccos(np.clip(cosine[sharpest], -1.0, 1.0)))
    if angle > kink:
        node = int(quads[sharpest])
        raise InvalidValue(
            "the surface has a kink that is too sharp to be thickened",
            where=f"node {node}, {place(points[[node]])}",
            value=f"{angle:.1f} degrees, allowed {kink:g}",
            cause="a sharp fold, or two sheets that touch in one node",
            remedy="round the fold and mesh it with several elements, or allow a larger kink",
        )

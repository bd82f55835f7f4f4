"""Bond sheets of one mesh: clad metal, a foil that sticks, a patch, a welded blank."""

from __future__ import annotations

import numpy as np

from umform.errors import InvalidValue
from umform.mesh.mesh import Floats, Mesh, Selector, nodes_of_faces
from umform.mesh.neighbours import Whole, place
from umform.mesh.numbers import unique

#: Tolerance of coinciding nodes, relative to the smallest distance between nodes of the face.
_NEAR = 1e-3


def bond(mesh: Mesh, faces: Selector, others: Selector) -> Mesh:
    """Bond two sheets: the nodes of a face become those of the other sheet at the same places.

    Parameters
    ----------
    mesh : Mesh
        Sheets of :func:`umform.mesh.together` that touch.
    faces : str, callable or array_like
        Faces of one sheet, see :meth:`umform.Mesh.face_set`.
    others : str, callable or array_like
        Faces of the other one. Each lies on one of those, node on node.

    Returns
    -------
    Mesh
        The sets keep their names. Bonded faces lie inside: they leave the sets of faces, and a set of nothing else is
        one of nodes.

    Raises
    ------
    InvalidValue
        If a face has no partner, or they do not look at each other.

    Examples
    --------
    >>> import umform as uf
    >>> strip = uf.mesh.strip(length=10.0, width=1.0, thickness=0.2, cells=(8, 1))
    >>> stack = uf.mesh.together(a=strip, b=strip.moved((0.0, 0.0, 0.2)))
    >>> clad = uf.mesh.bond(stack, "upper of a", "lower of b")
    >>> len(clad.points), "upper of a" in clad.faces, "upper of a" in clad.sets
    (54, False, True)
    """
    first, second = mesh.face_set(faces), mesh.face_set(others)
    number, left = _numbers(mesh, mesh.nodes_on(first), mesh.nodes_on(second))
    cells, points = number[mesh.connectivity], mesh.points[left]
    bonded = _corners(cells, second)
    partner = _partners(_corners(cells, first), bonded)
    if (partner < 0).any():
        raise _unmatched(points[bonded[partner < 0][0]], "these nodes belong to several faces of the other sheet")
    _check_sides(points, cells, first[partner], second)
    sets, outer = {name: unique(number[ids]) for name, ids in mesh.sets.items()}, {}
    for name, rows in mesh.faces.items():
        free = _partners(bonded, _corners(cells, rows)) < 0
        if free.any():
            outer[name] = rows[free]
        else:
            sets[name] = unique(number[mesh.nodes_on(rows)])
    return Mesh(points, {mesh.cell: cells}, sets, outer)


def _numbers(mesh: Mesh, kept: Whole, moved: Whole) -> tuple[Whole, Whole]:
    """New number of each node, and the nodes that are left, when some become others at the same places."""
    from scipy.spatial import cKDTree  # slow to import

    tree, at = cKDTree(mesh.points[kept]), mesh.points[moved]
    distance, partner = tree.query(at)
    if (distance > _NEAR * tree.query(mesh.points[kept], k=2)[0][:, 1].min()).any():
        far = int(distance.argmax())
        raise _unmatched(at[far : far + 1], f"the next node is {distance[far]:.3g} away")
    same = np.arange(len(mesh.points))
    same[moved] = kept[partner]
    left, number = np.unique(same, return_inverse=True)
    return number.ravel(), left


def _check_sides(points: Floats, cells: Whole, first: Whole, second: Whole) -> None:
    """Refuse cells on the same side of their common face, and sheets that are turned over."""
    middle = points[_corners(cells, second)].mean(axis=1)
    sides = [points[cells[rows[:, 0]]].mean(axis=1) - middle for rows in (first, second)]
    over = np.einsum("ni,ni->n", *sides) >= 0.0
    turned = (np.minimum(first[:, 1], second[:, 1]) < 2) & (first[:, 1] + second[:, 1] != 1)
    if over.any() or turned.any():
        raise InvalidValue(
            "bonded faces look at each other, an upper one at a lower one",
            where=place(middle[over | turned][:1]),
            value="both cells lie on one side" if over.any() else "one of the sheets is turned over",
            cause="a face bonded to itself, sheets in the same place, or two upper faces",
            remedy='bond(mesh, "upper of a", "lower of b"), with b above a',
        )


def _corners(cells: Whole, rows: Whole) -> Whole:
    """Corners of faces (cell, number of the face), ascending; shape (k, 4)."""
    corners, half = np.array(nodes_of_faces("hex8")), cells.shape[1] // 2
    local = corners % 4 + half * (corners // 4)
    return np.sort(cells[rows[:, :1], local[rows[:, 1]]], axis=1)


def _partners(some: Whole, others: Whole) -> Whole:
    """For each of other rows that of some which is equal; -1: none."""
    number = np.unique(np.concatenate([some, others]), axis=0, return_inverse=True)[1].ravel()
    at = np.full(len(number), -1)
    at[number[: len(some)]] = np.arange(len(some))
    return at[number[len(some) :]]


def _unmatched(points: Floats, found: str) -> InvalidValue:
    return InvalidValue(
        "bonded faces have the same nodes",
        where=place(points),
        value=found,
        cause="other lines of elements, or a gap between the sheets",
        remedy="the same lines of elements for both; or sheet_contact, which does not bond",
    )

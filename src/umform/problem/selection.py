"""Selections of nodes or faces: a set of the mesh, a box, the nearest one, ids, or an intersection."""

from __future__ import annotations

from functools import reduce
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from umform.errors import EmptySet, InvalidValue
from umform.mesh import Ids, Mesh
from umform.problem.notes import Discriminator, Field, Tag
from umform.problem.parts import Part, Vector

#: Thickness added to planes of a box, as a fraction of the size of the mesh.
_HAIR = 1e-7

Bound = Annotated[float, Field(allow_inf_nan=True)]
Corner = tuple[float, float, float]


def nodes_of(mesh: Mesh, selection: Selection) -> Ids:
    """Node ids of a selection; an empty one is refused."""
    if isinstance(selection, str):
        return mesh.nodes(selection)
    return _not_empty(selection.nodes(mesh), "node")


def faces_of(mesh: Mesh, selection: Selection) -> Ids:
    """Rows (cell, number of the face) of a selection; an empty one is refused."""
    if isinstance(selection, str):
        return mesh.face_set(selection)
    return _not_empty(selection.faces(mesh), "face")


def sets_in(selection: Selection) -> set[str]:
    """Names of the sets that a selection lies in."""
    if isinstance(selection, str):
        return {selection}
    return set().union(*map(sets_in, selection.intersection)) if isinstance(selection, Intersection) else set()


def _not_empty(ids: Ids, kind: str) -> Ids:
    if len(ids) == 0:
        raise EmptySet(
            f"this selects no {kind}",
            cause="a box beside the sheet, or sets that have nothing in common",
            remedy="look at the coordinates of the mesh: the strip lies at z = -thickness/2 ... thickness/2",
        )
    return ids


class Box(Part):
    """All that lies in a box; of faces those whose nodes all do, without faces between two cells."""

    min: Annotated[list[Bound], Field(min_length=3, max_length=3)] | None = None
    """Lowest corner; -inf leaves a side open."""
    max: Annotated[list[Bound], Field(min_length=3, max_length=3)] | None = None
    """Highest corner; inf leaves a side open."""

    def __post_init__(self) -> None:
        """Refuse corners in the wrong order."""
        lowest, highest = np.array(self.min or [-np.inf] * 3), np.array(self.max or [np.inf] * 3)
        if not (lowest <= highest).all():
            raise InvalidValue(
                "the lowest corner of a box must lie below its highest one",
                value=f"min = {self.min}, max = {self.max}",
                cause="the two exchanged, or a sign",
                remedy="in each direction min <= max; -inf and inf leave a side open",
            )

    def _inside(self, mesh: Mesh) -> NDArray[np.bool_]:
        hair = _HAIR * float(np.ptp(mesh.points, axis=0).max())
        inside = np.ones(len(mesh.points), dtype=bool)
        if self.min is not None:
            inside &= (mesh.points >= np.array(self.min) - hair).all(axis=1)
        if self.max is not None:
            inside &= (mesh.points <= np.array(self.max) + hair).all(axis=1)
        return inside

    def nodes(self, mesh: Mesh) -> Ids:
        """Ids of the nodes."""
        return np.flatnonzero(self._inside(mesh)).astype(np.int32)

    def faces(self, mesh: Mesh) -> Ids:
        """Rows of the faces."""
        return mesh.face_set(lambda x, y, z: self._inside(mesh))


class Nearest(Part):
    """The node, or the face by the mean of its corners, nearest to a point."""

    nearest: Vector
    """The point."""

    def nodes(self, mesh: Mesh) -> Ids:
        """Id of the node."""
        return np.array([_nearest(mesh.points, self.nearest)], dtype=np.int32)

    def faces(self, mesh: Mesh) -> Ids:
        """Row of the face."""
        rows = mesh.face_set(lambda x, y, z: True)
        return rows[[_nearest(mesh.face_centres(rows), self.nearest)]]


class ById(Part):
    """Nodes by number, from 0; faces as pairs of cell and number of the face (0 lower, 1 upper)."""

    ids: Annotated[list[Any], Field(min_length=1)]
    """Numbers, or pairs of numbers."""

    def nodes(self, mesh: Mesh) -> Ids:
        """Ids of the nodes."""
        return mesh.nodes(self.ids)

    def faces(self, mesh: Mesh) -> Ids:
        """Rows of the faces."""
        return mesh.face_set(self.ids)


class Intersection(Part):
    """Intersection of several selections."""

    intersection: Annotated[list[Selection], Field(min_length=1)]
    """The selections."""

    def nodes(self, mesh: Mesh) -> Ids:
        """Ids of the nodes."""
        return reduce(np.intersect1d, [nodes_of(mesh, part) for part in self.intersection])

    def faces(self, mesh: Mesh) -> Ids:
        """Rows of the faces."""
        sets = [{(int(cell), int(face)) for cell, face in faces_of(mesh, part)} for part in self.intersection]
        return np.array(sorted(set.intersection(*sets)), dtype=np.int32).reshape(-1, 2)


def _nearest(points: NDArray[np.float64], to: Corner) -> int:
    return int(np.argmin(((points - np.array(to)) ** 2).sum(axis=1)))


_KEYS = {"min": "box", "max": "box", "nearest": "nearest", "ids": "ids", "intersection": "intersection"}


def _kind(value: Any) -> str | None:
    """Discriminator: the keys of a selection."""
    if isinstance(value, str):
        return "set"
    if isinstance(value, dict):
        return next((kind for key, kind in _KEYS.items() if key in value), None)
    kinds = ((Box, "box"), (Nearest, "nearest"), (ById, "ids"), (Intersection, "intersection"))
    return next((kind for part, kind in kinds if isinstance(value, part)), None)


Selection = Annotated[
    Annotated[str, Tag("set")]
    | Annotated[Box, Tag("box")]
    | Annotated[Nearest, Tag("nearest")]
    | Annotated[ById, Tag("ids")]
    | Annotated[Intersection, Tag("intersection")],
    Discriminator(
        _kind,
        custom_error_type="selection",
        custom_error_message="Input should be the name of a set, or a table with one of the keys "
        "min, max, nearest, ids, intersection",
    ),
]

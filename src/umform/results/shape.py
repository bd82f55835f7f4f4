"""The deformed sheet as a surface of quadrilaterals with values, ready to be drawn."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from umform.mesh import Mesh
    from umform.results.history import History

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]

# Quadrilaterals of the lower face of a cell; those of the upper face follow half of the nodes later.
_PARTS = {
    8: np.array([[0, 1, 2, 3]]),
    18: np.array([[0, 4, 8, 7], [4, 1, 5, 8], [8, 5, 2, 6], [7, 8, 6, 3]]),
}
# Faces of a hexahedron, seen from outside: counter-clockwise.
_SIDES = np.array([[0, 3, 2, 1], [4, 5, 6, 7], [0, 4, 7, 3], [1, 2, 6, 5], [0, 1, 5, 4], [3, 7, 6, 2]])


@dataclass(frozen=True)
class Shape:
    """Outer faces of the deformed cells.

    Attributes
    ----------
    points : ndarray, shape (n, 3)
        Current positions.
    quads : ndarray of int, shape (k, 4)
        Points of the outer faces, counter-clockwise from outside; faces of 18-node cells come in parts.
    values : dict of str to ndarray, shape (k,)
        Fields on the faces.
    """

    points: Floats
    quads: Ids
    values: dict[str, Floats]

    @classmethod
    def of(cls, result: History, frame: int = -1) -> Shape:
        """Shape of a frame of a result, with its scalar fields; without any frame, the last converged state."""
        mesh = result.model.mesh
        if not result.frames:
            return cls.displaced(mesh, result.model.u.reshape(-1, 3))
        quads, owners = outer_quads(mesh.connectivity.astype(np.int64))
        kept = result.frames[frame]
        values = {name: field[owners] for name, field in kept.cells.items() if field.ndim == 1}
        values |= {name: field[quads].mean(axis=1) for name, field in kept.points.items() if field.ndim == 1}
        return cls(mesh.points + kept.points["displacement"], quads, values)

    @classmethod
    def displaced(cls, mesh: Mesh, u: Floats) -> Shape:
        """Shape of a mesh under displacements (n, 3), with their size as the field ``displacement``."""
        quads, _ = outer_quads(mesh.connectivity.astype(np.int64))
        return cls(mesh.points + u, quads, {"displacement": np.linalg.norm(u, axis=1)[quads].mean(axis=1)})

    def mirrored(self, axis: int) -> Shape:
        """The shape together with its mirror image at the plane through the origin normal to an axis."""
        sign = np.ones(3)
        sign[axis] = -1.0
        return replace(
            self,
            points=np.concatenate([self.points, sign * self.points]),
            quads=np.concatenate([self.quads, self.quads[:, ::-1] + len(self.points)]),
            values={name: np.tile(values, 2) for name, values in self.values.items()},
        )


def outer_quads(cells: Ids) -> tuple[Ids, Ids]:
    """Faces that belong to one cell only, as quadrilaterals.

    Parameters
    ----------
    cells : ndarray of int, shape (m, 8) or (m, 18)
        Node ids.

    Returns
    -------
    quads : ndarray of int, shape (k, 4)
        Counter-clockwise from outside; faces of 9 nodes come in four parts.
    owners : ndarray of int, shape (k,)
        Cell of each.
    """
    half = cells.shape[1] // 2
    parts = np.concatenate([_PARTS[2 * half], _PARTS[2 * half] + half], axis=1)
    faces = cells[:, parts][:, :, _SIDES].reshape(-1, 4)
    owners = np.repeat(np.arange(len(cells)), len(parts) * len(_SIDES))
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    outer = np.sort(first[count == 1])
    return faces[outer], owners[outer]

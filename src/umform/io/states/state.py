"""The state of a formed part as other programs take it: a mesh in its present shape with stresses."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]

#: Part of the size of a sheet within which a node is on a plane of symmetry.
_HAIR = 1e-7
#: Nodes of the mirror image of a quadrilateral and of a hexahedron: r and s change places.
_MIRRORED = {4: [0, 3, 2, 1], 8: [0, 3, 2, 1, 4, 7, 6, 5]}
#: Points of the mirror image of a hexahedron with eight of them.
_MIRRORED_POINTS = [0, 2, 1, 3, 4, 6, 5, 7]
#: Axes of the stress components 11 22 33 12 23 13.
AXES = ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))


@dataclass(frozen=True)
class FormedState:
    """Shells or solids in their present shape, with the state at their points.

    Points of a shell run from the lower to the upper face, those of a solid in r, then s, then t. The normal of a shell
    points to the upper face. Tensors have the order 11 22 33 12 23 13 in global axes; shear strains are those of the
    tensor, half of the engineering ones.

    Attributes
    ----------
    points : ndarray, shape (n, 3)
        Positions.
    cells : ndarray of int, shape (m, 4) or (m, 8)
        Nodes of shells or of solids, from 0.
    parts : ndarray of int, shape (m,)
        Number of the part of each cell, from 1.
    stress : ndarray, shape (m, q, 6)
        Cauchy stress.
    plastic : ndarray, shape (m, q)
        Accumulated plastic strain; zero for elastic laws.
    strain : ndarray, shape (m, q, 6), optional
        Logarithmic strain.
    thickness : ndarray, shape (m, 4), optional
        Thickness at the nodes of shells.
    heights : ndarray, shape (q,), optional
        Heights of the points of shells: -1 on the lower face, 1 on the upper face.
    history : ndarray, shape (m, h), optional
        Means of the state variables of the law in solids.
    variables : dict of str to int
        Names and sizes of the state variables.
    units : str
        Units, for the head of a file.
    """

    points: Floats
    cells: Ids
    parts: Ids
    stress: Floats
    plastic: Floats
    strain: Floats | None = None
    thickness: Floats | None = None
    heights: Floats | None = None
    history: Floats | None = None
    variables: dict[str, int] = field(default_factory=dict)
    units: str = ""

    @property
    def shells(self) -> bool:
        """Whether the cells are shells."""
        return bool(self.cells.shape[1] == 4)

    def of_part(self, number: int) -> Iterator[int]:
        """Rows of the cells of a part."""
        return (int(row) for row in np.flatnonzero(self.parts == number))

    def mirrored(self, axis: int, at: float) -> FormedState:
        """The part together with its mirror image; nodes in the plane are shared.

        State variables of laws are left out: their axes are those of the sheet.

        Parameters
        ----------
        axis : int
            Normal of the plane: 0, 1 or 2.
        at : float
            Its coordinate.
        """
        points, count = self.points.copy(), len(self.points)
        inside = np.abs(points[:, axis] - at) <= _HAIR * np.ptp(points, axis=0).max()
        points[inside, axis] = at
        number = np.where(inside, np.arange(count), count - 1 + np.cumsum(~inside))
        images = points[~inside]
        images[:, axis] = 2.0 * at - images[:, axis]
        sign = np.array([-1.0 if (i == axis) != (j == axis) else 1.0 for i, j in AXES])
        order = _MIRRORED_POINTS if self.stress.shape[1] == 8 and not self.shells else slice(None)

        def twice(values: Floats | None, factor: Floats | float = 1.0) -> Floats | None:
            return None if values is None else np.concatenate([values, factor * values[:, order]])

        thickness = self.thickness
        if thickness is not None:
            thickness = np.concatenate([thickness, thickness[:, _MIRRORED[4]]])
        stress, plastic = twice(self.stress, sign), twice(self.plastic)
        assert stress is not None and plastic is not None
        return replace(
            self,
            points=np.concatenate([points, images]),
            cells=np.concatenate([self.cells, number[self.cells[:, _MIRRORED[self.cells.shape[1]]]]]),
            parts=np.tile(self.parts, 2),
            stress=stress,
            plastic=plastic,
            strain=twice(self.strain, sign),
            thickness=thickness,
            history=None,
            variables={},
        )

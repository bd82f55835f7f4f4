"""The outer edge of a sheet of one layer of cells, in its blank and formed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.flat_pattern.net.star import Star
from umform.flat_pattern.one_step import mid_surface
from umform.mesh import Mesh
from umform.report.symmetry import Mirror, with_images

Floats = NDArray[np.float64]

#: Distance over the size within which a point lies in a plane of symmetry.
_HAIR = 1e-7


@dataclass(frozen=True, eq=False)
class Edge:
    """Points of the outer edge of a mid-surface, those of the modelled part.

    Attributes
    ----------
    ids : ndarray of int, shape (k,)
        Points of `mid_surface`, in their order around the centre.
    star : Star
        Their places in the blank.
    planes : sequence of Mirror
        Planes of symmetry across x and y.
    """

    ids: NDArray[np.int64]
    star: Star
    planes: Sequence[Mirror]

    @classmethod
    def of(cls, mesh: Mesh, planes: Sequence[Mirror]) -> Edge:
        """The edge of a flat blank without what lies in planes of symmetry.

        Raises
        ------
        InvalidValue
            If the sheet has several layers, or holes, or a ray from the middle meets its edge twice.
        """
        lower, upper = np.split(mesh.connectivity, 2, axis=1)
        if mesh.cell != "hex8" or np.isin(upper, lower).any():
            raise InvalidValue(
                "the outline of a blank is corrected for one layer of elements with 8 nodes",
                where="mesh",
                value=repr(mesh),
                cause="several layers, or elements with 18 nodes",
                remedy="layers = 1 and an element such as ANS3DEAS",
            )
        flat = mid_surface(mesh, np.zeros_like(mesh.points))
        x, across = flat.points[:, :2], [plane for plane in planes if plane.axis < 2]
        sides = np.sort(np.concatenate([flat.triangles[:, [a, b]] for a, b in ((0, 1), (1, 2), (2, 0))]), axis=1)
        sides, times = np.unique(sides, axis=0, return_counts=True)
        sides = sides[times == 1]
        hair = _HAIR * float(np.ptp(x, axis=0).max())
        for plane in across:
            sides = sides[(abs(x[sides, plane.axis] - plane.at) > hair).any(axis=1)]
        ids = np.unique(sides)
        centre = x[ids].mean(axis=0)
        for plane in across:
            centre[plane.axis] = plane.at
        away = x[ids] - centre
        ahead = np.arctan2(*away.mean(axis=0)[::-1])  # the middle of the modelled sector
        ids = ids[np.argsort(np.mod(np.arctan2(*away.T[::-1]) - ahead + np.pi, 2.0 * np.pi))]
        place = np.full(len(x), -1)
        place[ids] = np.arange(len(ids))
        gaps = abs(np.diff(place[sides], axis=1)).ravel()
        if ((gaps != 1) & (gaps != len(ids) - 1)).any():
            raise InvalidValue(
                "a ray from the middle of the blank meets its edge more than once",
                where="mesh",
                value=f"middle ({centre[0]:.4g}, {centre[1]:.4g})",
                cause="a hole, or a blank with arms",
                remedy="a blank without holes that is round or square on the whole; holes are pierced later",
            )
        return cls(ids, Star.of(x[ids], centre, "the edge of the blank"), across)

    def formed(self, mesh: Mesh, u: Floats) -> Floats:
        """Places of its points after displacements of the nodes, shape (k, 3)."""
        return np.asarray(mid_surface(mesh, u).points[self.ids])

    def whole(self, star: Star) -> Floats:
        """The whole closed outline of a star of the modelled part, shape (n, 2); the last point is the first."""
        x = with_images(np.c_[star.points[:, :2], np.zeros(len(star.points))], self.planes)[:, :2]
        angle = np.arctan2(*(x - star.centre).T[::-1])
        x = x[np.argsort(angle)]
        hair = _HAIR * float(np.ptp(x, axis=0).max())
        x = x[np.linalg.norm(x - np.roll(x, 1, axis=0), axis=1) > hair]
        return np.concatenate([x, x[:1]])

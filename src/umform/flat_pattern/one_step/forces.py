"""Forces that hold the sheet back: friction under a binder, restraint of the outer edge. eqs. (6.12), (6.13)"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.flat_pattern.one_step.equations import CORNERS
from umform.flat_pattern.one_step.part import Sheet
from umform.flat_pattern.one_step.strain import Formed, areas

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]

#: Displacement over the size of the part below which friction falls to zero.
_SMALL = 1e-3


@dataclass(frozen=True, eq=False)
class Friction:
    """Friction on triangles under a binder, against their displacement in its plane, z = constant.

    Attributes
    ----------
    triangles : ndarray of int, shape (b,)
        Triangles under the binder.
    force : ndarray, shape (b,)
        Largest force on each, both faces together.
    centres : ndarray, shape (b, 2)
        Their places in the formed part.
    small : float
        Displacement below which the force falls to zero.
    """

    triangles: Ids
    force: Floats
    centres: Floats
    small: float

    @classmethod
    def on(cls, sheet: Sheet, formed: Formed, under: NDArray[np.bool_], force: float) -> Friction:
        """A force on all triangles under the binder, shared by their areas."""
        ids = np.flatnonzero(under)
        share = force * formed.area[ids] / formed.area[ids].sum()
        centres = sheet.points[sheet.triangles[ids], :2].mean(axis=1)
        return cls(ids, share, centres, _SMALL * float(np.ptp(sheet.points, axis=0).max()))

    def times(self, factor: float) -> Self:
        """The same with another force."""
        return replace(self, force=factor * self.force)

    def add(self, X: Floats, D: Floats, sheet: Sheet, formed: Formed, r: Floats, K: Floats) -> None:
        """Add its forces to residuals (m, 6) and their derivatives (m, 6, 6)."""
        ids = self.triangles
        way = self.centres - X[sheet.triangles[ids]].mean(axis=1)
        length = np.sqrt((way**2).sum(axis=1) + self.small**2)
        d, inverse = way / length[:, None], _inverses(D[ids])
        share = self.force / 3.0
        F = formed.sides[ids, :2] @ inverse
        q = -share[:, None] * np.einsum("mij,mi->mj", F, d)
        turned = (np.eye(2) - d[:, :, None] * d[:, None, :]) / length[:, None, None]
        by_place = (share / 3.0)[:, None, None] * (np.swapaxes(F, 1, 2) @ turned)
        slope = _of_inverse(q, inverse) + np.tile(by_place, (1, 1, 3))
        _add_to_all(r, K, ids, q, slope)


@dataclass(frozen=True, eq=False)
class Restraint:
    """Dead forces on the formed sheet: along its outer edge, across it and outwards, or on triangles.

    Attributes
    ----------
    triangles : ndarray of int, shape (k,)
        Triangle of each force.
    corners : ndarray of int, shape (k, c)
        The corners that share it, 0 to 2: two at the ends of a side, or all three.
    force : ndarray, shape (k, 2)
        Force as components along two sides of the formed triangle: S^T f.
    """

    triangles: Ids
    corners: Ids
    force: Floats

    @classmethod
    def on(cls, sheet: Sheet, formed: Formed, per_length: ArrayLike) -> Restraint:
        """A force per length of the formed edge, a number or one for each side of `outer_sides`."""
        outer = outer_sides(sheet)
        sides, owner = sheet.boundary[outer], sheet.boundary_triangles[outer]
        across = np.cross(sheet.points[sides[:, 1]] - sheet.points[sides[:, 0]], sheet.normals[owner])
        across = across * np.broadcast_to(np.asarray(per_length, dtype=float), len(sides))[:, None]
        corners = (sheet.triangles[owner][:, None, :] == sides[:, :, None]).argmax(axis=2)
        return cls(owner, corners, np.einsum("mik,mi->mk", formed.sides[owner], across))

    def mean(self, other: Restraint) -> Restraint:
        """Between two forces at the same places."""
        return replace(self, force=0.5 * (self.force + other.force))

    def times(self, factor: float) -> Self:
        """The same with another force."""
        return replace(self, force=factor * self.force)

    def differs(self, other: Restraint) -> float:
        """Relative difference from other forces at the same places."""
        return float(np.linalg.norm(self.force - other.force) / max(float(np.linalg.norm(self.force)), 1e-300))

    @cached_property
    def _once(self) -> bool:
        """Whether no triangle has two forces."""
        return int(np.bincount(self.triangles).max(initial=0)) < 2

    def add(self, X: Floats, D: Floats, sheet: Sheet, formed: Formed, r: Floats, K: Floats) -> None:
        """Add its forces to residuals (m, 6) and their derivatives (m, 6, 6)."""
        del X, sheet, formed
        inverse = _inverses(D[self.triangles])
        q = np.einsum("mki,mk->mi", inverse, self.force) / self.corners.shape[1]
        slope = _of_inverse(q, inverse)
        if self.corners.shape[1] == 3 and self._once:
            _add_to_all(r, K, self.triangles, q, slope)
            return
        for corner in self.corners.T:
            for axis in (0, 1):
                rows = (self.triangles, 2 * corner + axis)
                np.add.at(r, rows, q[:, axis])
                np.add.at(K, rows, slope[:, axis])


def outer_sides(sheet: Sheet) -> Ids:
    """Places in `Sheet.boundary` of the sides of the outer edge, in their order along it."""
    loop = sheet.loops[0]
    at = np.full(len(sheet.points), -1)
    at[sheet.boundary[:, 0]] = np.arange(len(sheet.boundary))
    places: Ids = at[loop]
    return places


def smoothed(values: Floats, lengths: Floats, reach: float) -> Floats:
    """Values of the sides of a closed edge, each the mean over a distance to both sides."""
    ends = np.concatenate([[0.0], np.cumsum(lengths)])
    total = ends[-1]
    reach = min(reach, 0.5 * total)
    integral = np.concatenate([[0.0], np.cumsum(values * lengths)])
    middle = 0.5 * (ends[1:] + ends[:-1])

    def until(s: Floats) -> Floats:
        turns = np.floor(s / total)
        return np.asarray(turns * integral[-1] + np.interp(s - turns * total, ends, integral))

    return np.asarray((until(middle + reach) - until(middle - reach)) / (2.0 * reach))


def _of_inverse(q: Floats, inverse: NDArray[np.floating]) -> Floats:
    """Derivative of q = D^-T y by the corners for a constant y, shape (m, 2, 6)."""
    by_sides = -np.einsum("mki,mp->mipk", inverse, q).reshape(len(q), 2, 4)
    return np.asarray(by_sides @ CORNERS)


def _inverses(D: Floats) -> Floats:
    """Inverses of matrices, shape (m, 2, 2), by Cramer's rule, several times as quick as those of LAPACK."""
    cofactors = np.stack([D[:, 1, 1], -D[:, 0, 1], -D[:, 1, 0], D[:, 0, 0]], axis=1)
    return np.asarray((cofactors / (2.0 * areas(D))[:, None]).reshape(-1, 2, 2))


def _add_to_all(r: Floats, K: Floats, ids: Ids, q: Floats, slope: Floats) -> None:
    """Add the same to all corners of triangles, none of which occurs twice."""
    r[ids] += np.tile(q, (1, 3))
    K[ids] += np.tile(slope, (1, 3, 1))

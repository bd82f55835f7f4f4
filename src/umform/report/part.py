"""A sheet in one frame, with its fields; the whole part from a modelled half or quarter."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from umform.model import Model
from umform.report.symmetry import Mirror

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]

#: Distance of nodes from a plane of symmetry that counts as zero, as a part of the size of the sheet.
HAIR = 1e-7
#: Width of sheet in plane strain in pictures, as a part of its length.
_WIDE = 0.3
#: Nodes of the lower face after a reflection of the first natural direction.
_REFLECTED = {8: np.array([1, 0, 3, 2]), 18: np.array([1, 0, 3, 2, 4, 7, 6, 5, 8])}


@dataclass(frozen=True)
class Part:
    """A sheet in one frame.

    Attributes
    ----------
    reference, points : ndarray, shape (n, 3)
        Positions of the nodes before and after.
    cells : ndarray of int, shape (m, 8) or (m, 18)
        Nodes of the elements.
    nodal, cellwise : dict of str to ndarray
        Fields at the nodes and of the cells: scalars, and vectors with three components.
    tensors : tuple of str
        Fields that are left out.
    """

    reference: Floats
    points: Floats
    cells: Ids
    nodal: dict[str, Floats]
    cellwise: dict[str, Floats]
    tensors: tuple[str, ...] = ()

    @classmethod
    def deformed(cls, X: Floats, cells: Ids, nodal: Mapping[str, Floats], cellwise: Mapping[str, Floats]) -> Part:
        """A mesh with the fields of a frame; tensors are left out, vectors at the nodes become their lengths."""
        scalars = {}
        for name, values in nodal.items():
            if values.ndim == 1:
                scalars[name] = np.asarray(values, dtype=float)
            elif values.shape[1] == 3:
                scalars[name] = np.linalg.norm(values, axis=1)
        kept = {name: np.asarray(a, float) for name, a in cellwise.items() if a.ndim == 1 or a.shape[1] == 3}
        x = X + nodal["displacement"] if "displacement" in nodal else X
        left_out = tuple(name for name in (*nodal, *cellwise) if name not in scalars and name not in kept)
        return cls(X, np.asarray(x, dtype=float), np.asarray(cells, dtype=np.int64), scalars, kept, left_out)

    def whole(self, planes: Sequence[Mirror], of_blank: Sequence[Mirror] | None = None) -> Part:
        """The part together with its mirror images: nodes in a plane are shared, and no face is left there.

        Parameters
        ----------
        planes : sequence of Mirror
            Planes of symmetry.
        of_blank : sequence of Mirror, optional
            The same planes in the blank, if they were elsewhere.
        """
        part = self
        for plane, before in zip(planes, planes if of_blank is None else of_blank, strict=True):
            part = part._with_image(plane, before)
        return part

    def _with_image(self, plane: Mirror, before: Mirror) -> Part:
        """The part and its image at a plane."""
        n, k = len(self.reference), plane.axis
        off = np.abs(self.reference[:, before.axis] - before.at) > HAIR * np.ptp(self.reference, axis=0).max()
        image = np.where(off, n + np.cumsum(off) - 1, np.arange(n))
        lower = _REFLECTED[self.cells.shape[1]]
        order = np.concatenate([lower, lower + len(lower)])
        x = self.points.copy()
        x[~off, k] = plane.at
        sign = np.where(np.arange(3) == k, -1.0, 1.0)
        return Part(
            np.concatenate([self.reference, before.image(self.reference)[off]]),
            np.concatenate([x, plane.image(x)[off]]),
            np.concatenate([self.cells, image[self.cells[:, order]]]),
            {name: np.concatenate([values, values[off]]) for name, values in self.nodal.items()},
            {name: np.concatenate([a, a * sign if a.ndim > 1 else a]) for name, a in self.cellwise.items()},
            self.tensors,
        )

    def widened(self, axis: int, width: float) -> Part:
        """The part with another width along an axis, about the same middle: sheet in plane strain."""
        return replace(self, points=widened(self.points, axis, width))

    def stretched(self, axis: int, width: float) -> Part:
        """The part with another width along an axis: sheet in plane strain, which is the same in each section."""
        low, size = self.reference[:, axis].min(), np.ptp(self.reference[:, axis])
        scaled = [self.reference.copy(), self.points.copy()]
        for x in scaled:
            x[:, axis] = (x[:, axis] - low) * width / size - 0.5 * width
        return replace(self, reference=scaled[0], points=scaled[1])

    def at_corners(self, name: str) -> Floats:
        """A field at the nodes; at corners of elements the mean of a field of the cells, NaN at other nodes."""
        if name in self.nodal:
            return self.nodal[name]
        return means_at_corners(self.cells, len(self.points), self.cellwise[name])


def plane_strain(model: Model) -> tuple[int, float] | None:
    """Axis and width of a picture of sheet in plane strain, which is the same in each section; None for others.

    All nodes are held along the axis, and the modelled strip is narrow.
    """
    size = np.ptp(model.positions, axis=0)
    held = model.supports.constrained().reshape(-1, 3).all(axis=0)
    width = _WIDE * float(np.ptp(model.mesh.points, axis=0).max())
    for axis in np.flatnonzero(held):
        if 0.0 < size[axis] < 0.5 * width:
            return int(axis), width
    return None


def widened(x: Floats, axis: int, width: float) -> Floats:
    """Positions (..., 3) with another width along an axis, about the same middle."""
    wide = x.copy()
    low, high = x[..., axis].min(), x[..., axis].max()
    middle = 0.5 * (low + high)
    wide[..., axis] = middle + (x[..., axis] - middle) * width / (high - low)
    return wide


def means_at_corners(cells: Ids, count: int, values: Floats) -> Floats:
    """Means of a field of the cells at corners of elements, NaN at other nodes; shape (count,)."""
    corners = np.concatenate([cells[:, :4], cells[:, cells.shape[1] // 2 :][:, :4]], axis=1)
    known = np.isfinite(values)
    times = np.bincount(corners[known].ravel(), minlength=count)
    total = np.bincount(corners[known].ravel(), np.repeat(values[known], 8), minlength=count)
    means: Floats = np.divide(total, times, out=np.full(count, np.nan), where=times > 0)
    return means

"""Sizes of elements over a flat blank, and the angles that its elements turn. docs/theory, eq. (5.69)"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from umform.mesh import Mesh

Floats = NDArray[np.float64]

#: Samples of the curvature along each line of an element.
_SAMPLES = 9
#: Margin of refined sizes, and the radius around an element in which sizes are refined, relative to its own.
_MARGIN, _AROUND = 0.95, 2.0


@dataclass(frozen=True)
class ToolSizes:
    """Sizes of elements over a blank; called with x and y it gives one, as :func:`umform.mesh.blank` takes it.

    Attributes
    ----------
    x, y : ndarray
        Lines of the map.
    radius : ndarray, shape (x, y)
        Smallest radius of the mid-surface on the tools over which this part of the sheet moves; infinite where there is
        none.
    size : ndarray, shape (x, y)
        Sizes.
    turn : float
        Largest angle in degrees that an element may turn.
    smallest : float
        Least size.
    """

    x: Floats
    y: Floats
    radius: Floats
    size: Floats
    turn: float
    smallest: float = 0.0

    def __call__(self, x: float, y: float) -> float:
        """Size at a place, linear between the lines of the map; outside the map the size at its border."""
        rows, x0, y0, dx, dy = self._plain  # gmsh asks often: numbers of Python are ten times as fast as arrays
        p = min(max((x - x0) / dx, 0.0), len(rows) - 1.0)
        q = min(max((y - y0) / dy, 0.0), len(rows[0]) - 1.0)
        i, j = min(int(p), len(rows) - 2), min(int(q), len(rows[0]) - 2)
        a, b = p - i, q - j
        lower = (1.0 - b) * rows[i][j] + b * rows[i][j + 1]
        return (1.0 - a) * lower + a * ((1.0 - b) * rows[i + 1][j] + b * rows[i + 1][j + 1])

    @cached_property
    def _plain(self) -> tuple[list[list[float]], float, float, float, float]:
        """Sizes, first place and steps of the map."""
        steps = [float(line[-1] - line[0]) / (len(line) - 1) for line in (self.x, self.y)]
        return self.size.tolist(), float(self.x[0]), float(self.y[0]), steps[0], steps[1]

    def turns(self, mesh: Mesh) -> Floats:
        """Largest angle in degrees by which each element of a blank turns: the curvature along its lines; (cells,)."""
        corners = mesh.points[mesh.connectivity[:, [0, 1, 2, 3]], :2]
        a = np.linspace(0.0, 1.0, _SAMPLES)
        r, s = np.meshgrid(a, a, indexing="ij")
        N = np.stack([(1 - r) * (1 - s), r * (1 - s), r * s, (1 - r) * s], axis=-1)
        at = np.einsum("rsa,eak->ersk", N, corners)
        bend = _between(self.x, self.y, 1.0 / self.radius, at.reshape(-1, 2)).reshape(at.shape[:-1])
        angles = []
        for axis in (1, 2):
            way = np.linalg.norm(np.diff(at, axis=axis), axis=-1)
            low, high = (np.delete(bend, end, axis=axis) for end in (-1, 0))
            angles.append((0.5 * way * (low + high)).sum(axis=axis).max(axis=1))
        return np.asarray(np.degrees(np.max(angles, axis=0)))

    def refined(self, mesh: Mesh) -> ToolSizes | None:
        """Smaller sizes where the elements of a mesh turn more than they may; None if there are no such elements."""
        ratio = self.turns(mesh) / self.turn
        over = np.flatnonzero(ratio > 1.0)
        corners = mesh.points[mesh.connectivity[over, :4], :2]
        centres = corners.mean(axis=1)
        reach = _AROUND * np.linalg.norm(corners - centres[:, None], axis=2).max(axis=1, initial=0.0)
        reach += 0.5 * math.hypot(self.x[1] - self.x[0], self.y[1] - self.y[0])  # a line of the map at least
        factor = np.ones_like(self.size)
        for (x, y), far, share in zip(centres, reach, _MARGIN / ratio[over], strict=True):
            i, j = np.abs(self.x - x) <= far, np.abs(self.y - y) <= far
            factor[np.ix_(i, j)] = np.minimum(factor[np.ix_(i, j)], share)
        size = np.maximum(self.size * factor, np.minimum(self.size, self.smallest))
        return None if np.array_equal(size, self.size) else replace(self, size=size)

    def on(self, mesh: Mesh) -> str:
        """The sizes of a mesh, and the largest angle that its elements turn."""
        bent = np.isfinite(self.radius)
        if not bent.any():
            return str(self)
        sides = mesh.points[mesh.connectivity[:, [0, 1, 2, 3]], :2]
        length = np.linalg.norm(np.roll(sides, -1, axis=1) - sides, axis=2)
        return (
            f"elements with sides from {length.min():.3g} to {length.max():.3g}, which turn by up to "
            f"{self.turns(mesh).max():.3g} degrees over radii from {self.radius[bent].min():.3g}; "
            f"{100.0 * bent.mean():.0f} % of the blank goes over them"
        )

    def __str__(self) -> str:
        bent = np.isfinite(self.radius)
        if not bent.any():
            return f"no tool bends the sheet: elements of {self.size.max():.3g}"
        return (
            f"elements from {self.size.min():.3g} to {self.size.max():.3g}, which may turn by {self.turn:.3g} "
            f"degrees over radii from {self.radius[bent].min():.3g}; "
            f"{100.0 * bent.mean():.0f} % of the blank goes over them"
        )


def _between(x: Floats, y: Floats, values: Floats, at: Floats) -> Floats:
    """Values of a map at some places (n, 2), linear in each of its meshes."""
    index, part = [], []
    for line, k in ((x, 0), (y, 1)):
        step = (line[-1] - line[0]) / (len(line) - 1)
        place = np.clip((at[:, k] - line[0]) / step, 0.0, len(line) - 1.0)
        first = np.minimum(place.astype(int), len(line) - 2)
        index.append(first)
        part.append(place - first)
    (i, j), (a, b) = index, part
    lower = (1 - b) * values[i, j] + b * values[i, j + 1]
    upper = (1 - b) * values[i + 1, j] + b * values[i + 1, j + 1]
    return np.asarray((1 - a) * lower + a * upper)

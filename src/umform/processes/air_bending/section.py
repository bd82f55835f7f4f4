"""The bent section: fibres through the thickness, slopes, radius, lengths."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.errors import InvalidValue
from umform.mesh import Mesh
from umform.mesh.numbers import unique
from umform.processes.air_bending.spline import Spline

Floats = NDArray[np.float64]

#: Part of the slope of the leg by which the inner face turns in the bend; the rest fades away along the leg.
_BEND = 0.9
#: Points along half of the inner face.
_SAMPLES = 4001
#: Points of it in the bend, to which the circle is fitted.
_FITTED = 801
#: Change of the length of a face, over the length of the sheet, that is no rounding.
_CHANGE = 1e-9


@dataclass(frozen=True)
class Section:
    """Section of half of the bent sheet, the lines of nodes through the thickness one after the other.

    Attributes
    ----------
    reference, current : ndarray, shape (lines, levels, 2)
        Positions (x, z) of the nodes; levels from the lower (outer) to the upper (inner) face.
    order : int
        Order of the elements along the sheet: 1, or 2 with a line of nodes in the middle of each element.
    """

    reference: Floats
    current: Floats
    order: int

    @classmethod
    def of(cls, mesh: Mesh, u: Floats, edges: Sequence[str] = ("y0",)) -> Self:
        """Section of a mesh of half of the sheet under displacements u, shape (n, 3) or (3 n,).

        Parameters
        ----------
        mesh : Mesh
            The mesh.
        u : ndarray
            Displacements.
        edges : sequence of str
            Sets of the nodes in its plane, or in several planes across y, of which the section is the mean.
        """
        return next(cls.each(mesh, [u], edges))

    @classmethod
    def each(cls, mesh: Mesh, states: Iterable[Floats], edges: Sequence[str] = ("y0",)) -> Iterator[Self]:
        """Sections of a mesh of half of the sheet under several displacements, whose lines of nodes are found once."""
        nodes = unique(np.concatenate([mesh.nodes(edge) for edge in edges]))
        nodes = nodes[np.lexsort(mesh.points[nodes].T[[1, 2, 0]])]  # by x, then z, then y
        lines, planes = (len(np.unique(mesh.points[nodes, axis])) for axis in (0, 1))
        X = mesh.points[nodes[::planes]][:, [0, 2]].reshape(lines, -1, 2)
        for u in states:
            d = u.reshape(-1, 3)[nodes][:, [0, 2]].reshape(lines, -1, planes, 2).mean(axis=2)
            yield cls(X, X + d, 2 if mesh.cell == "hex18" else 1)

    @property
    def thickness(self) -> float:
        """Thickness of the flat sheet."""
        return float(self.reference[0, -1, 1] - self.reference[0, 0, 1])

    @property
    def half_length(self) -> float:
        """Half of the length of the flat sheet."""
        return float(self.reference[-1, 0, 0])

    def fibre(self, height: float) -> Floats:
        """Current positions (lines, 2) of the fibre at a height, 0 the lower (outer) and 1 the upper (inner) face."""
        levels = (self.reference[0, :, 1] - self.reference[0, 0, 1]) / self.thickness
        k = min(max(int(np.searchsorted(levels, height)) - 1, 0), len(levels) - 2)
        part = (height - levels[k]) / (levels[k + 1] - levels[k])
        line: Floats = (1.0 - part) * self.current[:, k] + part * self.current[:, k + 1]
        return line

    def element_lengths(self, height: float) -> Floats:
        """Current length of a fibre in each element, from the shape functions; shape (elements,)."""
        x = self.fibre(height)
        if self.order == 1:
            return np.asarray(np.linalg.norm(np.diff(x, axis=0), axis=1))
        r, w = _core.gauss(4)
        dN = np.stack([r - 0.5, -2.0 * r, r + 0.5])
        nodes = np.stack([x[:-1:2], x[1::2], x[2::2]])
        return np.asarray(np.linalg.norm(np.einsum("aq,aek->eqk", dN, nodes), axis=-1) @ w)

    @property
    def element_references(self) -> Floats:
        """Length of the elements in the flat sheet; shape (elements,)."""
        return np.diff(self.reference[:: self.order, 0, 0])

    def change(self, height: float) -> float:
        """By how much a fibre is longer than the flat sheet."""
        return float(self.element_lengths(height).sum()) - self.half_length

    @cached_property
    def is_bent(self) -> bool:
        """Whether the outer face is longer and the inner one shorter than the flat sheet; else no fibre is neutral."""
        least = _CHANGE * self.half_length
        return self.change(0.0) > least and self.change(1.0) < -least

    @cached_property
    def neutral_height(self) -> float:
        """Height in the flat sheet (0 outer, 1 inner face) of the fibre that is as long as the flat sheet.

        Raises
        ------
        InvalidValue
            If the section is not bent.
        """
        if not self.is_bent:
            raise InvalidValue(
                "no fibre of the section keeps its length",
                where="neutral fibre",
                value=f"outer {self.change(0.0):+.3g}, inner {self.change(1.0):+.3g}",
                cause="the sheet is hardly bent",
                remedy="a larger stroke",
            )
        heights = np.linspace(0.0, 1.0, 41)
        return float(np.interp(0.0, [-self.change(height) for height in heights], heights))

    def leg(self, height: float) -> tuple[Floats, Floats]:
        """Point and direction (outwards) of the straight line through the outermost two thicknesses of a fibre.

        Where the last element is longer than that, as in a thin sheet over a wide die, it is through its nodes.
        """
        X = self.reference[:, 0, 0]
        end = min(self.half_length - 2.0 * self.thickness, X[-1 - self.order]) - 1e-9 < X
        x = self.fibre(height)[end]
        centre = x.mean(axis=0)
        direction = np.linalg.svd(x - centre)[2][0]
        return centre, direction * np.sign(direction[0])

    @property
    def slope(self) -> float:
        """Slope of the leg in radians: half of the bend angle."""
        direction = self.leg(0.5)[1]
        return float(np.arctan2(direction[1], direction[0]))

    @property
    def angle(self) -> float:
        """Angle between the legs in degrees."""
        return 180.0 - 2.0 * float(np.degrees(self.slope))

    @property
    def radius(self) -> float:
        """Radius of the circle that fits the inner face in the bend best."""
        return self.circle[1]

    @cached_property
    def circle(self) -> tuple[float, float]:
        """Height of the centre, and radius, of the circle about x = 0 that fits the inner face best (least squares).

        It is fitted to points at equal distances in the flat sheet, up to where the inner face, a cubic spline through
        its nodes, has turned by nine tenths of the slope of the leg.
        """
        face = self._inner_face
        at = np.linspace(0.0, self.half_length, _SAMPLES)
        dx, dz = face.slope(at).T
        turned, limit = np.arctan2(dz, dx), _BEND * self.slope
        first = int(np.argmax(turned > limit))
        end = np.interp(limit, turned[first - 1 : first + 1], at[first - 1 : first + 1]) if first else 0.0
        x, z = face(np.linspace(0.0, max(end, at[2]), _FITTED)).T
        # x² + z² = 2 z z_c + (R² - z_c²) is linear in z_c and R² - z_c²
        matrix = np.stack([2.0 * z, np.ones(len(z))], axis=1)
        (zc, c), *_ = np.linalg.lstsq(matrix, x**2 + z**2, rcond=None)
        return float(zc), float(np.sqrt(c + zc**2))

    @property
    def smallest_radius(self) -> float:
        """Smallest radius of circles through three points of the inner face, in the flat sheet 1/3 thickness apart."""
        x = self._inner_face(np.arange(0.0, 0.5 * self.half_length, self.thickness / 3.0))
        x = np.concatenate([x[1:2] * [-1.0, 1.0], x])
        a, b = x[1:-1] - x[:-2], x[2:] - x[1:-1]
        twice_area = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
        sides = np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1) * np.linalg.norm(a + b, axis=1)
        curvature = float((2.0 * twice_area / sides).max())
        return 1.0 / curvature if curvature > 0.0 else np.inf

    @cached_property
    def _inner_face(self) -> Spline:
        """Position on the inner face over x in the flat sheet."""
        return Spline(self.reference[:, 0, 0], self.fibre(1.0))

    @property
    def thicknesses(self) -> Floats:
        """Current thickness across the mid-surface over that of the flat sheet; shape (lines,)."""
        across = self.current[:, -1] - self.current[:, 0]
        tangent = np.gradient(self.fibre(0.5), axis=0)
        tangent[0] = [1.0, 0.0]  # the symmetry plane
        normal = np.stack([-tangent[:, 1], tangent[:, 0]], axis=1) / np.linalg.norm(tangent, axis=1, keepdims=True)
        return np.asarray(np.einsum("ik,ik->i", across, normal) / self.thickness)

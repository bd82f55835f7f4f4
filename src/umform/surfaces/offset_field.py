"""The offset of a tool that varies over it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from annotated_types import Ge
from numpy.typing import ArrayLike, NDArray

from umform import _core
from umform.errors import InvalidValue
from umform.spec import About, check_fields
from umform.surfaces.directions import Direction, Point2, unit_vector

Floats = NDArray[np.float64]

#: Slope of a field from which the surface of a tool may fold: its distance and the field change alike.
STEEPEST = 1.0
#: Largest cosine of directions that are at right angles.
RIGHT = 1e-9


@dataclass(frozen=True)
class OffsetField:
    """Offset of a tool that varies over it: a cubic B-spline over one, two or three directions. eqs. (4.262), (4.263)

    Coefficients lie at equal distances over the span of each direction, the first and the last at its ends. Beyond them
    the offset is that of the last one. It is twice continuously differentiable everywhere.

    Examples
    --------
    >>> import umform as uf
    >>> bulge = uf.OffsetField(["x"], [(-10, 10)], [5], [0.0, 0.0, 0.3, 0.0, 0.0])
    >>> die = uf.Plane((0, 0, 0), "z").offset(bulge)
    >>> round(float(die.gap([(0.0, 0.0, 1.0)])[0][0]), 6)
    0.8
    """

    along: Sequence[Direction]
    """Directions in the frame of the tool, one to three, at right angles: one for a section, two for a panel, three for
    walls that are not alike."""
    span: Sequence[Point2]
    """Coordinates of the first and the last coefficient along each direction, from the origin."""
    coefficients: Sequence[Annotated[int, Ge(2), About(cause="a fraction, or a sign", remedy="5 to 10")]]
    """Number of coefficients along each direction."""
    values: Sequence[float] = ()
    """Coefficients, outward positive, those along the last direction next to each other; by default all are zero."""

    def __post_init__(self) -> None:
        check_fields(self)
        for name in ("along", "span", "coefficients"):
            if not 1 <= len(getattr(self, name)) <= 3 or len(getattr(self, name)) != len(self.along):
                raise InvalidValue(
                    "a field has one to three directions, each with a span and a number of coefficients",
                    where=name,
                    value=len(getattr(self, name)),
                    cause="one is missing",
                    remedy='along = ["x", "y"], span = [[-50, 50], [-30, 30]], coefficients = [7, 5]',
                )
        axes = np.array([unit_vector(one, "along") for one in self.along])
        if np.abs(axes @ axes.T - np.eye(len(axes))).max() > RIGHT:
            raise InvalidValue(
                "the directions of a field are at right angles",
                where="along",
                value=self.along,
                cause="rounded numbers, or one of them twice",
                remedy='words such as ["x", "y"], or unit vectors with a scalar product of zero',
            )
        for low, high in self.span:
            if not low < high:
                raise InvalidValue(
                    "a span has a first and a larger last number",
                    where="span",
                    value=f"{low}, {high}",
                    cause="numbers exchanged",
                    remedy="the coordinates of both ends of the tool along the direction",
                )
        if min(self.coefficients) < 2:
            raise InvalidValue(
                "a direction has at least 2 coefficients",
                where="coefficients",
                value=list(self.coefficients),
                cause="a direction along which the offset is constant",
                remedy="leave it out, or give 5 to 10",
            )
        count = math.prod(self.coefficients)
        object.__setattr__(self, "values", tuple(float(one) for one in self.values) or (0.0,) * count)
        if len(self.values) != count:
            raise InvalidValue(
                "a field has a value for each coefficient",
                where="values",
                value=f"{len(self.values)} instead of {count}",
                cause="another number of coefficients than values",
                remedy="the product of the numbers of coefficients, or no values for zeros",
            )
        if not np.isfinite(self.values).all() or self.slope >= STEEPEST:
            raise InvalidValue(
                f"the slope of a field must be less than {STEEPEST:g}, or the surface of the tool may fold",
                where="values",
                value=f"{self.slope:.3g}, of values up to {np.abs(self.values).max():.3g}",
                cause="a large difference between two neighbours",
                remedy="smaller differences, or fewer coefficients",
            )

    @property
    def spacing(self) -> Floats:
        """Distance of two coefficients along each direction."""
        return np.array([(high - low) / (n - 1) for (low, high), n in zip(self.span, self.coefficients, strict=True)])

    @property
    def slope(self) -> float:
        """A bound of the slope: differences of neighbours over their distance."""
        c = self._grid()
        return float(np.linalg.norm([np.abs(np.diff(c, axis=k)).max() / h for k, h in enumerate(self.spacing)]))

    def basis(self, x: ArrayLike) -> Floats:
        """What each coefficient adds to the offset at some points, shape (points, coefficients). eq. (4.262)

        Parameters
        ----------
        x : array_like, shape (n, 3)
            Points in the frame of the tool.
        """
        points = np.asarray(x, dtype=float)
        found = np.ones((len(points), 1))
        for direction, (low, _), h, count in zip(self.along, self.span, self.spacing, self.coefficients, strict=True):
            s = np.clip((points @ np.array(unit_vector(direction)) - low) / h, -2.0, count + 1.0)
            rows = np.zeros((len(points), count))
            for k in range(-1, 3):
                at = np.floor(s).astype(int) + k
                np.add.at(rows, (np.arange(len(points)), np.clip(at, 0, count - 1)), _cubic(s - at))
            found = (found[:, :, None] * rows[:, None, :]).reshape(len(points), -1)
        return found

    def differences(self) -> Floats:
        """First and second differences of the coefficients along all directions, as rows of a matrix."""
        ids = np.arange(len(self.values)).reshape(tuple(self.coefficients))
        rows = []
        for k, h in enumerate(self.spacing / self.spacing.min()):
            for order, weights in ((1, (-1.0, 1.0)), (2, (1.0, -2.0, 1.0))):
                count = self.coefficients[k] - order
                part = np.zeros((ids.size // self.coefficients[k] * max(count, 0), ids.size))
                for i, weight in enumerate(weights):
                    part[np.arange(len(part)), np.moveaxis(ids, k, 0)[i : count + i].ravel()[: len(part)]] = (
                        weight / h**order
                    )
                rows.append(part)
        return np.concatenate(rows)

    def edge(self, chord: float) -> float:
        """Length of edges of triangles that deviate by a chord where the field bends most, by 4 w/h^2."""
        part = math.sqrt(2.0 * chord / max(np.abs(self.values).max(), 2.0 * chord))
        return float(self.spacing.min() * part)

    def kernel(self, tool: _core.Surface) -> _core.Surface:
        """A surface grown by the field."""
        axes = [
            (*unit_vector(direction), low, h, count)
            for direction, (low, _), h, count in zip(
                self.along, self.span, self.spacing, self.coefficients, strict=True
            )
        ]
        return _core.offset_by_field(tool, np.array(axes), np.array(self.values))

    def _grid(self) -> Floats:
        return np.array(self.values, dtype=float).reshape(tuple(self.coefficients))


def _cubic(s: Floats) -> Floats:
    """The uniform cubic B-spline about 0."""
    r = np.abs(s)
    inner, outer = 2.0 / 3.0 - r**2 * (1.0 - 0.5 * r), np.maximum(2.0 - r, 0.0) ** 3 / 6.0
    found: Floats = np.where(r < 1.0, inner, outer)
    return found

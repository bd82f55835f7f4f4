"""Element technology as data: tying rows, enhanced modes, and elements."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.elements.legendre import legendre
from umform.elements.staggered import default_points
from umform.errors import InvalidValue

#: Voigt order of the strain components.
COMPONENTS = ("11", "22", "33", "12", "23", "13")


@dataclass(frozen=True)
class Tying:
    """One row of an assumed-strain rule.

    The covariant component is sampled on the grid ``r`` x ``s`` and interpolated with the Lagrange polynomials of the
    abscissae, at the mid-surface (t = 0) or, with ``at_layer``, at the t of the Gauss point.

    Parameters
    ----------
    component : str
        One of :data:`COMPONENTS`.
    r, s : tuple of float
        Natural coordinates of the grid.
    at_layer : bool
        Sample at the t of the Gauss point instead of the mid-surface.

    Examples
    --------
    >>> import umform as uf
    >>> transverse_shear = uf.Tying("13", r=(0.0,), s=(-1.0, 1.0))
    >>> element = uf.Element("tied", "hex8", tying=(transverse_shear, uf.Tying("23", r=(-1.0, 1.0), s=(0.0,))))
    """

    component: str
    r: tuple[float, ...]
    s: tuple[float, ...]
    at_layer: bool = False


@dataclass(frozen=True)
class Polynomial:
    """The polynomial ``factor * r**a * s**b * P_c(t)`` in one covariant component (P_c: Legendre)."""

    component: str
    a: int = 0
    b: int = 0
    c: int = 0
    factor: float = 1.0

    def __call__(self, r: NDArray[np.float64], s: NDArray[np.float64], t: NDArray[np.float64]) -> NDArray[np.float64]:
        """Value at natural coordinates."""
        return self.factor * r**self.a * s**self.b * legendre(self.c, t)

    def mean(self, points: tuple[int, int]) -> float:
        """Mean under the rule of as many Gauss points in r and in s. eq. (2.12)

        The kernels take the mean under the rule in t from P_c, c > 0. eq. (2.48)
        """
        if self.c > 0:
            return 0.0
        (r, wr), (s, ws) = (_core.gauss(count) for count in points)
        return float(self.factor * (wr @ r**self.a) * (ws @ s**self.b) / 4.0)


@dataclass(frozen=True, init=False)
class Mode:
    """An enhanced mode: ``factor * r**a * s**b * P_c(t)`` in one covariant component, or a sum of such modes.

    Parameters
    ----------
    component : str
        One of :data:`COMPONENTS`.
    a, b : int
        Powers of r and s.
    c : int
        Degree of the Legendre polynomial in t.
    factor : float
        Factor of the polynomial.

    Attributes
    ----------
    polynomials : tuple of Polynomial
        Those whose sum it is.

    Examples
    --------
    >>> import umform as uf
    >>> linear_in_thickness = uf.Mode("33", c=1)
    >>> without_mean = uf.Mode("11", 2) + uf.Mode("11", factor=-1 / 3)
    """

    polynomials: tuple[Polynomial, ...]

    def __init__(self, component: str, a: int = 0, b: int = 0, c: int = 0, factor: float = 1.0) -> None:
        object.__setattr__(self, "polynomials", (Polynomial(component, a, b, c, factor),))

    @classmethod
    def of(cls, polynomials: Iterable[Polynomial]) -> Mode:
        """The sum of polynomials, at least one."""
        made = cls.__new__(cls)
        object.__setattr__(made, "polynomials", tuple(polynomials))
        return made

    def __add__(self, other: Mode) -> Mode:
        return Mode.of(self.polynomials + other.polynomials)

    def __call__(self, r: NDArray[np.float64], s: NDArray[np.float64], t: NDArray[np.float64]) -> NDArray[np.float64]:
        """Sum of the values at natural coordinates."""
        return np.asarray(sum(polynomial(r, s, t) for polynomial in self.polynomials))


def _without_mean(order: int, t: NDArray[np.float64], w: NDArray[np.float64]) -> NDArray[np.float64]:
    """A Legendre polynomial less its mean under the rule of each column; constants stay. eq. (2.48)"""
    values = legendre(order, t)
    return values - 0.5 * (w * values).sum(axis=-1, keepdims=True) if order > 0 else values


@dataclass(frozen=True)
class Element:
    """A solid-shell element as data.

    Parameters
    ----------
    name : str
        Name in the literature.
    cell : {"hex8", "hex18"}
        Cell type of the mesh.
    tying : tuple of Tying
        Assumed strains; components without a row are compatible.
    modes : tuple of Mode
        Enhanced strains.
    surface_points : int
        Gauss points per direction of the surface; default 2 with 8 nodes, 3 with 18.
    width_points : int
        Gauss points in s, if they are others than in r.
    thickness_order : int
        Highest order in t of the enhanced thickness strain (0: none), at least that of the modes, the default; it needs
        order + 1 thickness points.
    citation : str
        Reference (a key of references.bib).
    plastic_points : tuple (int, str), optional
        Default points through the thickness and their rule with a plastic law, one with a history. Default: staggered
        points with an enhanced thickness strain (12 in each of 2 x 2 columns), else 5 Gauss points.
    complete : bool, optional
        Whether a plastic law raises the thickness order to the number of points minus one: modes of E_33 that are
        missing are added to those of the element, see :func:`umform.elements.at_order`. Default: with an enhanced
        thickness strain. Without the complete order a plastic bend is too stiff (docs/theory, 2.10).

    Examples
    --------
    >>> import umform as uf
    >>> compatible = uf.Element("compatible", "hex8")
    >>> model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), compatible, material=uf.SVK(E=210e3, nu=0.3))
    """

    name: str
    cell: str
    tying: tuple[Tying, ...] = ()
    modes: tuple[Mode, ...] = ()
    surface_points: int = 0
    thickness_order: int = 0
    citation: str = ""
    plastic_points: tuple[int, str] | None = None
    complete: bool | None = None
    width_points: int = 0
    options: dict[str, object] = field(default_factory=dict, compare=False)

    def __post_init__(self) -> None:
        if self.cell not in ("hex8", "hex18"):
            raise InvalidValue(
                "an element stands on hex8 or hex18 cells",
                where=self.name,
                value=self.cell,
                cause="a cell of another program",
                remedy="hex8, or hex18 with 9 nodes on a face",
            )
        rows: object = self.tying
        if not isinstance(rows, tuple) or not all(isinstance(row, Tying) for row in rows):
            raise InvalidValue(
                "tying rows are a tuple of Tying",
                where=self.name,
                value=rows,
                cause="a row in place of a tuple, or the component alone",
                remedy='with the comma: tying=(Tying("13", r=(0.0,), s=(-1.0, 1.0)), ...)',
            )
        rule: object = self.plastic_points
        if rule is not None and not (isinstance(rule, tuple) and [type(one) for one in rule] == [int, str]):
            raise InvalidValue(
                "the points of a plastic law are their number and their rule",
                where=self.name,
                value=rule,
                cause="the number alone",
                remedy='plastic_points=(5, "gauss")',
            )
        tied = [row.component for row in self.tying]
        for row in self.tying:
            if row.component not in COMPONENTS or tied.count(row.component) > 1:
                raise InvalidValue(
                    "a tying row belongs to one component, and a component has one row",
                    where=self.name,
                    value=row.component,
                    cause="the indices exchanged, or two rows of one component",
                    remedy="components: " + ", ".join(COMPONENTS),
                )
            if any(np.ndim(abscissae) != 1 for abscissae in (row.r, row.s)):
                raise InvalidValue(
                    "the abscissae of a tying row are tuples",
                    where=self.name,
                    value=row,
                    cause="a number in place of a tuple",
                    remedy=f'with the comma: Tying("{row.component}", r=(0.0,), s=(-1.0, 1.0))',
                )
            if any(
                len(set(abscissae)) != len(abscissae) or not abscissae or not np.isfinite(abscissae).all()
                for abscissae in (row.r, row.s)
            ):
                raise InvalidValue(
                    "the abscissae of a tying row are finite numbers, one at least, each once",
                    where=self.name,
                    value=row,
                    cause="an empty tuple, a number twice, or a division by zero",
                    remedy=f'natural coordinates: Tying("{row.component}", r=(0.0,), s=(-1.0, 1.0))',
                )
        if self.surface_points == 0:
            object.__setattr__(self, "surface_points", 2 if self.cell == "hex8" else 3)
        if self.width_points == 0:
            object.__setattr__(self, "width_points", self.surface_points)
        given: object = self.modes
        if not isinstance(given, tuple) or not all(isinstance(mode, Mode) for mode in given):
            raise InvalidValue(
                "modes are a tuple of Mode",
                where=self.name,
                value=given,
                cause="a mode in place of a tuple, or a tuple in place of a mode",
                remedy="with the comma: modes=(Mode(...), Mode(...) + Mode(...), ...)",
            )
        for mode in self.modes:
            self._check_mode(mode)
        orders = [part.c for mode in self.modes for part in mode.polynomials if part.component == "33"]
        object.__setattr__(self, "thickness_order", max([self.thickness_order, *orders]))

    def _check_mode(self, mode: Mode) -> None:
        """Reject a mode of no component, or whose mean does not vanish at the Gauss points. eq. (2.12)"""
        components = {part.component for part in mode.polynomials}
        if not components <= set(COMPONENTS):
            raise InvalidValue(
                "a mode is one of a strain component",
                where=self.name,
                value=mode,
                cause="the indices exchanged, or a component of a stress",
                remedy="components: " + ", ".join(COMPONENTS),
            )
        powers = [power for part in mode.polynomials for power in (part.a, part.b, part.c)]
        if not all(isinstance(power, int | np.integer) and power >= 0 for power in powers) or not all(
            np.isfinite(part.factor) for part in mode.polynomials
        ):
            raise InvalidValue(
                "a mode is a polynomial: powers of whole numbers from 0 on, and a finite factor",
                where=self.name,
                value=mode,
                cause="a sign, a fraction, or a factor in place of a power",
                remedy='Mode("11", 1) for r; Mode("11", 2) + Mode("11", factor=-1 / 3) for r^2 - 1/3',
            )
        for component in components:
            mean = sum(part.mean(self.surface_rule) for part in mode.polynomials if part.component == component)
            if abs(mean) > 1e-12:
                raise InvalidValue(
                    "the mean of an enhanced mode over the element must vanish",
                    where=self.name,
                    value=f"{mode}: mean {mean:.3g} at {self.surface_points} x {self.width_points} Gauss points",
                    cause="such a mode takes part in constant strain: the patch test is lost",
                    remedy="odd powers of r or s, or Legendre order c > 0; or subtract the mean at these points "
                    "by another polynomial",
                )

    @property
    def surface_rule(self) -> tuple[int, int]:
        """Gauss points in r and in s."""
        return self.surface_points, self.width_points

    @property
    def plane_strain(self) -> bool:
        """Whether its cells do not move along s, and their displacements do not vary along s."""
        return bool(self.options.get("plane_strain"))

    @property
    def raised(self) -> bool:
        """Whether a plastic law raises the thickness order."""
        return self.thickness_order > 0 if self.complete is None else self.complete

    @property
    def plastic_rule(self) -> tuple[int, str]:
        """Points through the thickness and their rule with a plastic law."""
        if self.plastic_points is not None:
            return self.plastic_points
        return (default_points(self.surface_rule), "staggered") if self.thickness_order > 0 else (5, "gauss")

    @property
    def nodes(self) -> int:
        """Number of nodes: 8 or 18."""
        return {"hex8": 8, "hex18": 18}[self.cell]

    def mode_values(self, t: NDArray[np.float64], w: NDArray[np.float64]) -> NDArray[np.float64]:
        """Modes at all points as the kernels have them, shape (6 points, modes), for a rule in t. eq. (2.48)

        The rule is one for all columns of points, or has a row for each.
        """
        along, across = (_core.gauss(count)[0] for count in self.surface_rule)
        s, r = (grid.ravel()[:, None] for grid in np.meshgrid(across, along, indexing="ij"))
        values = np.zeros((len(COMPONENTS), len(self.modes), len(r), np.shape(t)[-1]))
        orders = {part.c for mode in self.modes for part in mode.polynomials}
        through = {c: _without_mean(c, t, w) for c in orders}
        for k, mode in enumerate(self.modes):
            for part in mode.polynomials:
                in_plane = part.factor * r**part.a * s**part.b
                values[COMPONENTS.index(part.component), k] += in_plane * through[part.c]
        values = np.moveaxis(values, 1, -1)
        return values.reshape(len(COMPONENTS) * len(r) * np.shape(t)[-1], len(self.modes))

    def check_modes(self, t: NDArray[np.float64], w: NDArray[np.float64]) -> None:
        """Reject modes that vanish or are linearly dependent at the Gauss points, for a rule in t.

        Raises
        ------
        InvalidValue
            If the parameters of the modes are not unique.
        """
        values, points = (
            self.mode_values(t, w),
            f"{self.surface_points} x {self.width_points} x {np.shape(t)[-1]} points",
        )
        for mode, largest in zip(self.modes, np.abs(values).max(axis=0), strict=True):
            if largest <= 1e-10 * max(abs(part.factor) for part in mode.polynomials):
                raise InvalidValue(
                    "an enhanced mode vanishes at the Gauss points",
                    where=self.name,
                    value=f"{mode}, {points}",
                    cause="the points cannot see a polynomial of this degree",
                    remedy="take it out, or more thickness points",
                )
        if self.modes and np.linalg.matrix_rank(values, tol=1e-10) < len(self.modes):
            raise InvalidValue(
                "the enhanced modes are linearly dependent at the Gauss points",
                where=self.name,
                value=f"{len(self.modes)} modes, {points}",
                cause="two modes alike, or more of them than the points can see",
                remedy="take modes out, or more thickness points",
            )

    def technology(self) -> _core.Technology:
        """The element in the form of the kernels."""
        index = COMPONENTS.index
        return _core.Technology(
            [_core.Tying(index(row.component), list(row.r), list(row.s), row.at_layer) for row in self.tying],
            [
                [_core.Polynomial(index(p.component), p.factor, p.a, p.b, p.c) for p in mode.polynomials]
                for mode in self.modes
            ],
        )

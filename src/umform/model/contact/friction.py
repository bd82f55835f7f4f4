"""Friction laws: the largest tangential traction as a function of pressure and slip."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform import _core
from umform.errors import InvalidFriction, NotFinite

#: (pressure, distance slid, position in the frame of the tool) -> largest tangential traction.
FrictionFunction = Callable[[float, float, NDArray[np.float64]], float]

#: A larger coefficient is more often a mistake of units or sign than a rough tool.
_ROUGHEST = 2.0


@dataclass(frozen=True)
class Friction:
    """Coulomb's law with options for forming: t <= min(mu p, cap). eq. (4.48)

    Parameters
    ----------
    mu : float or sequence of (float, float)
        Coefficient, or a table of pairs (pressure, coefficient), linear in between and constant beyond its ends.
    kinetic : float, optional
        Coefficient of a sliding point, approached from mu with the distance slid; with a table its ratio to the first
        entry. Default: mu.
    decay : float, optional
        Distance slid after which 1 / e of the difference remains; required with ``kinetic``.
    cap : float, optional
        Largest tangential traction, for instance the shear strength of the sheet or its coating; default: no limit.

    Raises
    ------
    InvalidFriction
        If a coefficient is negative, above 2 or not finite, or the numbers are inconsistent.

    Examples
    --------
    >>> import umform as uf
    >>> uf.Friction(0.12, kinetic=0.1, decay=0.5).bound(10.0)
    1.2
    """

    mu: float | Sequence[tuple[float, float]]
    kinetic: float | None = None
    decay: float | None = None
    cap: float | None = None

    def __post_init__(self) -> None:
        pressures, coefficients = self._table()
        if len(coefficients) == 0 or (np.diff(pressures) <= 0).any() or pressures[0] < 0:
            raise InvalidFriction(
                "the pressures of a table of friction must ascend from zero or more",
                where="friction",
                value=pressures.tolist(),
                cause="rows out of order, or a row twice",
                remedy="pairs (pressure, coefficient), sorted by pressure",
            )
        for coefficient in coefficients.tolist():
            _check_coefficient(coefficient)
        if (self.kinetic is None) != (self.decay is None):
            raise InvalidFriction(
                "a kinetic coefficient and the distance of its decay belong together",
                where="friction",
                value=f"kinetic {self.kinetic}, decay {self.decay}",
                cause="one of the two is missing",
                remedy="Friction(0.12, kinetic=0.10, decay=0.5)",
            )
        if self.kinetic is not None:
            _check_coefficient(self.kinetic)
        for name in ("decay", "cap"):
            value = getattr(self, name)
            if value is not None and not (math.isfinite(value) and value > 0):
                raise InvalidFriction(f"the {name} of friction must be positive", where="friction", value=value)
        if self.kinetic is not None and not coefficients[0] > 0:
            raise InvalidFriction(
                "a kinetic coefficient needs a positive one to begin with", where="friction", value=coefficients[0]
            )

    def _table(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        try:
            table = np.array([(0.0, self.mu)] if np.ndim(self.mu) == 0 else self.mu, dtype=float)
            pressures, coefficients = table.T
        except (TypeError, ValueError):
            raise InvalidFriction(
                "friction is a coefficient or pairs (pressure, coefficient)",
                where="friction",
                value=self.mu,
                remedy="0.12, or [(0, 0.14), (50, 0.10)]",
            ) from None
        return pressures, coefficients

    def kernel(self) -> _core.FrictionLaw:
        """The law as the kernels take it."""
        pressures, coefficients = self._table()
        kinetic = 1.0 if self.kinetic is None else self.kinetic / coefficients[0]
        cap = math.inf if self.cap is None else self.cap
        return _core.coulomb_friction(pressures.tolist(), coefficients.tolist(), kinetic, self.decay or 0.0, cap)

    def bound(self, pressure: float, slip: float = 0.0) -> float:
        """Largest tangential traction.

        Parameters
        ----------
        pressure : float
            Contact pressure.
        slip : float
            Distance slid so far.
        """
        return self.kernel().bound(pressure, slip)[0]


@dataclass(frozen=True)
class Region:
    """Another friction law within a box in the frame of the tool.

    Attributes
    ----------
    lower, upper : array_like, shape (3,)
        Corners; infinite where the box has no end.
    friction : float, Friction or callable
        Law inside the box.

    Examples
    --------
    >>> import umform as uf
    >>> dry = uf.Region(lower=(-5, -50, -50), upper=(5, 50, 50), friction=0.3)
    >>> friction = uf.FrictionByRegion(0.1, [dry])
    """

    lower: ArrayLike
    upper: ArrayLike
    friction: float | Friction | FrictionFunction

    def __post_init__(self) -> None:
        lower, upper = np.asarray(self.lower, dtype=float), np.asarray(self.upper, dtype=float)
        if lower.shape != (3,) or upper.shape != (3,) or not (lower < upper).all():
            raise InvalidFriction(
                "a region of friction is a box with a lower and an upper corner",
                where="friction",
                value=f"{lower.tolist()} to {upper.tolist()}",
                cause="corners exchanged, or not three numbers each",
                remedy="Region((-10, -inf, -inf), (10, inf, inf), 0.05)",
            )


@dataclass(frozen=True)
class FrictionByRegion:
    """Friction that varies over a tool: the first region that contains a point applies.

    Parameters
    ----------
    elsewhere : float, Friction or callable
        Law outside of all regions.
    regions : sequence of Region
        Boxes in the frame of the tool, its initial position.

    Examples
    --------
    >>> import umform as uf
    >>> dry = uf.Region(lower=(-5, -50, -50), upper=(5, 50, 50), friction=0.3)
    >>> model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=210e3, nu=0.3))
    >>> friction = uf.FrictionByRegion(0.1, [dry])
    >>> pair = model.contact("lower", uf.Plane((0, 0, -0.1), (0, 0, 1)), friction=friction)
    """

    elsewhere: float | Friction | FrictionFunction
    regions: Sequence[Region]

    def kernel(self) -> _core.FrictionLaw:
        """The law as the kernels take it."""
        boxes = [
            (
                np.asarray(region.lower, dtype=float).tolist(),
                np.asarray(region.upper, dtype=float).tolist(),
                friction_kernel(region.friction),
            )
            for region in self.regions
        ]
        return _core.friction_by_region(boxes, friction_kernel(self.elsewhere))


AnyFriction = float | Friction | FrictionByRegion | FrictionFunction


def friction_kernel(friction: AnyFriction) -> _core.FrictionLaw:
    """A friction law in the form of the kernels.

    Parameters
    ----------
    friction : float, Friction, FrictionByRegion or callable
        A coefficient, a law, or a function (pressure, distance slid, place) -> largest tangential traction.

    Raises
    ------
    InvalidFriction
        If it is invalid.
    """
    if isinstance(friction, Friction | FrictionByRegion):
        return friction.kernel()
    if callable(friction):
        return _core.friction_from_function(_guarded(friction))
    return Friction(friction).kernel()


def _guarded(function: FrictionFunction) -> Callable[[float, float, Sequence[float]], float]:
    """The function with a clear error for invalid results."""

    def bound(pressure: float, slip: float, z: Sequence[float]) -> float:
        answer = function(pressure, slip, np.array(z))
        try:
            value = float(answer)
        except (TypeError, ValueError):
            value = math.nan
        if not (math.isfinite(value) and value >= 0.0):
            raise NotFinite(
                "a function of friction must give a finite number that is not negative",
                where=f"pressure {pressure:g}, slip {slip:g}, place ({z[0]:g}, {z[1]:g}, {z[2]:g})",
                value=answer,
                cause="a division by zero, or an array instead of a number",
                remedy="return the largest tangential traction, mu * pressure for instance",
            )
        return value

    return bound


def _check_coefficient(mu: float) -> None:
    if math.isfinite(mu) and 0.0 <= mu <= _ROUGHEST:
        return
    raise InvalidFriction(
        "a coefficient of friction lies between 0 and 2",
        where="friction",
        value=mu,
        cause="a sign, a percentage (12 instead of 0.12), or a missing value",
        remedy="0.05 to 0.2 for lubricated steel; no friction at all by leaving it away",
    )

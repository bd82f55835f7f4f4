"""Friction laws: the largest tangential traction as a function of pressure and slip."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from numbers import Real
from typing import Annotated, Any, ClassVar

import numpy as np
from annotated_types import Ge, Gt, Le
from numpy.typing import NDArray

from umform import _core
from umform.errors import InvalidFriction, NotFinite
from umform.spec import About, Checked, check_fields, check_value
from umform.surfaces.directions import as_numbers

#: (pressure, distance slid, position in the frame of the tool) -> largest tangential traction.
FrictionFunction = Callable[[float, float, NDArray[np.float64]], float]
_SIGNATURE = "friction(pressure, slip, place) -> largest tangential traction; place (3,) in the frame of the tool"


def check_table(value: Any, where: str) -> None:
    """Reject a table of friction whose pressures do not ascend, or without valid coefficients."""
    table = as_numbers(value)
    if table.ndim != 2 or table.shape[1:] != (2,) or not len(table):
        raise InvalidFriction(
            "friction is a coefficient or pairs (pressure, coefficient)",
            where=where,
            value=value,
            cause="a list of coefficients, or an empty one",
            remedy="0.12, or [(0, 0.14), (50, 0.10)]",
        )
    pressures, coefficients = table.T
    if not (np.isfinite(pressures).all() and (np.diff(pressures) > 0).all() and pressures[0] >= 0):
        raise InvalidFriction(
            "the pressures of a table of friction must ascend from zero or more",
            where=where,
            value=pressures.tolist(),
            cause="rows out of order, or a row twice",
            remedy="pairs (pressure, coefficient), sorted by pressure",
        )
    for coefficient in coefficients.tolist():
        check_value(Friction, "kinetic", coefficient)


def check_corner(value: Any, where: str) -> None:
    """Reject a corner of a box that is not three numbers; infinite ones are."""
    corner = as_numbers(value)
    if corner.shape != (3,) or np.isnan(corner).any():
        raise InvalidFriction(
            "a region of friction is a box with a lower and an upper corner",
            where=where,
            value=value,
            cause="not three numbers",
            remedy="Region((-10, -inf, -inf), (10, inf, inf), 0.05)",
        )


#: A larger coefficient is more often a mistake of units or sign than a rough tool.
Coefficient = Annotated[
    float,
    Ge(0.0),
    Le(2.0),
    About(
        cause="a sign, a percentage (12 instead of 0.12), or a missing value",
        remedy="0.05 to 0.2 for lubricated steel; leave it out for none",
        error=InvalidFriction,
    ),
]
CoefficientTable = Annotated[Sequence[tuple[float, Coefficient]], Checked(check_table)]
Above = Annotated[float, Gt(0.0), About(cause="a sign, or a missing value", error=InvalidFriction)]
Corner = Annotated[tuple[float, float, float], Checked(check_corner)]


@dataclass(frozen=True)
class Friction:
    """Coulomb's law with options for forming: t <= min(mu p, cap). eq. (4.48)

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

    mu: Coefficient | CoefficientTable
    """Coefficient, or a table of pairs (pressure, coefficient), linear in between and constant beyond its ends."""
    kinetic: Coefficient | None = None
    """Coefficient of a sliding point, approached from mu with the distance slid; with a table its first entry falls to
    it, and all others in proportion; default: mu."""
    decay: Above | None = None
    """Decay: distance slid after which 1 / e of the difference remains; it needs ``kinetic``."""
    cap: Above | None = None
    """Largest tangential traction, for instance the shear strength of the sheet or its coating; default: no limit."""

    def __post_init__(self) -> None:
        check_fields(self)
        if (self.kinetic is None) != (self.decay is None):
            raise InvalidFriction(
                "a kinetic coefficient and the distance of its decay belong together",
                where="kinetic",
                value=f"kinetic {self.kinetic}, decay {self.decay}",
                cause="one of the two is missing",
                remedy="Friction(0.12, kinetic=0.10, decay=0.5)",
            )
        first = self._table()[1][0]
        if self.kinetic is not None and not first > 0:
            raise InvalidFriction(
                "a kinetic coefficient needs a positive one to begin with",
                where="mu",
                value=first,
                cause="no friction at rest",
                remedy="a coefficient above the kinetic one",
            )

    def _table(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        rows = [(0.0, self.mu)] if isinstance(self.mu, Real) else self.mu
        pressures, coefficients = np.array(rows, dtype=float).T
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

    Examples
    --------
    >>> import umform as uf
    >>> dry = uf.Region(lower=(-5, -50, -50), upper=(5, 50, 50), friction=0.3)
    >>> friction = uf.FrictionByRegion(0.1, [dry])
    """

    inside: ClassVar = "friction"

    lower: Corner
    """Lower corner; infinite where the box has no end."""
    upper: Corner
    """Upper corner."""
    friction: float | Friction | FrictionFunction
    """Law inside the box."""

    def __post_init__(self) -> None:
        check_fields(self)
        if not (np.asarray(self.lower) < np.asarray(self.upper)).all():
            raise InvalidFriction(
                "the lower corner of a region of friction must lie below its upper one",
                where="lower",
                value=f"{self.lower} to {self.upper}",
                cause="corners exchanged",
                remedy="Region((-10, -inf, -inf), (10, inf, inf), 0.05)",
            )


@dataclass(frozen=True)
class FrictionByRegion:
    """Friction that varies over a tool: the first region that contains a point applies.

    Examples
    --------
    >>> import umform as uf
    >>> dry = uf.Region(lower=(-5, -50, -50), upper=(5, 50, 50), friction=0.3)
    >>> model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=210e3, nu=0.3))
    >>> friction = uf.FrictionByRegion(0.1, [dry])
    >>> pair = model.contact("lower", uf.Plane((0, 0, -0.1), (0, 0, 1)), friction=friction)
    """

    inside: ClassVar = "elsewhere"

    elsewhere: float | Friction | FrictionFunction
    """Law outside of all regions."""
    regions: Sequence[Region] = ()
    """Boxes in the frame of the tool, its initial position; the first one that contains a point applies."""

    def kernel(self, where: str = "friction") -> _core.FrictionLaw:
        """The law as the kernels take it; ``where`` is the contact, for messages of functions."""
        if not self.regions:
            return friction_kernel(self.elsewhere, where)
        boxes = [
            (
                np.asarray(region.lower, dtype=float).tolist(),
                np.asarray(region.upper, dtype=float).tolist(),
                friction_kernel(region.friction, where),
            )
            for region in self.regions
        ]
        return _core.friction_by_region(boxes, friction_kernel(self.elsewhere, where))


#: A coefficient, a table, a law, or a function.
AnyFriction = Annotated[
    Coefficient | CoefficientTable | Friction | FrictionByRegion | FrictionFunction, About(error=InvalidFriction)
]


def refuse_slip_alone(friction: AnyFriction | None, slip: float | None) -> None:
    """Refuse an allowed elastic slip without friction; a coefficient of zero is friction."""
    if friction is None and slip is not None:
        raise InvalidFriction(
            "an elastic slip is allowed to friction only",
            where="slip",
            value=slip,
            cause="no friction beside it",
            remedy="give friction, or leave slip out",
        )


def friction_kernel(friction: AnyFriction, where: str = "friction") -> _core.FrictionLaw:
    """A friction law in the form of the kernels.

    Parameters
    ----------
    friction : float, Friction, FrictionByRegion or callable
        A coefficient, a law, or a function (pressure, distance slid, place) -> largest tangential traction.
    where : str
        The contact, for messages of a function.

    Raises
    ------
    InvalidFriction
        If it is invalid.
    """
    if isinstance(friction, FrictionByRegion):
        return friction.kernel(where)
    if isinstance(friction, Friction):
        return friction.kernel()
    if callable(friction):
        return _core.friction_from_function(_guarded(friction, where))
    return Friction(friction).kernel()


def _guarded(function: FrictionFunction, where: str) -> Callable[[float, float, Sequence[float]], float]:
    """The function with clear errors: for exceptions in it, and for invalid results."""

    def bound(pressure: float, slip: float, z: Sequence[float]) -> float:
        try:
            answer = function(pressure, slip, np.array(z))
        except Exception as error:
            error.add_note(f"in the friction function of {where}, called as {_SIGNATURE}")
            raise
        try:
            value = float(answer)
        except (TypeError, ValueError):
            value = math.nan
        if not (math.isfinite(value) and value >= 0.0):
            raise NotFinite(
                "a function of friction must give a finite number that is not negative",
                where=f"{where}, pressure {pressure:g}, slip {slip:g}, place ({z[0]:g}, {z[1]:g}, {z[2]:g})",
                value=answer,
                cause="a division by zero, or an array instead of a number",
                remedy=f"return the largest tangential traction, mu * pressure for instance: {_SIGNATURE}",
            )
        return value

    return bound

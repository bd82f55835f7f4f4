"""Hardening curves: yield stress as a function of the accumulated plastic strain.

A class of this file is a curve of Python, of decks and of the command line.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from typing import Annotated, Protocol

from annotated_types import Ge, Gt, Le, MinLen

from umform import _core
from umform.errors import HardeningNotMonotone, InvalidValue
from umform.materials.checks import check_finite
from umform.materials.known import known
from umform.spec import About, OneOf, ParametersInNotebook, Rule, check_fields
from umform.spec.types import NotNegative, Positive

YieldStress = Annotated[
    float,
    Gt(0.0),
    About(cause="a sign, or zero for an elastic material", remedy="SVK or a neo-Hooke for an elastic material"),
]
_SWIFT = About(cause="a sign, per cent, or the three in another order", remedy="Swift(520.0, 0.004, 0.22)")


class Hardening(Protocol):
    """Yield stress as a function of the accumulated plastic strain."""

    def curve(self) -> _core.Hardening:
        """The curve as the kernels take it."""


#: One of the curves; the word ``curve`` of a deck names it.
Curve = Annotated[
    Hardening,
    Rule(
        lambda curve: callable(getattr(curve, "curve", None)) and not isinstance(curve, type),
        "hardening must be a hardening curve",
        cause="a number, or the name of a curve in place of a curve",
        remedy="Perfect(160.0) or another of Linear, Voce, LinearVoce, Swift, Table",
    ),
    Rule(
        lambda curve: isinstance(curve.curve(), _core.Hardening),
        "curve() of a hardening curve must return what the kernels take",
        cause="an object such as Table, or nothing",
        remedy="return uf.Table(...).curve()",
    ),
    OneOf("curve", partial(known, Hardening)),
]

#: Points of a table up to which its repr has all of them.
_FEW = 8


@dataclass(frozen=True)
class LinearVoce(ParametersInNotebook, Hardening):
    """Linear and Voce hardening: y = yield_stress + modulus e + (saturation - yield_stress)(1 - exp(-rate e)).

    Examples
    --------
    >>> import umform as uf
    >>> curve = uf.LinearVoce(yield_stress=125.0, modulus=100.0, saturation=290.0, rate=12.0)
    >>> aluminium = uf.J2(E=70e3, nu=0.33, hardening=curve)
    """

    yield_stress: YieldStress
    """Initial yield stress."""
    modulus: NotNegative
    """Slope of the linear part, a stress."""
    saturation: Positive
    """Saturation stress of the Voce part, not below the initial yield stress."""
    rate: NotNegative
    """Rate of saturation of the Voce part, dimensionless."""

    def __post_init__(self) -> None:
        least = {"modulus": 0.0, "rate": 0.0, "saturation": self.yield_stress}
        for name, value in {name: getattr(self, name) for name in least}.items():
            if value < least[name] and self.yield_stress > 0.0:
                raise HardeningNotMonotone(
                    "the yield stress must not fall",
                    where=name,
                    value=value,
                    cause="softening needs a length scale that this law does not have",
                    remedy="modulus and rate >= 0, saturation >= yield_stress",
                )
        check_fields(self)

    def curve(self) -> _core.Hardening:
        """The curve as the kernels take it."""
        return _core.linear_voce(self.yield_stress, self.modulus, self.saturation, self.rate)


@dataclass(frozen=True)
class Perfect(LinearVoce):
    """Perfect plasticity: y = yield_stress.

    Examples
    --------
    >>> import umform as uf
    >>> lead = uf.J2(E=16e3, nu=0.44, hardening=uf.Perfect(12.0))
    """

    modulus: float = field(default=0.0, init=False, repr=False)
    saturation: float = field(init=False, repr=False)
    rate: float = field(default=0.0, init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "saturation", self.yield_stress)
        super().__post_init__()


@dataclass(frozen=True)
class Linear(LinearVoce):
    """Linear hardening: y = yield_stress + modulus e.

    Examples
    --------
    >>> import umform as uf
    >>> steel = uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(yield_stress=160.0, modulus=500.0))
    """

    modulus: NotNegative
    """Slope over the plastic strain, a stress."""
    saturation: float = field(init=False, repr=False)
    rate: float = field(default=0.0, init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "saturation", self.yield_stress)
        super().__post_init__()


@dataclass(frozen=True)
class Voce(LinearVoce):
    """Voce hardening: y = saturation - (saturation - yield_stress) exp(-rate e).

    Examples
    --------
    >>> import umform as uf
    >>> aluminium = uf.J2(E=70e3, nu=0.33, hardening=uf.Voce(yield_stress=125.0, saturation=290.0, rate=12.0))
    """

    modulus: float = field(default=0.0, init=False, repr=False)
    saturation: Positive
    """Saturation stress, not below the initial yield stress."""
    rate: NotNegative
    """Rate of saturation, dimensionless."""


@dataclass(frozen=True)
class Swift(ParametersInNotebook, Hardening):
    """Swift hardening: y = strength (offset + e)^exponent.

    Examples
    --------
    >>> import umform as uf
    >>> steel = uf.J2(E=210e3, nu=0.3, hardening=uf.Swift(strength=520.0, offset=0.004, exponent=0.2))
    """

    strength: Annotated[Positive, _SWIFT]
    """K, a stress."""
    offset: Annotated[Positive, _SWIFT]
    """e0, a plastic strain."""
    exponent: Annotated[float, Ge(0.0), Le(1.0), _SWIFT]
    """n."""

    def __post_init__(self) -> None:
        check_fields(self)

    def curve(self) -> _core.Hardening:
        """The curve as the kernels take it."""
        return _core.swift(self.strength, self.offset, self.exponent)


@dataclass(frozen=True)
class Table(ParametersInNotebook, Hardening):
    """Piecewise linear curve through measured points, constant beyond the last one.

    Examples
    --------
    >>> import umform as uf
    >>> curve = uf.Table(eqps=(0.0, 0.05, 0.2, 0.5), stress=(186.0, 275.0, 368.0, 442.0))
    >>> steel = uf.J2(E=210e3, nu=0.3, hardening=curve)
    """

    eqps: Annotated[tuple[float, ...], MinLen(2)]
    """Plastic strains, increasing from 0."""
    stress: Annotated[tuple[float, ...], MinLen(2)]
    """Yield stresses, not decreasing."""

    def __post_init__(self) -> None:
        for name in ("eqps", "stress"):
            try:
                object.__setattr__(self, name, tuple(float(value) for value in getattr(self, name)))
            except (TypeError, ValueError):
                raise InvalidValue(
                    "a hardening table has a column of numbers for strains and one for stresses",
                    where=f"Table, {name}",
                    value=getattr(self, name),
                    cause="a single number, or words such as the head of a column",
                    remedy="Table(eqps=(0.0, 0.1, 0.3), stress=(200.0, 300.0, 350.0))",
                ) from None
        if len(self.eqps) != len(self.stress) or len(self.eqps) < 2:
            raise InvalidValue(
                "a hardening table needs two or more pairs",
                where="Table",
                value=f"{len(self.eqps)} strains, {len(self.stress)} stresses",
                cause="columns of different length, or one point only",
                remedy="one stress for each plastic strain; Perfect for a constant one",
            )
        for row, (e, s) in enumerate(zip(self.eqps, self.stress, strict=True)):
            check_finite(f"Table, row {row}", eqps=e, stress=s)
            if row and (e <= self.eqps[row - 1] or s < self.stress[row - 1]):
                raise HardeningNotMonotone(
                    "a hardening table must rise: plastic strain strictly, stress not falling",
                    where=f"Table, row {row}",
                    value=f"({self.eqps[row - 1]}, {self.stress[row - 1]}) -> ({e}, {s})",
                    cause="noise of a measured curve, or points behind necking",
                    remedy="smooth the curve, or fit Swift or Voce to it",
                )
        if self.eqps[0] != 0.0:
            raise InvalidValue(
                "a hardening table starts at plastic strain 0",
                where="Table, row 0",
                value=self.eqps[0],
                cause="the curve of a tensile test as it was measured",
                remedy="give the plastic strain, not the total one",
            )
        Perfect(self.stress[0])

    def __repr__(self) -> str:
        if len(self.eqps) <= _FEW:
            return f"Table(eqps={self.eqps}, stress={self.stress})"
        ranges = (f"{name} {values[0]:.6g} to {values[-1]:.6g}" for name, values in vars(self).items())
        return f"Table({len(self.eqps)} points: {', '.join(ranges)})"

    def curve(self) -> _core.Hardening:
        """The curve as the kernels take it."""
        return _core.tabulated(list(self.eqps), list(self.stress))

"""Hardening curves: yield stress as a function of the accumulated plastic strain."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from umform import _core
from umform.errors import HardeningNotMonotone, InvalidValue
from umform.materials.checks import check_finite


class Hardening(Protocol):
    """Yield stress as a function of the accumulated plastic strain."""

    def curve(self) -> _core.Hardening:
        """The curve as the kernels take it."""


def _check_yield(where: str, yield_stress: float) -> None:
    if not yield_stress > 0:
        raise InvalidValue(
            "the yield stress must be positive",
            where=where,
            value=yield_stress,
            cause="a sign, or zero for an elastic material",
            remedy="SVK or a neo-Hooke for an elastic material",
        )


@dataclass(frozen=True)
class LinearVoce:
    """y = y0 + H e + (y_inf - y0)(1 - exp(-d e)).

    Parameters
    ----------
    yield_stress : float
        y0.
    modulus : float
        H, not negative.
    saturation : float
        y_inf, not below y0.
    rate : float
        d, not negative.

    Examples
    --------
    >>> import umform as uf
    >>> curve = uf.LinearVoce(yield_stress=125.0, modulus=100.0, saturation=290.0, rate=12.0)
    >>> aluminium = uf.J2(E=70e3, nu=0.33, hardening=curve)
    """

    yield_stress: float
    modulus: float
    saturation: float
    rate: float

    def __post_init__(self) -> None:
        where = type(self).__name__
        check_finite(
            where, yield_stress=self.yield_stress, modulus=self.modulus, saturation=self.saturation, rate=self.rate
        )
        _check_yield(where, self.yield_stress)
        if self.modulus < 0 or self.rate < 0 or self.saturation < self.yield_stress:
            raise HardeningNotMonotone(
                "the yield stress must not fall",
                where=where,
                value=self,
                cause="softening needs a length scale that this law does not have",
                remedy="modulus and rate >= 0, saturation >= yield_stress",
            )

    def curve(self) -> _core.Hardening:
        """The curve as the kernels take it."""
        return _core.linear_voce(self.yield_stress, self.modulus, self.saturation, self.rate)


def Perfect(yield_stress: float) -> LinearVoce:
    """Perfect plasticity: y = y0.

    Parameters
    ----------
    yield_stress : float
        y0, a stress.

    Returns
    -------
    LinearVoce

    Examples
    --------
    >>> import umform as uf
    >>> lead = uf.J2(E=16e3, nu=0.44, hardening=uf.Perfect(12.0))
    """
    return LinearVoce(yield_stress, 0.0, yield_stress, 0.0)


def Linear(yield_stress: float, modulus: float) -> LinearVoce:
    """Linear hardening: y = y0 + H e.

    Parameters
    ----------
    yield_stress : float
        y0, a stress.
    modulus : float
        H, a stress, not negative.

    Returns
    -------
    LinearVoce

    Examples
    --------
    >>> import umform as uf
    >>> steel = uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(yield_stress=160.0, modulus=500.0))
    """
    return LinearVoce(yield_stress, modulus, yield_stress, 0.0)


def Voce(yield_stress: float, saturation: float, rate: float) -> LinearVoce:
    """Voce hardening: y = y_inf - (y_inf - y0) exp(-d e).

    Parameters
    ----------
    yield_stress : float
        y0, a stress.
    saturation : float
        y_inf, a stress, not below y0.
    rate : float
        d, dimensionless, not negative.

    Returns
    -------
    LinearVoce

    Examples
    --------
    >>> import umform as uf
    >>> aluminium = uf.J2(E=70e3, nu=0.33, hardening=uf.Voce(yield_stress=125.0, saturation=290.0, rate=12.0))
    """
    return LinearVoce(yield_stress, 0.0, saturation, rate)


@dataclass(frozen=True)
class Swift:
    """y = K (e0 + e)^n.

    Parameters
    ----------
    strength : float
        K.
    offset : float
        e0, positive.
    exponent : float
        n, between 0 and 1.

    Examples
    --------
    >>> import umform as uf
    >>> steel = uf.J2(E=210e3, nu=0.3, hardening=uf.Swift(strength=520.0, offset=0.004, exponent=0.2))
    """

    strength: float
    offset: float
    exponent: float

    def __post_init__(self) -> None:
        check_finite("Swift", strength=self.strength, offset=self.offset, exponent=self.exponent)
        if not self.strength > 0 or not self.offset > 0 or not 0 <= self.exponent <= 1:
            raise InvalidValue(
                "K and e0 must be positive and n between 0 and 1",
                where="Swift",
                value=self,
                cause="a sign, per cent, or the three in another order",
                remedy="Swift(strength=520.0, offset=0.004, exponent=0.22)",
            )

    def curve(self) -> _core.Hardening:
        """The curve as the kernels take it."""
        return _core.swift(self.strength, self.offset, self.exponent)


@dataclass(frozen=True)
class Table:
    """Piecewise linear table of points (eqps, stress), constant beyond its end.

    Parameters
    ----------
    eqps : tuple of float
        Plastic strains from 0, increasing.
    stress : tuple of float
        Yield stresses, not decreasing.

    Examples
    --------
    >>> import umform as uf
    >>> curve = uf.Table(eqps=(0.0, 0.05, 0.2, 0.5), stress=(186.0, 275.0, 368.0, 442.0))
    >>> steel = uf.J2(E=210e3, nu=0.3, hardening=curve)
    """

    eqps: tuple[float, ...]
    stress: tuple[float, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "eqps", tuple(float(e) for e in self.eqps))
        object.__setattr__(self, "stress", tuple(float(s) for s in self.stress))
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
        _check_yield("Table, row 0", self.stress[0])

    def curve(self) -> _core.Hardening:
        """The curve as the kernels take it."""
        return _core.tabulated(list(self.eqps), list(self.stress))

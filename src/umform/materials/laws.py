"""Material laws and hardening curves: frozen descriptions that make the kernels' laws.

Elastic constants are given as E and nu, or as kappa and mu. Stresses in any unit, as long as it is that of the model.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from umform import _core
from umform.errors import HardeningNotMonotone, InvalidValue, NotFinite


def _finite(where: str, **values: float) -> None:
    for name, value in values.items():
        if not math.isfinite(value):
            raise NotFinite(
                f"{name} is not a finite number",
                where=where,
                value=value,
                cause="an earlier computation, or an empty cell of a table",
                remedy="give a finite number",
            )


@dataclass(frozen=True, init=False)
class Elastic:
    """Isotropic elastic constants.

    Parameters
    ----------
    E, nu : float
        Young's modulus and Poisson's ratio, or
    kappa, mu : float
        bulk and shear modulus.

    Raises
    ------
    InvalidValue
        If not exactly one pair is given, or the pair is not that of a stable solid.
    """

    kappa: float
    mu: float

    def __init__(
        self, E: float | None = None, nu: float | None = None, *, kappa: float | None = None, mu: float | None = None
    ) -> None:
        where = type(self).__name__
        if E is not None and nu is not None and kappa is None and mu is None:
            _finite(where, E=E, nu=nu)
            if not E > 0 or not -1 < nu < 0.5:
                raise InvalidValue(
                    "E must be positive and nu between -1 and 0.5",
                    where=where,
                    value=f"E={E}, nu={nu}",
                    cause="a sign, a stress in place of a ratio, or the two exchanged",
                    remedy="nearly incompressible: nu = 0.4999",
                )
            kappa, mu = E / (3 * (1 - 2 * nu)), E / (2 * (1 + nu))
        elif kappa is not None and mu is not None and E is None and nu is None:
            _finite(where, kappa=kappa, mu=mu)
            if not kappa > 0 or not mu > 0:
                raise InvalidValue(
                    "kappa and mu must be positive",
                    where=where,
                    value=f"kappa={kappa}, mu={mu}",
                    cause="a sign, or Lamé's constants in place of the moduli",
                    remedy="kappa = lambda + 2 mu / 3; or give E and nu",
                )
        else:
            raise InvalidValue(
                "give E and nu, or kappa and mu",
                where=where,
                cause="one of a pair is missing, or both pairs are given",
                remedy="two constants: J2(E=210e3, nu=0.3, ...) for one",
            )
        object.__setattr__(self, "kappa", float(kappa))
        object.__setattr__(self, "mu", float(mu))

    @property
    def lambda_(self) -> float:
        """Lamé's first constant."""
        return self.kappa - 2.0 / 3.0 * self.mu

    @property
    def E(self) -> float:
        """Young's modulus."""
        return 9 * self.kappa * self.mu / (3 * self.kappa + self.mu)

    @property
    def nu(self) -> float:
        """Poisson's ratio."""
        return (3 * self.kappa - 2 * self.mu) / (2 * (3 * self.kappa + self.mu))


@runtime_checkable
class Material(Protocol):
    """What a model asks of a material: the law of the kernels, and how many thickness points suit it."""

    @property
    def thickness_points(self) -> int:
        """Default number of Gauss points through the thickness."""

    def law(self) -> _core.Material:
        """The law as the kernels take it."""


class SVK(Elastic):
    """St. Venant-Kirchhoff: S = lambda tr(E) 1 + 2 mu E. For small strains; it softens in strong compression."""

    thickness_points = 2

    def law(self) -> _core.Material:
        """The law as the kernels take it."""
        return _core.saint_venant_kirchhoff(self.lambda_, self.mu)


class NeoHooke(Elastic):
    """Compressible neo-Hooke, logarithmic form: W = mu/2 (I1 - 3) - mu ln J + lambda/2 ln² J."""

    thickness_points = 2

    def law(self) -> _core.Material:
        """The law as the kernels take it."""
        return _core.neo_hooke_logarithmic(self.lambda_, self.mu)


class NeoHookePower(Elastic):
    """Compressible neo-Hooke, power form: W = c (I1 - 3) + c/beta (I3^-beta - 1), c = mu/2, beta = nu/(1 - 2 nu)."""

    thickness_points = 2

    def law(self) -> _core.Material:
        """The law as the kernels take it."""
        return _core.neo_hooke_power(self.mu, self.nu / (1 - 2 * self.nu))


# Hardening ---------------------------------------------------------------------------------------------------


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
    """

    yield_stress: float
    modulus: float
    saturation: float
    rate: float

    def __post_init__(self) -> None:
        where = type(self).__name__
        _finite(where, yield_stress=self.yield_stress, modulus=self.modulus, saturation=self.saturation, rate=self.rate)
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
    """Perfect plasticity: y = y0."""
    return LinearVoce(yield_stress, 0.0, yield_stress, 0.0)


def Linear(yield_stress: float, modulus: float) -> LinearVoce:
    """Linear hardening: y = y0 + H e."""
    return LinearVoce(yield_stress, modulus, yield_stress, 0.0)


def Voce(yield_stress: float, saturation: float, rate: float) -> LinearVoce:
    """Voce hardening: y = y_inf - (y_inf - y0) exp(-d e)."""
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
    """

    strength: float
    offset: float
    exponent: float

    def __post_init__(self) -> None:
        _finite("Swift", strength=self.strength, offset=self.offset, exponent=self.exponent)
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
    """Straight lines between the points (eqps, stress) of a table, constant behind its end.

    Parameters
    ----------
    eqps : tuple of float
        Plastic strains from 0, increasing.
    stress : tuple of float
        Yield stresses, not decreasing.
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
            _finite(f"Table, row {row}", eqps=e, stress=s)
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


@dataclass(frozen=True, init=False)
class J2(Elastic):
    """Finite-strain J2 plasticity in logarithmic elastic strains, multiplicative split (docs/theory, chapter 3).

    Parameters
    ----------
    E, nu, kappa, mu : float
        Elastic constants, see :class:`Elastic`.
    hardening : Hardening
        Perfect, Linear, Voce, LinearVoce, Swift or Table.
    """

    hardening: Hardening

    def __init__(
        self,
        E: float | None = None,
        nu: float | None = None,
        *,
        kappa: float | None = None,
        mu: float | None = None,
        hardening: Hardening,
    ) -> None:
        super().__init__(E, nu, kappa=kappa, mu=mu)
        if not callable(getattr(hardening, "curve", None)) or isinstance(hardening, type):
            raise InvalidValue(
                "hardening must be a hardening curve",
                where="J2",
                value=hardening,
                cause="a number, or the name of a curve in place of a curve",
                remedy="Perfect(160.0) or another of Linear, Voce, LinearVoce, Swift, Table",
            )
        object.__setattr__(self, "hardening", hardening)

    thickness_points = 5

    def law(self) -> _core.Material:
        """The law as the kernels take it."""
        return _core.j2(self.kappa, self.mu, self.hardening.curve())

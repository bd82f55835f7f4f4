"""Yield functions: equivalent stress, homogeneous of degree one, in the axes of the sheet (docs/theory, 3.11)."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Protocol, Self

import numpy as np

from umform import _core
from umform.errors import InvalidValue
from umform.materials.checks import check_finite


class YieldFunction(Protocol):
    """Equivalent stress as a function of the stress; axis 1 is the rolling direction, 3 the normal of the sheet."""

    @property
    def directional(self) -> bool:
        """Whether it depends on the rolling direction."""

    def function(self) -> _core.YieldFunction:
        """The function as the kernels take it."""


@dataclass(frozen=True)
class Mises:
    """Von Mises: isotropic.

    Examples
    --------
    >>> import umform as uf
    >>> stress, r = uf.sheet_metals.uniaxial(uf.Mises(), 45.0)
    >>> round(float(stress), 6), round(float(r), 6)
    (1.0, 1.0)
    """

    directional = False

    def function(self) -> _core.YieldFunction:
        """The function as the kernels take it."""
        return _core.hill48(0.5, 0.5, 0.5, 1.5, 1.5, 1.5)


@dataclass(frozen=True, init=False)
class Hill48:
    """Hill (1948) from r-values; the hardening curve is that of the rolling direction. See ``from_stresses``.

    Parameters
    ----------
    r0, r45, r90 : float
        Ratio of the plastic strains over the width and over the thickness in tension along, at 45 degrees to and across
        the rolling direction.

    Examples
    --------
    >>> import umform as uf
    >>> stress, r = uf.sheet_metals.uniaxial(uf.Hill48(r0=1.8, r45=1.4, r90=2.1), 90.0)
    >>> round(float(r), 6)
    2.1
    """

    F: float
    G: float
    H: float
    L: float
    M: float
    N: float

    directional = True

    def __init__(self, r0: float, r45: float, r90: float) -> None:
        check_finite("Hill48", r0=r0, r45=r45, r90=r90)
        for name, r in (("r0", r0), ("r45", r45), ("r90", r90)):
            if not r > 0:
                raise InvalidValue(
                    f"{name} must be positive",
                    where="Hill48",
                    value=r,
                    cause="a sign, or the change of a strain in place of a ratio",
                    remedy="r = strain over the width / strain over the thickness: 0.2 to 3 for sheet metals",
                )
        G = 1.0 / (1.0 + r0)
        F = r0 * G / r90
        self._set(F, G, r0 * G, 1.5, 1.5, (F + G) * (0.5 + r45))

    def _set(self, *constants: float) -> None:
        for part, constant in zip(fields(self), constants, strict=True):
            object.__setattr__(self, part.name, constant)

    @classmethod
    def from_stresses(cls, s0: float, s45: float, s90: float, biaxial: float) -> Self:
        """The function from four yield stresses, relative to that of the hardening curve.

        Parameters
        ----------
        s0, s45, s90 : float
            Yield stress in tension at 0, 45 and 90 degrees to the rolling direction, relative to that of the curve.
        biaxial : float
            Yield stress in equibiaxial tension, relative to that of the curve.

        Raises
        ------
        InvalidValue
            If a stress is not positive, or no convex function of Hill has these yield stresses.
        """
        given = {"s0": s0, "s45": s45, "s90": s90, "biaxial": biaxial}
        check_finite("Hill48", **given)
        for name, stress in given.items():
            if not stress > 0:
                raise InvalidValue(
                    f"{name} must be positive",
                    where="Hill48.from_stresses",
                    value=stress,
                    cause="a sign",
                    remedy="a yield stress over that of the hardening curve, about 1",
                )
        a, b, c = 1 / s0**2, 1 / s90**2, 1 / biaxial**2
        F, G, H = (b + c - a) / 2, (a + c - b) / 2, (a + b - c) / 2
        N = 2 / s45**2 - (F + G) / 2
        if not (N > 0 and F * G + G * H + H * F > 0 and F + G > 0):
            raise InvalidValue(
                "Hill's function through these stresses is not convex",
                where="Hill48.from_stresses",
                value=given,
                cause="a stress that is not over that of the curve, or differences beyond what the function can follow",
                remedy="stresses near 1; or Hill48 from r-values, or Yld2004",
            )
        made = cls.__new__(cls)
        made._set(F, G, H, 1.5, 1.5, N)
        return made

    @classmethod
    def from_constants(cls, F: float, G: float, H: float, N: float, L: float = 1.5, M: float = 1.5) -> Self:
        """The function from Hill's constants; 0.5 (F, G, H) and 1.5 (N) give von Mises.

        Raises
        ------
        InvalidValue
            If the function is not convex.
        """
        check_finite("Hill48", F=F, G=G, H=H, L=L, M=M, N=N)
        if not (min(L, M, N, F + G) > 0 and F * G + G * H + H * F > 0):
            raise InvalidValue(
                "Hill's function with these constants is not convex",
                where="Hill48.from_constants",
                value={"F": F, "G": G, "H": H, "L": L, "M": M, "N": N},
                cause="a sign, or constants in another order",
                remedy="F, G, H about 0.5 and L, M, N about 1.5",
            )
        made = cls.__new__(cls)
        made._set(F, G, H, L, M, N)
        return made

    @property
    def r_values(self) -> tuple[float, float, float]:
        """r-values along, at 45 degrees to and across the rolling direction."""
        return self.H / self.G, self.N / (self.F + self.G) - 0.5, self.H / self.F

    def function(self) -> _core.YieldFunction:
        """The function as the kernels take it."""
        return _core.hill48(self.F, self.G, self.H, self.L, self.M, self.N)


@dataclass(frozen=True)
class Transformation:
    """Linear map of the stress deviator, orthotropic about the axes of the sheet: 11 is the rolling direction.

    S_11 = -c12 s_22 - c13 s_33, S_22 = -c21 s_11 - c23 s_33, S_33 = -c31 s_11 - c32 s_22, and a factor for each shear.
    Tables in the literature call the shears c44, c55, c66, which are 23, 13, 12; here they are named by their axes.

    Examples
    --------
    >>> import umform as uf
    >>> softer_in_shear = uf.Transformation(shear12=0.9)
    >>> function = uf.Yld2004(softer_in_shear, softer_in_shear, exponent=8)
    """

    c12: float = 1.0
    c13: float = 1.0
    c21: float = 1.0
    c23: float = 1.0
    c31: float = 1.0
    c32: float = 1.0
    shear12: float = 1.0
    shear23: float = 1.0
    shear13: float = 1.0

    def __post_init__(self) -> None:
        check_finite("Transformation", **{part.name: getattr(self, part.name) for part in fields(self)})

    @property
    def coefficients(self) -> list[float]:
        """All nine coefficients, in the order of the kernels."""
        return [getattr(self, part.name) for part in fields(self)]


@dataclass(frozen=True)
class Yld2004:
    """Yld2004-18p of Barlat et al. (2005): ``sum_ij |S'_i - S''_j|^a = 4 phi^a``.

    S' and S'' are the principal values of two transformed stresses.

    Parameters
    ----------
    first, second : Transformation
        S' and S''.
    exponent : float
        From 2 to 20: 6 for bcc metals, 8 for fcc metals. Even exponents need no principal values and are faster.

    Examples
    --------
    >>> import umform as uf
    >>> function = uf.Yld2004(uf.Transformation(c12=0.9), uf.Transformation(c21=1.1), exponent=8)
    >>> aluminium = uf.Metal(70e3, 0.33, hardening=uf.Voce(125.0, 290.0, 12.0), yield_function=function)
    """

    first: Transformation
    second: Transformation
    exponent: float = 8

    def __post_init__(self) -> None:
        _check_exponent(type(self).__name__, self.exponent)
        function = self.function()
        for stress in np.eye(6)[[0, 1, 3, 4, 5]]:
            if not function(stress)[0] > 1e-3:
                raise InvalidValue(
                    "the yield function is zero for a stress: there it never flows",
                    where=type(self).__name__,
                    value=f"stress {stress.tolist()}, both transformations vanish",
                    cause="coefficients that were left out, or in another order",
                    remedy="coefficients near 1; shears are named by their axes",
                )

    @property
    def directional(self) -> bool:
        """Whether it depends on the rolling direction."""
        return self.first != Transformation() or self.second != Transformation()

    def function(self) -> _core.YieldFunction:
        """The function as the kernels take it."""
        return _core.yld2004(self.exponent, self.first.coefficients, self.second.coefficients)


def Hosford(exponent: float = 8) -> Yld2004:
    """Hosford (1972): ``|s1 - s2|^a + |s2 - s3|^a + |s3 - s1|^a = 2 phi^a`` of principal stresses, isotropic.

    Examples
    --------
    >>> import umform as uf
    >>> aluminium = uf.Metal(70e3, 0.33, hardening=uf.Voce(125.0, 290.0, 12.0), yield_function=uf.Hosford(8))
    """
    return Yld2004(Transformation(), Transformation(), exponent)


def Yld91(
    a: float, b: float, c: float, f: float = 1.0, g: float = 1.0, h: float = 1.0, *, exponent: float = 8
) -> Yld2004:
    """Barlat's Yld91: Hosford's function of a transformed stress.

    Parameters
    ----------
    a, b, c : float
        Factors of s22 - s33, s33 - s11 and s11 - s22; 1 for an isotropic metal.
    f, g, h : float
        Factors of the shears 23, 13 and 12.
    exponent : float
        From 2 to 20.

    Examples
    --------
    >>> import umform as uf
    >>> stress, r = uf.sheet_metals.uniaxial(uf.Yld91(1.0, 1.0, 1.0, exponent=8), 30.0)
    >>> round(float(stress), 6), round(float(r), 6)
    (1.0, 1.0)
    """
    check_finite("Yld91", a=a, b=b, c=c, f=f, g=g, h=h)
    if min(a, b, c, f, g, h) <= 0.0:
        raise InvalidValue(
            "the factors of Yld91 must be positive",
            where="Yld91",
            value=(a, b, c, f, g, h),
            cause="a sign, or one that was left out",
            remedy="factors near 1",
        )
    c12, c13, c21, c23 = (b + 2 * c) / 3, (2 * b + c) / 3, (a + 2 * c) / 3, (2 * a + c) / 3
    both = Transformation(c12, c13, c21, c23, (a + 2 * b) / 3, (2 * a + b) / 3, shear12=h, shear23=f, shear13=g)
    return Yld2004(both, both, exponent)


def _check_exponent(where: str, exponent: float) -> None:
    if not 2 <= exponent <= 20:
        raise InvalidValue(
            "the exponent must be from 2 to 20",
            where=where,
            value=exponent,
            cause="a sign, or another number in its place",
            remedy="6 for bcc metals such as steel, 8 for fcc metals such as aluminium",
        )

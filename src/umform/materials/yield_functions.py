"""Yield functions: equivalent stress, homogeneous of degree one, in the axes of the sheet (docs/theory, 3.11).

A class of this file is a yield function of Python and of decks.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass, field, fields
from functools import partial
from typing import Annotated, Protocol, Self

import numpy as np
from annotated_types import Ge, Gt, Le

from umform import _core
from umform.errors import InvalidValue
from umform.materials.known import known
from umform.spec import About, OneOf, ParametersInNotebook, Rule, check_fields
from umform.spec.types import FOLLOWS, Positive

Exponent = Annotated[
    float,
    Ge(2.0),
    Le(20.0),
    About(
        cause="a sign, or another number in its place",
        remedy="6 for bcc metals such as steel, 8 for fcc metals such as aluminium",
    ),
]


class YieldFunction(Protocol):
    """Equivalent stress as a function of the stress; axis 1 is the rolling direction, 3 the normal of the sheet."""

    @property
    def directional(self) -> bool:
        """Whether it depends on the rolling direction."""

    def function(self) -> _core.YieldFunction:
        """The function as the kernels take it."""


#: One of the functions; the word ``function`` of a deck names it.
Function = Annotated[
    YieldFunction,
    Rule(
        lambda function: callable(getattr(function, "function", None)) and not isinstance(function, type),
        "yield_function must be a yield function",
        cause="its name, or its class in place of one",
        remedy="Hill48(r0=1.8, r45=1.5, r90=2.2) or another of Mises, Hosford, Yld91, Yld2004",
    ),
    Rule(
        lambda function: isinstance(function.function(), _core.YieldFunction),
        "function() of a yield function must return what the kernels take",
        cause="an object such as Hill48, or nothing",
        remedy="return uf.Hill48(...).function()",
    ),
    OneOf("function", partial(known, YieldFunction)),
]


@dataclass(frozen=True)
class Mises(ParametersInNotebook, YieldFunction):
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


_Ratio = Annotated[
    float,
    Gt(0.0),
    About(
        cause="a sign, or the change of a strain in place of a ratio",
        remedy="r = strain over the width / strain over the thickness: 0.2 to 3 for sheet metals",
    ),
]
_Relative = Annotated[
    float, Gt(0.0), About(cause="a sign", remedy="a yield stress over that of the hardening curve, about 1")
]
_SETS = (("r0", "r45", "r90"), ("s0", "s45", "s90", "biaxial"), ("F", "G", "H", "N"))


@dataclass(frozen=True)
class Hill48(ParametersInNotebook, YieldFunction):
    """Hill (1948) from three r-values, four yield stresses relative to the hardening curve, or Hill's constants.

    With r-values the hardening curve is that of the rolling direction. 0.5 (F, G, H) and 1.5 (L, M, N) give von Mises.

    Raises
    ------
    InvalidValue
        If the parameters are not one of the three sets, or if no convex function of Hill has them.

    Examples
    --------
    >>> import umform as uf
    >>> stress, r = uf.sheet_metals.uniaxial(uf.Hill48(r0=1.8, r45=1.4, r90=2.1), 90.0)
    >>> round(float(r), 6)
    2.1
    """

    r0: _Ratio = field(default=FOLLOWS, repr=False, compare=False)
    """r-value along the rolling direction: ratio of width to thickness strain in tension."""
    r45: _Ratio = field(default=FOLLOWS, repr=False, compare=False)
    """r-value at 45 degrees to it."""
    r90: _Ratio = field(default=FOLLOWS, repr=False, compare=False)
    """r-value across it."""
    _: KW_ONLY
    s0: _Relative = field(default=FOLLOWS, repr=False, compare=False)
    """Yield stress along the rolling direction, relative to that of the curve."""
    s45: _Relative = field(default=FOLLOWS, repr=False, compare=False)
    """Yield stress at 45 degrees to it."""
    s90: _Relative = field(default=FOLLOWS, repr=False, compare=False)
    """Yield stress across it."""
    biaxial: _Relative = field(default=FOLLOWS, repr=False, compare=False)
    """Yield stress in equibiaxial tension."""
    F: float = FOLLOWS
    """Constant of (s22 - s33)^2."""
    G: float = FOLLOWS
    """Constant of (s33 - s11)^2."""
    H: float = FOLLOWS
    """Constant of (s11 - s22)^2."""
    L: Positive = FOLLOWS
    """Constant of 2 s23^2; 1.5 by default."""
    M: Positive = FOLLOWS
    """Constant of 2 s13^2; 1.5 by default."""
    N: Positive = FOLLOWS
    """Constant of 2 s12^2."""

    directional = True

    def __post_init__(self) -> None:
        check_fields(self)
        given = {one.name for one in fields(self) if getattr(self, one.name) is not None}
        chosen = [names for names in _SETS if given - ({"L", "M"} if "N" in names else set()) == set(names)]
        if not chosen:
            raise InvalidValue(
                "give r0, r45 and r90, or s0, s45, s90 and biaxial, or F, G, H and N, and no others",
                where="Hill48",
                value=", ".join(sorted(given)),
                cause="one of a set is missing, or two sets are given",
                remedy="Hill48(r0=1.8, r45=1.5, r90=2.2)",
            )
        if "r0" in given:
            self._set(**_of_ratios(self.r0, self.r45, self.r90))
        elif "s0" in given:
            self._set(**_of_stresses(self.s0, self.s45, self.s90, self.biaxial))
        self._set(L=self.L or 1.5, M=self.M or 1.5)
        F, G, H, N = self.F, self.G, self.H, self.N
        if not (min(N, F + G) > 0 and F * G + G * H + H * F > 0):
            raise InvalidValue(
                "Hill's function with these parameters is not convex",
                where="Hill48",
                value={name: getattr(self, name) for name in chosen[0]},
                cause="a sign, another order, or differences beyond what the function can follow",
                remedy="stresses near 1; F, G, H about 0.5 and L, M, N about 1.5; or Yld2004",
            )

    def _set(self, **constants: float) -> None:
        for name, constant in constants.items():
            object.__setattr__(self, name, constant)

    @classmethod
    def from_stresses(cls, s0: float, s45: float, s90: float, biaxial: float) -> Self:
        """The function from four yield stresses, relative to that of the hardening curve."""
        return cls(s0=s0, s45=s45, s90=s90, biaxial=biaxial)

    @classmethod
    def from_constants(cls, F: float, G: float, H: float, N: float, L: float = 1.5, M: float = 1.5) -> Self:
        """The function from Hill's constants."""
        return cls(F=F, G=G, H=H, N=N, L=L, M=M)

    @property
    def r_values(self) -> tuple[float, float, float]:
        """r-values along, at 45 degrees to and across the rolling direction."""
        return self.H / self.G, self.N / (self.F + self.G) - 0.5, self.H / self.F

    def written(self) -> Mapping[str, float | None]:
        """None for the constants of a function that was made from r-values or stresses."""
        return dict.fromkeys("FGHLMN") if any((self.r0, self.s0)) else {}

    def function(self) -> _core.YieldFunction:
        """The function as the kernels take it."""
        return _core.hill48(self.F, self.G, self.H, self.L, self.M, self.N)


def _of_ratios(r0: float, r45: float, r90: float) -> dict[str, float]:
    """Hill's constants from r-values."""
    G = 1.0 / (1.0 + r0)
    F = r0 * G / r90
    return {"F": F, "G": G, "H": r0 * G, "N": (F + G) * (0.5 + r45)}


def _of_stresses(s0: float, s45: float, s90: float, biaxial: float) -> dict[str, float]:
    """Hill's constants from yield stresses relative to that of the curve."""
    a, b, c = 1 / s0**2, 1 / s90**2, 1 / biaxial**2
    F, G, H = (b + c - a) / 2, (a + c - b) / 2, (a + b - c) / 2
    return {"F": F, "G": G, "H": H, "N": 2 / s45**2 - (F + G) / 2}


@dataclass(frozen=True)
class Transformation(ParametersInNotebook):
    """Linear map of the stress deviator: 1 is the rolling direction, 3 the normal of the sheet.

    S_11 = -c12 s_22 - c13 s_33, S_22 = -c21 s_11 - c23 s_33, S_33 = -c31 s_11 - c32 s_22, and a factor for each shear.
    Tables in the literature call the shears c44, c55, c66, which are 23, 13, 12; here they are named by their axes.

    Examples
    --------
    >>> import umform as uf
    >>> softer_in_shear = uf.Transformation(shear12=0.9)
    >>> function = uf.Yld2004(softer_in_shear, softer_in_shear, exponent=8)
    """

    c12: float = 1.0
    """S_11 = -c12 s_22 - c13 s_33."""
    c13: float = 1.0
    """See c12."""
    c21: float = 1.0
    """S_22 = -c21 s_11 - c23 s_33."""
    c23: float = 1.0
    """See c21."""
    c31: float = 1.0
    """S_33 = -c31 s_11 - c32 s_22."""
    c32: float = 1.0
    """See c31."""
    shear12: float = 1.0
    """Factor of the shear 12, c66 of printed tables."""
    shear23: float = 1.0
    """Factor of the shear 23, c44 of printed tables."""
    shear13: float = 1.0
    """Factor of the shear 13, c55 of printed tables."""

    def __post_init__(self) -> None:
        check_fields(self)

    @property
    def coefficients(self) -> list[float]:
        """All nine coefficients, in the order of the kernels."""
        return [getattr(self, part.name) for part in fields(self)]


@dataclass(frozen=True)
class Yld2004(ParametersInNotebook, YieldFunction):
    """Yld2004-18p of Barlat et al. (2005): ``sum_ij |S'_i - S''_j|^a = 4 phi^a``.

    S' and S'' are the principal values of two transformed stresses. Even exponents need no principal values and are
    faster.

    Examples
    --------
    >>> import umform as uf
    >>> function = uf.Yld2004(uf.Transformation(c12=0.9), uf.Transformation(c21=1.1), exponent=8)
    >>> aluminium = uf.Metal(70e3, 0.33, hardening=uf.Voce(125.0, 290.0, 12.0), yield_function=function)
    """

    first: Transformation
    """S'."""
    second: Transformation
    """S''."""
    exponent: Exponent = 8
    """Exponent, from 2 to 20: 6 for bcc metals, 8 for fcc metals."""

    def __post_init__(self) -> None:
        check_fields(self)
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


@dataclass(frozen=True)
class Hosford(Yld2004):
    """Hosford (1972), isotropic: ``|s1 - s2|^a + |s2 - s3|^a + |s3 - s1|^a = 2 phi^a`` of principal stresses.

    Examples
    --------
    >>> import umform as uf
    >>> aluminium = uf.Metal(70e3, 0.33, hardening=uf.Voce(125.0, 290.0, 12.0), yield_function=uf.Hosford(8))
    """

    first: Transformation = field(default=Transformation(), init=False, repr=False)
    second: Transformation = field(default=Transformation(), init=False, repr=False)


_Factor = Annotated[float, Gt(0.0), About(cause="a sign, or one that was left out", remedy="factors near 1")]


@dataclass(frozen=True)
class Yld91(Yld2004):
    """Barlat's Yld91: Hosford's function of a transformed stress.

    Examples
    --------
    >>> import umform as uf
    >>> stress, r = uf.sheet_metals.uniaxial(uf.Yld91(1.0, 1.0, 1.0, exponent=8), 30.0)
    >>> round(float(stress), 6), round(float(r), 6)
    (1.0, 1.0)
    """

    first: Transformation = field(init=False, repr=False)
    second: Transformation = field(init=False, repr=False)
    exponent: Exponent = field(default=8, kw_only=True)
    """Exponent, from 2 to 20: 6 for bcc metals, 8 for fcc metals."""
    a: _Factor
    """Factor of s22 - s33; 1 for an isotropic metal."""
    b: _Factor
    """Factor of s33 - s11."""
    c: _Factor
    """Factor of s11 - s22."""
    f: _Factor = 1.0
    """Factor of the shear 23."""
    g: _Factor = 1.0
    """Factor of the shear 13."""
    h: _Factor = 1.0
    """Factor of the shear 12."""

    def __post_init__(self) -> None:
        check_fields(self)
        a, b, c = self.a, self.b, self.c
        c12, c13, c21, c23 = (b + 2 * c) / 3, (2 * b + c) / 3, (a + 2 * c) / 3, (2 * a + c) / 3
        shears = {"shear12": self.h, "shear23": self.f, "shear13": self.g}
        both = Transformation(c12, c13, c21, c23, (a + 2 * b) / 3, (2 * a + b) / 3, **shears)
        for name in ("first", "second"):
            object.__setattr__(self, name, both)
        super().__post_init__()

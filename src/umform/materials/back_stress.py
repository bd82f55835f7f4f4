"""Back stresses: translation of the yield surface, the Bauschinger effect (docs/theory, 3.12 and 3.13)."""

from __future__ import annotations

from dataclasses import asdict, dataclass

from umform.errors import InvalidValue
from umform.materials.checks import check_finite

_MOST = 4  # back stresses of the kernels


@dataclass(frozen=True)
class Chaboche:
    """Sum of back stresses with d alpha = C f xi/phi dp - gamma alpha dp each (docs/theory, 3.12).

    Parameters
    ----------
    parts : tuple of pairs of float
        One to four pairs (C, gamma): modulus (stress) and recall (dimensionless). A part with gamma = 0 is linear
        (Prager); a part with gamma > 0 saturates at C / gamma.
    first, rate : float
        Factor f = 1 + (first - 1) exp(-rate p) of all moduli, p the accumulated plastic strain: from ``first`` at p = 0
        to 1. With ``first`` = 1 and ``rate`` = 0 the moduli are constant.

    Examples
    --------
    >>> import umform as uf
    >>> back = uf.Chaboche(((20e3, 200.0), (1e3, 0.0)))
    >>> steel = uf.Metal(206e3, 0.3, hardening=uf.Perfect(150.0), back_stress=back)
    """

    parts: tuple[tuple[float, float], ...]
    first: float = 1.0
    rate: float = 0.0

    def __post_init__(self) -> None:
        parts = tuple(tuple(float(number) for number in part) for part in self.parts)
        object.__setattr__(self, "parts", parts)
        if not 1 <= len(parts) <= _MOST or any(len(part) != 2 for part in parts):
            raise InvalidValue(
                "back stresses are one to four pairs (C, gamma)",
                where="Chaboche",
                value=self.parts,
                cause="a single pair that is not in a list, or one number too many",
                remedy="Chaboche([(3000.0, 30.0)])",
            )
        check_finite("Chaboche", first=self.first, rate=self.rate)
        if not self.first > 0 or self.rate < 0:
            raise InvalidValue(
                "first must be positive and rate not negative",
                where="Chaboche",
                value=(self.first, self.rate),
                cause="a sign",
                remedy="first=1 and rate=0 for moduli that stay",
            )
        for number, (modulus, recall) in enumerate(parts, start=1):
            check_finite(f"Chaboche, back stress {number}", C=modulus, gamma=recall)
            if not modulus > 0 or recall < 0:
                raise InvalidValue(
                    "C must be positive and gamma not negative",
                    where=f"Chaboche, back stress {number}",
                    value=(modulus, recall),
                    cause="a sign, or the two exchanged",
                    remedy="C in units of stress, gamma without: saturation at C / gamma",
                )


@dataclass(frozen=True)
class YoshidaUemori:
    """Yoshida and Uemori (2002): two-surface model with a bounding surface and a stagnation surface (docs/theory,
    3.13).

    The yield stress Y is that of the hardening curve, which must be constant: ``Perfect(Y)``.

    Parameters
    ----------
    C : float
        Rate of the translation of the yield surface relative to the bounding surface, dimensionless.
    B : float
        Initial size of the bounding surface, above Y; a stress.
    growth : float
        R_sat: saturation value of its isotropic hardening; a stress.
    b : float
        Saturation value of its back stress; a stress.
    m : float
        Rate of both, dimensionless.
    h : float
        Ratio of isotropic to kinematic hardening of the stagnation surface, 0 to 1.

    Examples
    --------
    >>> import umform as uf
    >>> back = uf.YoshidaUemori(C=500.0, B=168.0, growth=190.0, b=9.0, m=12.0, h=0.5)
    >>> steel = uf.Metal(206e3, 0.3, hardening=uf.Perfect(124.0), back_stress=back)
    """

    C: float
    B: float
    growth: float
    b: float
    m: float
    h: float

    def __post_init__(self) -> None:
        check_finite("YoshidaUemori", **asdict(self))
        if not min(self.C, self.B, self.b, self.m) > 0 or self.growth < 0 or not 0 <= self.h <= 1:
            raise InvalidValue(
                "C, B, b and m must be positive, growth not negative, h between 0 and 1",
                where="YoshidaUemori",
                value=self,
                cause="a sign, or numbers in another order",
                remedy="mild steel: YoshidaUemori(C=500.0, B=168.0, growth=190.0, b=9.0, m=12.0, h=0.5)",
            )

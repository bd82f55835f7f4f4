"""Back stresses: translation of the yield surface, the Bauschinger effect (docs/theory, 3.12 and 3.13)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from annotated_types import Ge, Gt, Le, MaxLen, MinLen

from umform.errors import InvalidValue
from umform.materials.checks import check_finite
from umform.spec import About, OneOf, ParametersInNotebook, check_fields
from umform.spec.types import NotNegative, Positive

_MOST = 4  # back stresses of the kernels
_STEEL = About(
    cause="a sign, or numbers in another order",
    remedy="mild steel: YoshidaUemori(C=500.0, B=168.0, growth=190.0, b=9.0, m=12.0, h=0.5)",
)
_Positive = Annotated[float, Gt(0.0), _STEEL]


@dataclass(frozen=True)
class Chaboche(ParametersInNotebook):
    """Back stresses of Chaboche: the sum of those with d alpha = C f xi/phi dp - gamma alpha dp (docs/theory, 3.12).

    A part with gamma = 0 is linear (Prager); a part with gamma > 0 saturates at C / gamma. The factor f = 1 + (first -
    1) exp(-rate p) of all moduli, p the accumulated plastic strain, goes from ``first`` at p = 0 to 1. With ``first`` =
    1 and ``rate`` = 0 the moduli are constant.

    Examples
    --------
    >>> import umform as uf
    >>> back = uf.Chaboche(((20e3, 200.0), (1e3, 0.0)))
    >>> steel = uf.Metal(206e3, 0.3, hardening=uf.Perfect(150.0), back_stress=back)
    """

    parts: Annotated[tuple[tuple[float, float], ...], MinLen(1), MaxLen(_MOST)]
    """Modulus and recall of each, one to four pairs [C, gamma]: a stress, and a number without dimension."""
    first: Positive = 1.0
    """Initial factor of the moduli."""
    rate: NotNegative = 0.0
    """Rate of the change of the moduli with the plastic strain."""

    def __post_init__(self) -> None:
        try:
            parts = tuple(tuple(float(number) for number in part) for part in self.parts)
        except (TypeError, ValueError):  # a pair, or words
            parts = ()
        if not 1 <= len(parts) <= _MOST or any(len(part) != 2 for part in parts):
            raise InvalidValue(
                "back stresses are one to four pairs (C, gamma)",
                where="Chaboche",
                value=self.parts,
                cause="a single pair that is not in a list, or one number too many",
                remedy="Chaboche([(3000.0, 30.0)])",
            )
        object.__setattr__(self, "parts", parts)
        check_fields(self)
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
class YoshidaUemori(ParametersInNotebook):
    """Yoshida and Uemori (2002): a bounding surface and a stagnation surface (docs/theory, 3.13); hardening is Perfect.

    Examples
    --------
    >>> import umform as uf
    >>> back = uf.YoshidaUemori(C=500.0, B=168.0, growth=190.0, b=9.0, m=12.0, h=0.5)
    >>> steel = uf.Metal(206e3, 0.3, hardening=uf.Perfect(124.0), back_stress=back)
    """

    C: _Positive
    """Rate of the translation of the yield surface relative to the bounding surface, dimensionless."""
    B: _Positive
    """Initial size of the bounding surface, above the yield stress; a stress."""
    growth: Annotated[float, Ge(0.0), _STEEL]
    """R_sat: saturation value of the isotropic hardening of the bounding surface, a stress."""
    b: _Positive
    """Saturation value of the back stress of the bounding surface, a stress."""
    m: _Positive
    """Rate of both, dimensionless."""
    h: Annotated[float, Ge(0.0), Le(1.0), _STEEL]
    """Ratio of isotropic to kinematic hardening of the stagnation surface, 0 to 1."""

    def __post_init__(self) -> None:
        check_fields(self)


#: Either of them; each has its table in a deck.
BackStress = Annotated[
    Chaboche | YoshidaUemori, OneOf("", lambda: {"back_stress": Chaboche, "two_surfaces": YoshidaUemori})
]

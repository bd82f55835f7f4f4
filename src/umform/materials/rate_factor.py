"""Factors of the yield stress as functions of the plastic strain rate (docs/theory, 3.14).

A class of this file is a factor of Python and of decks.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Annotated, Protocol

from annotated_types import Ge, Gt, Le

from umform import _core
from umform.materials.known import known
from umform.spec import About, OneOf, ParametersInNotebook, Rule, check_fields

_MILD = About(
    cause="a sign, the two exchanged, or the exponent as a fraction",
    remedy="mild steel: CowperSymonds(reference=40.0, exponent=5.0), per second",
)
_TYPICAL = About(
    cause="a sign, the two exchanged, or a metal without a rate",
    remedy="JohnsonCook(reference=1.0, strength=0.014), per second; no rate for none",
)


class RateFactor(Protocol):
    """Factor of the yield stress as a function of the plastic strain rate."""

    def factor(self) -> _core.RateFactor:
        """The factor as the kernels take it."""


#: One of the factors; the word ``factor`` of a deck names it.
Factor = Annotated[
    RateFactor,
    Rule(
        lambda rate: callable(getattr(rate, "factor", None)) and not isinstance(rate, type),
        "rate must be a rate factor",
        cause="a strain rate, or the name of a factor in place of one",
        remedy="CowperSymonds(reference=40.0, exponent=5.0) or JohnsonCook(reference=1.0, strength=0.014)",
    ),
    Rule(
        lambda factor: isinstance(factor.factor(), _core.RateFactor),
        "factor() of a rate factor must return what the kernels take",
        cause="an object such as JohnsonCook, or nothing",
        remedy="return uf.JohnsonCook(...).factor()",
    ),
    OneOf("factor", partial(known, RateFactor)),
]


@dataclass(frozen=True)
class CowperSymonds(ParametersInNotebook, RateFactor):
    """Cowper and Symonds (1957): 1 + (rate / reference)^(1 / exponent).

    Examples
    --------
    >>> import umform as uf
    >>> rate = uf.CowperSymonds(reference=40.0, exponent=5.0)
    >>> steel = uf.Metal(206e3, 0.3, hardening=uf.Swift(520.0, 0.004, 0.2), rate=rate)
    """

    reference: Annotated[float, Gt(0.0), _MILD]
    """Plastic strain rate at which the yield stress is twice the static one, 1 / time."""
    exponent: Annotated[float, Ge(1.0), Le(20.0), _MILD]
    """Exponent, from 1 to 20."""

    def __post_init__(self) -> None:
        check_fields(self)

    def factor(self) -> _core.RateFactor:
        """The factor as the kernels take it."""
        return _core.cowper_symonds(self.reference, self.exponent)


@dataclass(frozen=True)
class JohnsonCook(ParametersInNotebook, RateFactor):
    """Johnson and Cook (1983): 1 + strength ln(rate / reference), 1 below the reference rate.

    Examples
    --------
    >>> import umform as uf
    >>> rate = uf.JohnsonCook(reference=1e-3, strength=0.02)
    >>> steel = uf.Metal(206e3, 0.3, hardening=uf.Swift(520.0, 0.004, 0.2), rate=rate)
    """

    reference: Annotated[float, Gt(0.0), _TYPICAL]
    """Plastic strain rate of the hardening curve, 1 / time."""
    strength: Annotated[float, Ge(1e-3), Le(1.0), _TYPICAL]
    """C, from 0.001 to 1."""

    def __post_init__(self) -> None:
        check_fields(self)

    def factor(self) -> _core.RateFactor:
        """The factor as the kernels take it."""
        return _core.johnson_cook(self.reference, self.strength)

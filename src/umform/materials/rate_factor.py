"""Factors of the yield stress as functions of the plastic strain rate (docs/theory, 3.14)."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Protocol

from umform import _core
from umform.errors import InvalidValue
from umform.materials.checks import check_finite


class RateFactor(Protocol):
    """Factor of the yield stress as a function of the plastic strain rate."""

    def factor(self) -> _core.RateFactor:
        """The factor as the kernels take it."""


@dataclass(frozen=True)
class CowperSymonds:
    """Cowper and Symonds (1957): 1 + (rate / reference)^(1 / exponent).

    Parameters
    ----------
    reference : float
        Plastic strain rate at which the yield stress is twice the static one, 1 / time.
    exponent : float
        Between 1 and 20.

    Examples
    --------
    >>> import umform as uf
    >>> rate = uf.CowperSymonds(reference=40.0, exponent=5.0)
    >>> steel = uf.Metal(206e3, 0.3, hardening=uf.Swift(520.0, 0.004, 0.2), rate=rate)
    """

    reference: float
    exponent: float

    def __post_init__(self) -> None:
        check_finite("CowperSymonds", **asdict(self))
        if not self.reference > 0 or not 1 <= self.exponent <= 20:
            raise InvalidValue(
                "the reference rate must be positive, the exponent from 1 to 20",
                where="CowperSymonds",
                value=self,
                cause="a sign, the two exchanged, or the exponent as a fraction",
                remedy="mild steel: CowperSymonds(reference=40.0, exponent=5.0), per second",
            )

    def factor(self) -> _core.RateFactor:
        """The factor as the kernels take it."""
        return _core.cowper_symonds(self.reference, self.exponent)


@dataclass(frozen=True)
class JohnsonCook:
    """Johnson and Cook (1983): 1 + strength ln(rate / reference), 1 below the reference rate.

    Parameters
    ----------
    reference : float
        Plastic strain rate of the hardening curve, 1 / time.
    strength : float
        C, between 0.001 and 1.

    Examples
    --------
    >>> import umform as uf
    >>> rate = uf.JohnsonCook(reference=1e-3, strength=0.02)
    >>> steel = uf.Metal(206e3, 0.3, hardening=uf.Swift(520.0, 0.004, 0.2), rate=rate)
    """

    reference: float
    strength: float

    def __post_init__(self) -> None:
        check_finite("JohnsonCook", **asdict(self))
        if not self.reference > 0 or not 1e-3 <= self.strength <= 1:
            raise InvalidValue(
                "the reference rate must be positive, the strength from 0.001 to 1",
                where="JohnsonCook",
                value=self,
                cause="a sign, the two exchanged, or a metal without a rate",
                remedy="JohnsonCook(reference=1.0, strength=0.014), per second; no rate for none",
            )

    def factor(self) -> _core.RateFactor:
        """The factor as the kernels take it."""
        return _core.johnson_cook(self.reference, self.strength)

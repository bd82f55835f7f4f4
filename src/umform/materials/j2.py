"""Plasticity: elastic constants with a hardening curve, and finite-strain J2 plasticity."""

from __future__ import annotations

from dataclasses import dataclass

from umform import _core
from umform.errors import InvalidValue
from umform.materials.elastic import Elastic
from umform.materials.hardening import Hardening


@dataclass(frozen=True, init=False)
class Plastic(Elastic):
    """Elastic constants and a hardening curve, which all metals have.

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
                where=type(self).__name__,
                value=hardening,
                cause="a number, or the name of a curve in place of a curve",
                remedy="Perfect(160.0) or another of Linear, Voce, LinearVoce, Swift, Table",
            )
        object.__setattr__(self, "hardening", hardening)

    thickness_points = None


class J2(Plastic):
    """Finite-strain J2 plasticity in logarithmic elastic strains, multiplicative split (docs/theory, chapter 3).

    Parameters
    ----------
    E, nu, kappa, mu : float
        Elastic constants, see :class:`Elastic`.
    hardening : Hardening
        Perfect, Linear, Voce, LinearVoce, Swift or Table.

    Examples
    --------
    >>> import umform as uf
    >>> steel = uf.J2(E=210e3, nu=0.3, hardening=uf.Swift(strength=520.0, offset=0.004, exponent=0.2))
    >>> round(uf.sheet_metals.tensile_test(steel).tensile_strength)
    309
    """

    def law(self) -> _core.Material:
        """The law as the kernels take it."""
        return _core.j2(self.kappa, self.mu, self.hardening.curve())

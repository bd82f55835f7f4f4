"""Plasticity: elastic constants with a hardening curve, and finite-strain J2 plasticity."""

from __future__ import annotations

from dataclasses import dataclass, field

from umform import _core
from umform.materials.elastic import Elastic
from umform.materials.hardening import Curve


@dataclass(frozen=True)
class Plastic(Elastic):
    """Elastic constants and a hardening curve, which all metals have."""

    hardening: Curve = field(kw_only=True)
    """Yield stress over the plastic strain: Perfect, Linear, Voce, LinearVoce, Swift, Table, or a curve of your own."""

    thickness_points = None


class J2(Plastic):
    """Finite-strain J2 plasticity in logarithmic elastic strains, multiplicative split (docs/theory, chapter 3).

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

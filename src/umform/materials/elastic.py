"""Elastic constants and the elastic laws: immutable descriptions from which the kernels build their laws.

Elastic constants are given as E and nu, or as kappa and mu. Stresses in any unit, as long as it is that of the model.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass, field
from typing import Annotated

from annotated_types import Gt, Lt

from umform import _core
from umform.errors import InvalidValue
from umform.spec import About, ParametersInNotebook, check_fields
from umform.spec.types import FOLLOWS

_EXCHANGED = About(
    cause="a sign, a stress in place of a ratio, or the two exchanged", remedy="nearly incompressible: nu = 0.4999"
)
_MODULI = About(
    cause="a sign, or Lamé's constants in place of the moduli", remedy="kappa = lambda + 2 mu / 3; or give E and nu"
)
_Modulus = Annotated[float, Gt(0.0), _MODULI]


@dataclass(frozen=True)
class Elastic(ParametersInNotebook):
    """Isotropic elastic constants: E and nu, or kappa and mu.

    Raises
    ------
    InvalidValue
        If not exactly one pair is given, or if the constants violate stability (E > 0, -1 < nu < 1/2).
    """

    E: Annotated[float, Gt(0.0), _EXCHANGED] = field(default=FOLLOWS, repr=False, compare=False)
    """Young's modulus."""
    nu: Annotated[float, Gt(-1.0), Lt(0.5), _EXCHANGED] = field(default=FOLLOWS, repr=False, compare=False)
    """Poisson's ratio."""
    _: KW_ONLY
    kappa: _Modulus = FOLLOWS
    """Bulk modulus."""
    mu: _Modulus = FOLLOWS
    """Shear modulus."""

    def __post_init__(self) -> None:
        check_fields(self)
        E, nu, kappa, mu = self.E, self.nu, self.kappa, self.mu
        by_young = E is not None and nu is not None and (kappa, mu) in ((None, None), _moduli(E, nu))
        if by_young:
            kappa, mu = _moduli(E, nu)
        elif (
            kappa is None
            or mu is None
            or any(getattr(self, name) not in (None, value) for name, value in _young_and_poisson(kappa, mu).items())
        ):
            raise InvalidValue(
                "give E and nu, or kappa and mu, and no others",
                where=type(self).__name__,
                cause="one of a pair is missing, or both pairs are given",
                remedy="two constants: J2(E=210e3, nu=0.3, ...) for one",
            )
        own = {"E": E, "nu": nu} if by_young else _young_and_poisson(kappa, mu)
        for name, value in {**own, "kappa": kappa, "mu": mu}.items():
            object.__setattr__(self, name, float(value))
        object.__setattr__(self, "_by_young", by_young)

    @property
    def lambda_(self) -> float:
        """Lamé's first constant."""
        return self.kappa - 2.0 / 3.0 * self.mu

    def written(self) -> Mapping[str, float | None]:
        """The pair of constants that gives these to the last bit, E and nu if given or if they do; None for others."""
        E, nu = float(f"{self.E:.12g}"), float(f"{self.nu:.12g}")
        if _moduli(E, nu) != (self.kappa, self.mu) and vars(self)["_by_young"]:
            E, nu = self.E, self.nu
        if _moduli(E, nu) == (self.kappa, self.mu):
            return {"E": E, "nu": nu, "kappa": None, "mu": None}
        return {"E": None, "nu": None}


def _moduli(E: float, nu: float) -> tuple[float, float]:
    """Bulk and shear modulus of Young's modulus and Poisson's ratio."""
    return float(E / (3 * (1 - 2 * nu))), float(E / (2 * (1 + nu)))


def _young_and_poisson(kappa: float, mu: float) -> dict[str, float]:
    """Young's modulus and Poisson's ratio of a bulk and a shear modulus."""
    return {"E": 9 * kappa * mu / (3 * kappa + mu), "nu": (3 * kappa - 2 * mu) / (2 * (3 * kappa + mu))}


class SVK(Elastic):
    """St. Venant-Kirchhoff: S = lambda tr(E) 1 + 2 mu E. For small strains; it softens in strong compression.

    Examples
    --------
    >>> import umform as uf
    >>> steel = uf.SVK(E=210e3, nu=0.3)
    >>> round(steel.mu)
    80769
    """

    thickness_points = None

    def law(self) -> _core.Material:
        """The law as the kernels take it."""
        return _core.saint_venant_kirchhoff(self.lambda_, self.mu)


class NeoHooke(Elastic):
    """Compressible neo-Hooke, logarithmic form: W = mu/2 (I1 - 3) - mu ln J + lambda/2 ln² J.

    Examples
    --------
    >>> import umform as uf
    >>> rubber = uf.NeoHooke(E=3.0, nu=0.45)
    >>> uf.check_law(rubber, [[0.2, -0.1, 0.05, 0.1, 0.0, 0.05]]) < 1e-6
    True
    """

    thickness_points = None

    def law(self) -> _core.Material:
        """The law as the kernels take it."""
        return _core.neo_hooke_logarithmic(self.lambda_, self.mu)


class NeoHookePower(Elastic):
    """Compressible neo-Hooke, power form: W = c (I1 - 3) + c/beta (I3^-beta - 1), c = mu/2, beta = nu/(1 - 2 nu).

    Examples
    --------
    >>> import umform as uf
    >>> rubber = uf.NeoHookePower(E=3.0, nu=0.45)
    >>> uf.check_law(rubber, [[0.2, -0.1, 0.05, 0.1, 0.0, 0.05]]) < 1e-6
    True
    """

    thickness_points = None

    def law(self) -> _core.Material:
        """The law as the kernels take it."""
        return _core.neo_hooke_power(self.mu, self.nu / (1 - 2 * self.nu))

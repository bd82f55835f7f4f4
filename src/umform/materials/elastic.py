"""Elastic constants and the elastic laws: immutable descriptions from which the kernels build their laws.

Elastic constants are given as E and nu, or as kappa and mu. Stresses in any unit, as long as it is that of the model.
"""

from __future__ import annotations

from dataclasses import dataclass

from umform import _core
from umform.errors import InvalidValue
from umform.materials.checks import check_finite


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
        If not exactly one pair is given, or if the constants violate stability (E > 0, -1 < nu < 1/2).
    """

    kappa: float
    mu: float

    def __init__(
        self, E: float | None = None, nu: float | None = None, *, kappa: float | None = None, mu: float | None = None
    ) -> None:
        where = type(self).__name__
        if E is not None and nu is not None and kappa is None and mu is None:
            check_finite(where, E=E, nu=nu)
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
            check_finite(where, kappa=kappa, mu=mu)
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


class SVK(Elastic):
    """Saint Venant-Kirchhoff: S = lambda tr(E) 1 + 2 mu E. For small strains; it softens in strong compression.

    Parameters
    ----------
    E, nu, kappa, mu : float
        Elastic constants, see :class:`Elastic`.

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

    Parameters
    ----------
    E, nu, kappa, mu : float
        Elastic constants, see :class:`Elastic`.

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

    Parameters
    ----------
    E, nu, kappa, mu : float
        Elastic constants, see :class:`Elastic`.

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

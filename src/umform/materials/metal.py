"""Metals put together from parts: yield function, hardening curve, back stresses, and a modulus that falls."""

from __future__ import annotations

from dataclasses import dataclass, field

from umform import _core
from umform.errors import InvalidValue
from umform.materials.back_stress import Chaboche, YoshidaUemori
from umform.materials.checks import check_finite
from umform.materials.hardening import Hardening
from umform.materials.j2 import Plastic
from umform.materials.material import Material
from umform.materials.yield_functions import Mises, YieldFunction


@dataclass(frozen=True)
class FallingModulus:
    """Young's modulus that falls with the plastic strain: E = E0 - (E0 - saturated)(1 - exp(-rate p)).

    Parameters
    ----------
    saturated : float
        What E falls to.
    rate : float
        How fast.

    Examples
    --------
    >>> import umform as uf
    >>> steel = uf.Metal(206e3, 0.3, hardening=uf.Perfect(200.0), modulus=uf.FallingModulus(saturated=160e3, rate=40.0))
    """

    saturated: float
    rate: float

    def __post_init__(self) -> None:
        check_finite("FallingModulus", saturated=self.saturated, rate=self.rate)
        if not self.saturated > 0 or not self.rate > 0:
            raise InvalidValue(
                "saturated and rate must be positive",
                where="FallingModulus",
                value=self,
                cause="a sign, or a modulus that does not fall",
                remedy="FallingModulus(saturated=152e3, rate=30.8); none for a constant modulus",
            )


@dataclass(frozen=True, init=False)
class Metal(Plastic):
    """Plasticity in logarithmic strains: yield function, back stresses, falling modulus (docs/theory, 3.9 to 3.13).

    Parameters
    ----------
    E, nu, kappa, mu : float
        Elastic constants, see :class:`Elastic`.
    hardening : Hardening
        Perfect, Linear, Voce, LinearVoce, Swift or Table: size of the yield surface.
    yield_function : YieldFunction
        Mises, Hill48, Hosford, Yld91 or Yld2004. One with directions needs the ``rolling`` direction of the model.
    back_stress : Chaboche or YoshidaUemori, optional
        Motion of the yield surface.
    modulus : FallingModulus, optional
        Young's modulus over the plastic strain.

    Examples
    --------
    >>> import umform as uf
    >>> mild = uf.Metal(
    ...     206e3,
    ...     0.3,
    ...     hardening=uf.Swift(520.0, 0.004, 0.2),
    ...     yield_function=uf.Hill48(r0=1.8, r45=1.4, r90=2.1),
    ...     modulus=uf.FallingModulus(saturated=160e3, rate=40.0),
    ... )
    >>> along_x = uf.rolling_at(0.0)
    >>> model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=mild, rolling=along_x)
    """

    yield_function: YieldFunction = field(default_factory=Mises)
    back_stress: Chaboche | YoshidaUemori | None = None
    modulus: FallingModulus | None = None

    def __init__(
        self,
        E: float | None = None,
        nu: float | None = None,
        *,
        kappa: float | None = None,
        mu: float | None = None,
        hardening: Hardening,
        yield_function: YieldFunction | None = None,
        back_stress: Chaboche | YoshidaUemori | None = None,
        modulus: FallingModulus | None = None,
    ) -> None:
        super().__init__(E, nu, kappa=kappa, mu=mu, hardening=hardening)
        function = Mises() if yield_function is None else yield_function
        if not callable(getattr(function, "function", None)) or isinstance(function, type):
            raise InvalidValue(
                "yield_function must be a yield function",
                where="Metal",
                value=function,
                cause="its name, or its class in place of one",
                remedy="Hill48(r0=1.8, r45=1.5, r90=2.2) or another of Mises, Hosford, Yld91, Yld2004",
            )
        if modulus is not None and not self.E / 3.0 < modulus.saturated < self.E:
            raise InvalidValue(
                "the modulus must fall, to no less than a third: saturated between E / 3 and E",
                where="Metal",
                value=f"E={self.E:.6g}, saturated={modulus.saturated:.6g}",
                cause="the two exchanged, or one of them in GPa",
                remedy="saturated of 0.7 E to 0.95 E, in the unit of E",
            )
        if isinstance(back_stress, YoshidaUemori):
            _check_surfaces(back_stress, hardening)
        object.__setattr__(self, "yield_function", function)
        object.__setattr__(self, "back_stress", back_stress)
        object.__setattr__(self, "modulus", modulus)

    @property
    def directional(self) -> bool:
        """Whether it depends on the rolling direction."""
        return self.yield_function.directional

    def law(self) -> _core.Material:
        """The law as the kernels take it."""
        return _core.logarithmic_space(self.small_strain_law())

    def small_strain_law(self) -> _core.Material:
        """The law that is asked with logarithmic strains."""
        back = self.back_stress
        pairs: list[tuple[float, float]] = []
        first, growth, surfaces = 1.0, 0.0, list[float]()
        if isinstance(back, Chaboche):
            pairs, first, growth = list(back.parts), back.first, back.rate
        elif back is not None:
            first_yield, _ = self.hardening.curve()(0.0)
            pairs, surfaces = [(back.m * back.b, back.m)], [first_yield, back.C, back.B, back.growth, back.m, back.h]
        fall, rate = (0.0, 0.0) if self.modulus is None else (1.0 - self.modulus.saturated / self.E, self.modulus.rate)
        function = self.yield_function.function()
        return _core.metal(
            self.kappa, self.mu, self.hardening.curve(), function, pairs, first, growth, fall, rate, surfaces
        )


def _check_surfaces(surfaces: YoshidaUemori, hardening: Hardening) -> None:
    """Refuse a yield surface that grows, or that does not fit into the bounding surface."""
    first, slope = hardening.curve()(0.0)
    if slope != 0.0 or hardening.curve()(1.0)[0] != first:
        raise InvalidValue(
            "the yield surface of Yoshida and Uemori has a constant size",
            where="Metal",
            value=hardening,
            cause="hardening that belongs to the bounding surface: B, growth, b, m",
            remedy="hardening=Perfect(Y)",
        )
    if not first < surfaces.B:
        raise InvalidValue(
            "the bounding surface must be larger than the yield surface",
            where="Metal",
            value=f"B={surfaces.B:.6g}, yield stress {first:.6g}",
            cause="the two exchanged",
            remedy="B above Y",
        )


@dataclass(frozen=True)
class LogarithmicSpace:
    """A small-strain law as one of finite strain: it gets logarithmic strains, and its stress is their conjugate.

    Parameters
    ----------
    small : Material
        Any law, one of your own for instance: in place of the Green-Lagrange strain it is asked with ln(C)/2,
        engineering shears, in the axes of the sheet. SVK becomes Hencky's law.

    Examples
    --------
    >>> import umform as uf
    >>> hencky = uf.LogarithmicSpace(uf.SVK(E=210e3, nu=0.3))
    >>> uf.check_law(hencky, [[0.2, -0.1, 0.05, 0.1, 0.0, 0.05]]) < 1e-6
    True
    """

    small: Material

    @property
    def thickness_points(self) -> int:
        """Default number of Gauss points through the thickness."""
        return self.small.thickness_points

    def law(self) -> _core.Material:
        """The law as the kernels take it."""
        return _core.logarithmic_space(self.small.law())

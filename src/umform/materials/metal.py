"""Metals composed of a yield function, a hardening curve, back stresses, a falling modulus and a rate factor."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass, field
from typing import Annotated

import numpy as np
from annotated_types import Gt
from numpy.typing import ArrayLike

from umform import _core
from umform.errors import InvalidValue
from umform.materials.back_stress import BackStress, Chaboche, YoshidaUemori
from umform.materials.hardening import Hardening
from umform.materials.j2 import Plastic
from umform.materials.material import Material, check_material
from umform.materials.rate_factor import Factor, RateFactor
from umform.materials.user_law import Floats
from umform.materials.yield_functions import Function, Mises
from umform.spec import About, ParametersInNotebook, check_fields

#: Largest yield stress over E.
_LARGEST_YIELD = 0.2


_FALLING = About(
    cause="a sign, or a modulus that does not fall",
    remedy="FallingModulus(saturated=152e3, rate=30.8); none for a constant modulus",
)


@dataclass(frozen=True)
class FallingModulus(ParametersInNotebook):
    """Young's modulus that falls with the plastic strain: E = E0 - (E0 - saturated)(1 - exp(-rate p)).

    Examples
    --------
    >>> import umform as uf
    >>> steel = uf.Metal(206e3, 0.3, hardening=uf.Perfect(200.0), modulus=uf.FallingModulus(saturated=160e3, rate=40.0))
    """

    saturated: Annotated[float, Gt(0.0), _FALLING]
    """Limit of the modulus, a stress."""
    rate: Annotated[float, Gt(0.0), _FALLING]
    """Rate of the decrease, dimensionless."""

    def __post_init__(self) -> None:
        check_fields(self)

    def share(self, E: float, eqps: Floats) -> Floats:
        """Modulus over its first value E, at plastic strains."""
        return 1.0 - (1.0 - self.saturated / E) * -np.expm1(-self.rate * eqps)


@dataclass(frozen=True)
class Metal(Plastic):
    """Plasticity with a yield function, back stresses, a falling modulus and a rate factor (docs/theory, 3.9 to 3.13).

    A yield function with directions needs the ``rolling`` direction of the model. With a rate factor, a model that is
    evaluated without a time increment responds elastically.

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

    _: KW_ONLY
    yield_function: Function = field(default_factory=Mises)
    """Shape of the yield surface: Mises, Hill48, Hosford, Yld91, Yld2004, or a function of your own."""
    back_stress: BackStress | None = None
    """Motion of the yield surface."""
    modulus: FallingModulus | None = None
    """Decrease of Young's modulus."""
    rate: Factor | None = None
    """Factor of the yield stress as a function of the plastic strain rate; time is that of the steps."""

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.modulus is not None and not self.E / 3.0 < self.modulus.saturated < self.E:
            raise InvalidValue(
                "the modulus must fall, to no less than a third: saturated between E / 3 and E",
                where="Metal",
                value=f"E={self.E:.6g}, saturated={self.modulus.saturated:.6g}",
                cause="the two exchanged, or one of them in GPa",
                remedy="saturated of 0.7 E to 0.95 E, in the unit of E",
            )
        if isinstance(self.back_stress, YoshidaUemori):
            _check_surfaces(self.back_stress, self.hardening, self.rate)
        _check_first_yield(self)

    @property
    def directional(self) -> bool:
        """Whether it depends on the rolling direction."""
        return self.yield_function.directional

    def law(self) -> _core.Material:
        """The law as the kernels take it."""
        return _core.logarithmic_space(self.small_strain_law())

    def small_strain_law(self) -> _core.Material:
        """The law of logarithmic strains."""
        return self._card().law()

    def residuals(self, strain: ArrayLike, state: ArrayLike | None = None, time: float = 0.0) -> Floats:
        """Residuals of the return map at a logarithmic strain: the convergence of its Newton method.

        Parameters
        ----------
        strain : array_like, shape (6,)
            Engineering shears, in the axes of the sheet.
        state : array_like, optional
            State before the increment; default: the virgin one.
        time : float
            Time increment, for a metal with a rate factor.

        Returns
        -------
        ndarray
            One residual per iteration, relative to the yield stress; empty for an elastic increment. With sub-stepping
            of the yield surface the residuals of all stages follow each other.
        """
        card = self._card()
        before = card.law().initial() if state is None else np.asarray(state, dtype=float)
        return np.array(card.residuals(np.asarray(strain, dtype=float), before, time))

    def _card(self) -> _core.MetalCard:
        back = self.back_stress
        pairs: list[tuple[float, float]] = []
        first, growth, surfaces = 1.0, 0.0, list[float]()
        if isinstance(back, Chaboche):
            pairs, first, growth = list(back.parts), back.first, back.rate
        elif back is not None:
            first_yield, _ = self.hardening.curve()(0.0)
            pairs, surfaces = [(back.m * back.b, back.m)], [first_yield, back.C, back.B, back.growth, back.m, back.h]
        fall, rate = (0.0, 0.0) if self.modulus is None else (1.0 - self.modulus.saturated / self.E, self.modulus.rate)
        function, curve = self.yield_function.function(), self.hardening.curve()
        factor = [] if self.rate is None else [self.rate.factor()]
        return _core.MetalCard(
            self.kappa, self.mu, curve, function, pairs, first, growth, fall, rate, surfaces, *factor
        )

    def shown(self, history: Mapping[str, Floats]) -> dict[str, Floats]:
        """Fields of the history: sum of the back stresses, stagnation surface, modulus.

        Parameters
        ----------
        history : mapping of str to ndarray, shape (cells, points, size)
            Parts of the history by their names.
        """
        shown: dict[str, Floats] = {}
        moving = [values for name, values in history.items() if "back_stress" in name]
        if moving:
            back = shown["back_stress"] = np.sum(moving, axis=0)
            weights = np.array([1.5, 1.5, 1.5, 3.0, 3.0, 3.0])
            shown["back_stress_von_mises"] = np.sqrt((weights * back**2).sum(axis=-1))
        shown |= {name: history[name] for name in ("stagnation_radius", "bounding_growth") if name in history}
        if self.modulus is not None:
            saturated, p = self.modulus.saturated, history["eqps"][..., 0]
            shown["modulus"] = self.E - (self.E - saturated) * (1.0 - np.exp(-self.modulus.rate * p))
        return shown


def _check_first_yield(metal: Plastic) -> None:
    """Reject a yield stress that is too large for the elastic modulus."""
    first, _ = metal.hardening.curve()(0.0)
    if first > _LARGEST_YIELD * metal.E:
        raise InvalidValue(
            "the metal would be elastic up to a strain of more than 20 %",
            where="Metal",
            value=f"yield stress {first:.6g}, E={metal.E:.6g}",
            cause="E in GPa and the yield stress in MPa",
            remedy="both in one unit: E = 206e3 and a yield stress of 180, in MPa",
        )


def _check_surfaces(surfaces: YoshidaUemori, hardening: Hardening, rate: RateFactor | None) -> None:
    """Reject a yield surface that grows, also by a rate factor, or that exceeds the bounding surface."""
    if rate is not None:
        raise InvalidValue(
            "the yield surface of Yoshida and Uemori has a constant size: no rate",
            where="Metal",
            value=rate,
            cause="a rate factor beside two surfaces",
            remedy="Chaboche for the back stress, or no rate",
        )
    first, slope = hardening.curve()(0.0)
    if slope != 0.0 or hardening.curve()(1.0)[0] != first:
        raise InvalidValue(
            "the yield surface of Yoshida and Uemori has a constant size",
            where="Metal",
            value=hardening,
            cause="hardening that belongs to the bounding surface: B, growth, b, m",
            remedy='Perfect(Y), in a deck { curve = "Perfect", yield_stress = Y }',
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
    """A small-strain law at finite strain: it receives logarithmic strains, and its stress is work-conjugate to them.

    Examples
    --------
    >>> import umform as uf
    >>> hencky = uf.LogarithmicSpace(uf.SVK(E=210e3, nu=0.3))
    >>> uf.check_law(hencky, [[0.2, -0.1, 0.05, 0.1, 0.0, 0.05]]) < 1e-6
    True
    """

    small: Material
    """Any law, also one of your own; it receives ln(C)/2 in place of the Green-Lagrange strain, with engineering
    shears, in the axes of the sheet. SVK becomes Hencky's law."""

    def __post_init__(self) -> None:
        check_material(self.small, "LogarithmicSpace")

    @property
    def thickness_points(self) -> int | None:
        """Default number of Gauss points through the thickness, that of the small-strain law."""
        return self.small.thickness_points

    def law(self) -> _core.Material:
        """The law as the kernels take it."""
        return _core.logarithmic_space(self.small_strain_law())

    def small_strain_law(self) -> _core.Material:
        """The law of logarithmic strains."""
        return self.small.law()

    def shown(self, history: Mapping[str, Floats]) -> Mapping[str, Floats]:
        """Fields of the history: those of the small-strain law."""
        return getattr(self.small, "shown", lambda history: {})(history)

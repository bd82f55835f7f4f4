"""An independent reference: J2 flow in plane strain at sigma_33 = 0, point by point in numpy; a section in bending.

Fibres of a wide sheet are stretched along 1, held along 2 and free along 3 (through the thickness). The axes do not
turn against the fibres, so that logarithmic strains add, and nothing is needed but principal values.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.materials import J2, Hardening, LinearVoce, Plastic, Swift

Floats = NDArray[np.float64]

_HYDROSTATIC = np.ones(3) / 3.0


def yield_curve(hardening: Hardening, e: Floats) -> tuple[Floats, Floats]:
    """Yield stress at accumulated plastic strains, and its slope."""
    if isinstance(hardening, LinearVoce):
        rest = (hardening.saturation - hardening.yield_stress) * np.exp(-hardening.rate * e)
        return hardening.saturation + hardening.modulus * e - rest, hardening.modulus + hardening.rate * rest
    if isinstance(hardening, Swift):
        y = hardening.strength * (hardening.offset + e) ** hardening.exponent
        return y, hardening.exponent * y / (hardening.offset + e)
    raise InvalidValue("the reference knows no such hardening", value=hardening)


@dataclass(frozen=True)
class State:
    """Plastic logarithmic strains (n, 3) and accumulated plastic strains (n,) of n fibres."""

    plastic: Floats
    eqps: Floats

    @classmethod
    def virgin(cls, fibres: int) -> State:
        """Nothing has flowed yet."""
        return cls(np.zeros((fibres, 3)), np.zeros(fibres))


def flow(material: J2, strain: Floats, state: State) -> tuple[Floats, Floats, State]:
    """Kirchhoff stresses (n, 3), their moduli (n, 3, 3) and the new state at principal logarithmic strains (n, 3)."""
    kappa, mu = material.kappa, material.mu
    trial = strain - state.plastic
    volume = trial.sum(axis=1)
    deviator = 2.0 * mu * (trial - np.outer(volume, _HYDROSTATIC))
    q = np.sqrt(1.5 * (deviator**2).sum(axis=1))
    gamma = np.zeros(len(q))
    flowing = q > yield_curve(material.hardening, state.eqps)[0]
    for _ in range(60):  # the yield curve is concave: Newton from zero never goes too far
        y, slope = yield_curve(material.hardening, state.eqps + gamma)
        step = np.where(flowing, (q - 3.0 * mu * gamma - y) / (3.0 * mu + slope), 0.0)
        gamma += step
        if np.abs(step).max(initial=0.0) < 1e-15:
            break
    direction = deviator / np.where(q > 0.0, q, 1.0)[:, None]  # 2/3 of the flow per unit of accumulated strain
    tau = kappa * volume[:, None] + deviator - 3.0 * mu * gamma[:, None] * direction
    b = 3.0 * mu * gamma / np.where(q > 0.0, q, 1.0)
    slope = yield_curve(material.hardening, state.eqps + gamma)[1]
    turn = np.where(flowing, 3.0 * mu / (3.0 * mu + slope) - b, 0.0)
    moduli = (
        kappa
        + 2.0 * mu * (1.0 - b)[:, None, None] * (np.eye(3) - 1.0 / 3.0)
        - 3.0 * mu * turn[:, None, None] * direction[:, :, None] * direction[:, None, :]
    )
    return tau, moduli, State(state.plastic + 1.5 * gamma[:, None] * direction, state.eqps + gamma)


def stretched(material: J2, stretch: Floats, state: State) -> tuple[Floats, Floats, State]:
    """Force per reference area along 1, its derivative by the stretch, and the new state, at sigma_33 = 0."""
    strain = np.zeros((len(stretch), 3))
    strain[:, 0] = np.log(stretch)
    strain[:, 2] = state.plastic[:, 2]
    for _ in range(60):
        tau, moduli, after = flow(material, strain, state)
        if np.abs(tau[:, 2]).max() < 1e-11 * material.mu:
            break
        strain[:, 2] -= tau[:, 2] / moduli[:, 2, 2]
    modulus = moduli[:, 0, 0] - moduli[:, 0, 2] ** 2 / moduli[:, 2, 2]
    return tau[:, 0] / stretch, (modulus - tau[:, 0]) / stretch**2, after


def equal_fibres(count: int) -> tuple[Floats, Floats]:
    """Abscissae and weights on [-1, 1] of fibres of one size."""
    t: Floats = np.linspace(-1.0, 1.0, 2 * count + 1, dtype=np.float64)[1::2]
    w: Floats = np.full(count, 2.0 / count, dtype=np.float64)
    return t, w


class Section:
    """A section of a wide sheet, bent to one curvature after the other.

    The fibre at z has the stretch ``middle + curvature * z``, so that the moment ``integral P z dz`` is the work
    conjugate of the curvature. The stretch of the mid-line is found from N = 0; but with a rule of a few points the
    mid-line keeps its length, since N = 0 has no solution once all points flow.

    Parameters
    ----------
    material : J2
        The law.
    thickness : float
        Thickness of the sheet.
    rule : tuple of ndarray, optional
        Abscissae and weights on [-1, 1]; by default 1000 equal fibres.
    """

    def __init__(self, material: J2, thickness: float, rule: tuple[Floats, Floats] | None = None) -> None:
        self.held = rule is not None
        t, w = rule or equal_fibres(1000)
        self.material = material
        self.z: Floats = 0.5 * thickness * t
        self.weights: Floats = 0.5 * thickness * w
        self.state = State.virgin(len(self.z))
        self.middle = 1.0

    def bend(self, curvature: float) -> float:
        """Bend (or unbend) to a curvature; returns the moment per width."""
        for _ in range(60):
            force, modulus, after = stretched(self.material, self.middle + curvature * self.z, self.state)
            if self.held:
                break
            change = float(self.weights @ force) / float(self.weights @ modulus)
            if abs(change) < 1e-14:
                break
            self.middle -= change
        self.state = after
        return float(self.weights @ (force * self.z))


@dataclass(frozen=True)
class BendingPath:
    """Bending to a curvature and back to zero moment: arrays over the states of loading and unloading."""

    curvature: Floats
    moment: Floats
    curvature_back: Floats
    moment_back: Floats

    @property
    def residual_curvature(self) -> float:
        """Curvature that is left without moment."""
        return zero_moment(self.curvature_back, self.moment_back)


def zero_moment(curvature: Floats, moment: Floats) -> float:
    """Curvature at which the moment of an unloading vanishes; NaN if it does not."""
    return float(np.interp(0.0, moment[::-1], curvature[::-1])) if moment[-1] <= 0.0 else float("nan")


def bending_path(
    material: J2,
    thickness: float,
    curvature: float,
    *,
    steps: int = 150,
    rule: tuple[Floats, Floats] | None = None,
) -> BendingPath:
    """Bend a section to a curvature and unload it to a quarter beyond zero moment."""
    section = Section(material, thickness, rule)
    up = np.linspace(0.0, curvature, steps + 1)
    moment = np.array([section.bend(k) for k in up])
    stiffness = plane_strain_modulus(material) * thickness**3 / 12.0
    if rule is not None:
        stiffness *= 1.5 * float(rule[1] @ rule[0] ** 2)
    back = curvature - np.linspace(0.0, 1.25, 26) * moment[-1] / stiffness
    return BendingPath(up, moment, back, np.array([section.bend(k) for k in back]))


def plane_strain_modulus(material: Plastic) -> float:
    """E' = E / (1 - nu^2)."""
    return material.E / (1.0 - material.nu**2)


def classical_moment(material: J2, modulus: float, thickness: float, curvature: float) -> float:
    """Moment per width of the classical theory: elastic core with E', flow at 2/sqrt(3) y from the first on.

    ``modulus`` is the slope H of linear hardening; in plane strain the plastic tangent is 4/3 H in series with E'.
    """
    elastic = plane_strain_modulus(material)
    flow_stress = 2.0 / np.sqrt(3.0) * float(yield_curve(material.hardening, np.zeros(1))[0][0])
    tangent = elastic * (4.0 / 3.0 * modulus) / (elastic + 4.0 / 3.0 * modulus)
    core = min(flow_stress / (elastic * curvature), 0.5 * thickness)
    half = 0.5 * thickness
    plastic = 0.5 * flow_stress * (half**2 - core**2)
    hardened = tangent * curvature * ((half**3 - core**3) / 3.0 - core * (half**2 - core**2) / 2.0)
    return float(2.0 * (elastic * curvature * core**3 / 3.0 + plastic + hardened))

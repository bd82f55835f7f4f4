"""An independent reference: rate equations of cyclic plasticity in plane strain at sigma_33 = 0, fibre by fibre.

The fibres of a wide sheet are stretched along 1, held along 2 and free along 3. The rates are integrated by the
explicit midpoint rule in many steps; no return map is solved, but for a last correction onto the yield surface.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from umform.materials import Chaboche, Metal, YoshidaUemori
from umform_book.plastic.plane_strain import equal_fibres, yield_curve

Floats = NDArray[np.float64]

FIBRES = 200
_THIRD = np.full((3, 3), 1.0 / 3.0)


@dataclass(frozen=True)
class State:
    """History of n fibres: principal logarithmic strains and their plastic parts, back stresses, sizes.

    Attributes
    ----------
    strain, plastic : ndarray, shape (n, 3)
        Along, across and through the sheet.
    eqps : ndarray, shape (n,)
        Accumulated plastic strain.
    back : ndarray, shape (parts, n, 3)
        Back stresses of Chaboche; or the centre of the bounding surface, and that of the yield surface less it.
    growth, radius : ndarray, shape (n,)
        R and the radius of the surface of stagnation.
    centre : ndarray, shape (n, 3)
        Its centre.
    """

    strain: Floats
    plastic: Floats
    eqps: Floats
    back: Floats
    growth: Floats
    radius: Floats
    centre: Floats


def virgin(metal: Metal, fibres: int) -> State:
    """Nothing has flowed yet."""
    parts = len(metal.back_stress.parts) if isinstance(metal.back_stress, Chaboche) else 2
    zero, zeros = np.zeros(fibres), np.zeros((fibres, 3))
    return State(zeros, zeros, zero, np.zeros((parts, fibres, 3)), zero, zero, zeros)


def size_of(tensor: Floats) -> Floats:
    """Norm of von Mises."""
    return np.asarray(np.sqrt(1.5 * (tensor**2).sum(axis=-1)))


def _moduli(metal: Metal, eqps: Floats) -> tuple[Floats, Floats, Floats]:
    """Lame's constants, and the rate of the modulus over it."""
    E0 = metal.E
    fall, rate = (0.0, 0.0) if metal.modulus is None else (E0 - metal.modulus.saturated, metal.modulus.rate)
    E = E0 - fall * (1.0 - np.exp(-rate * eqps))
    mu = E / (2.0 * (1.0 + metal.nu))
    return mu * 2.0 * metal.nu / (1.0 - 2.0 * metal.nu), mu, -fall * rate * np.exp(-rate * eqps) / E


def stress(metal: Metal, state: State) -> Floats:
    """Principal Kirchhoff stresses."""
    lame, mu, _ = _moduli(metal, state.eqps)
    elastic = state.strain - state.plastic
    return np.asarray(lame[:, None] * elastic.sum(axis=1)[:, None] + 2.0 * mu[:, None] * elastic)


def _overstress(metal: Metal, state: State) -> tuple[Floats, Floats]:
    """Deviator from the centre of the yield surface, and the yield function."""
    tau = stress(metal, state)
    xi = tau - tau @ _THIRD - state.back.sum(axis=0)
    return xi, size_of(xi) - yield_curve(metal.hardening, state.eqps)[0]


def _rates(metal: Metal, state: State, along: Floats) -> tuple[Floats, Floats, Floats]:
    """Plastic strain, its direction and the rates of the back stresses by it, for a strain along the sheet."""
    lame, mu, fall = _moduli(metal, state.eqps)
    xi, _ = _overstress(metal, state)
    size = np.maximum(size_of(xi), 1e-12)
    n = 1.5 * xi / size[:, None]
    backs = _back_rates(metal, state, xi / size[:, None])
    hardening = yield_curve(metal.hardening, state.eqps)[1] + (n * backs.sum(axis=0)).sum(axis=1)
    denominator = 3.0 * mu + hardening - fall * (n * stress(metal, state)).sum(axis=1)
    denominator -= 4.0 * mu**2 * n[:, 2] ** 2 / (lame + 2.0 * mu)
    dp = 2.0 * mu * (n[:, 0] - n[:, 2] * lame / (lame + 2.0 * mu)) * along / denominator
    return np.maximum(dp, 0.0), n, backs


def _back_rates(metal: Metal, state: State, direction: Floats) -> Floats:
    """Rates of the back stresses by the plastic strain; direction: xi over its size."""
    law = metal.back_stress
    if isinstance(law, Chaboche):
        f = 1.0 + (law.first - 1.0) * np.exp(-law.rate * state.eqps)
        rows = [C * f[:, None] * direction - g * a for (C, g), a in zip(law.parts, state.back, strict=True)]
        return np.array(rows)
    if not isinstance(law, YoshidaUemori):
        return np.zeros_like(state.back)
    room = law.B + state.growth - yield_curve(metal.hardening, state.eqps)[0]
    beta, star = state.back
    recall = np.sqrt(room / np.maximum(size_of(star), 1e-12))[:, None] * star
    return np.array([law.m * (law.b * direction - beta), law.C * (room[:, None] * direction - recall)])


def _flowed(metal: Metal, state: State, along: Floats, dp: Floats, n: Floats, backs: Floats) -> State:
    """The state after a strain along the sheet, with sigma_33 = 0 again."""
    eqps = state.eqps + dp
    plastic, back = state.plastic + dp[:, None] * n, state.back + dp[:, None] * backs
    strain = state.strain + np.outer(along, [1.0, 0.0, 0.0])
    lame, mu, _ = _moduli(metal, eqps)
    elastic = strain - plastic
    through = -lame * (elastic[:, 0] + elastic[:, 1]) / (lame + 2.0 * mu) + plastic[:, 2]
    strain = np.column_stack([strain[:, :2], through])
    return replace(state, strain=strain, plastic=plastic, eqps=eqps, back=back)


def _stagnated(metal: Metal, before: State, after: State) -> State:
    """Growth of the bounding surface, and the surface that makes it stagnate."""
    law = metal.back_stress
    if not isinstance(law, YoshidaUemori):
        return after
    away = after.back[0] - before.centre
    eta, was = size_of(away), size_of(before.back[0] - before.centre)
    outside = eta > before.radius
    radius = np.where(outside, before.radius + law.h * (eta - before.radius), before.radius)
    share = np.where(outside, (eta - before.radius) / np.maximum(eta - was, 1e-300), 0.0)
    share = np.clip(share, 0.0, 1.0)
    centre = np.where(
        outside[:, None], after.back[0] - (radius / np.maximum(eta, 1e-300))[:, None] * away, before.centre
    )
    growth = before.growth + law.m * (law.growth - before.growth) * share * (after.eqps - before.eqps)
    return replace(after, radius=radius, centre=centre, growth=growth)


def _none(state: State) -> tuple[Floats, Floats, Floats]:
    return np.zeros(len(state.eqps)), np.zeros_like(state.strain), np.zeros_like(state.back)


def advance(metal: Metal, state: State, along: Floats) -> State:
    """One step: elastic to the yield surface, then along it."""
    elastic = _flowed(metal, state, along, *_none(state))
    f0, f1 = _overstress(metal, state)[1], _overstress(metal, elastic)[1]
    part = np.where(f1 > 0.0, np.clip(-f0 / np.where(f1 > f0, f1 - f0, 1.0), 0.0, 1.0), 1.0)
    for _ in range(3):  # the yield function is not linear along the elastic path
        f = _overstress(metal, _flowed(metal, state, part * along, *_none(state)))[1]
        slope = np.where(f1 > f, (f1 - f) / np.maximum(1.0 - part, 1e-12), 1.0)
        part = np.where((f1 > 0.0) & (part < 1.0), np.clip(part - f / slope, 0.0, 1.0), part)
    at_yield = _flowed(metal, state, part * along, *_none(state))
    rest = (1.0 - part) * along
    half = _flowed(metal, at_yield, 0.5 * rest, *_rates(metal, at_yield, 0.5 * rest))
    _, n, backs = _rates(metal, half, rest)
    dp = _rates(metal, half, rest)[0]
    new = _flowed(metal, at_yield, rest, dp, n, backs)
    drift = np.maximum(_overstress(metal, new)[1], 0.0)
    lame, mu, _ = _moduli(metal, new.eqps)
    more = drift / (3.0 * mu - 4.0 * mu**2 * n[:, 2] ** 2 / (lame + 2.0 * mu))
    return _stagnated(metal, state, _flowed(metal, new, np.zeros_like(rest), more, n, backs))


@dataclass
class Fibres:
    """A section of a wide sheet: the fibre at z has the stretch of the mid-line plus the curvature times z.

    Attributes
    ----------
    metal : Metal
        With the yield function of von Mises.
    thickness : float
        Of the sheet.
    step : float
        Largest strain of a fibre in a step.
    count : int
        Fibres.
    """

    metal: Metal
    thickness: float = 1.0
    step: float = 1e-4
    count: int = FIBRES
    state: State = field(init=False)

    def __post_init__(self) -> None:
        t, w = equal_fibres(self.count)
        self.z: Floats = 0.5 * self.thickness * t
        self.weights: Floats = 0.5 * self.thickness * w
        self.state = virgin(self.metal, self.count)

    def bend(self, stretch: float, curvature: float) -> tuple[float, float]:
        """Go on to a stretch of the mid-line and a curvature; returns force and moment per width."""
        new = np.log(stretch + curvature * self.z)
        change = new - self.state.strain[:, 0]
        steps = max(1, int(np.ceil(np.abs(change).max() / self.step)))
        for _ in range(steps):
            self.state = advance(self.metal, self.state, change / steps)
        force = stress(self.metal, self.state)[:, 0] * np.exp(-self.state.strain[:, 0])
        return float(self.weights @ force), float(self.weights @ (force * self.z))


def path_of(section: Fibres, corners: Sequence[tuple[float, float]], increments: int) -> tuple[Floats, Floats, Floats]:
    """Curvature, force and moment on straight paths between corners of stretch and curvature, from the flat sheet."""
    rows, last = [(0.0, 0.0, 0.0)], (1.0, 0.0)
    for corner in corners:
        for part in np.linspace(0.0, 1.0, increments + 1)[1:]:
            stretch, curvature = (a + part * (b - a) for a, b in zip(last, corner, strict=True))
            rows.append((curvature, *section.bend(stretch, curvature)))
        last = corner
    curvature, force, moment = np.array(rows).T
    return curvature, force, moment

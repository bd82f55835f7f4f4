"""References of the thick-walled tube: Hill's closed form, and the law itself along a radius in numpy."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_banded

from umform.materials import J2
from umform_book.plastic.plane_strain import State, flow, plane_strain_modulus, yield_curve

Floats = NDArray[np.float64]


def yield_difference(material: J2) -> float:
    """Difference of the principal stresses at flow in plane strain, 2 k = 2/sqrt(3) y."""
    return float(2.0 / np.sqrt(3.0) * yield_curve(material.hardening, np.zeros(1))[0][0])


def hill_pressure(material: J2, inner: float, outer: float, c: Floats) -> Floats:
    """Pressure at the plastic radius c, p = 2 k (ln(c/a) + (1 - c^2/b^2)/2)."""
    pressure: Floats = yield_difference(material) * (np.log(c / inner) + 0.5 * (1.0 - (c / outer) ** 2))
    return pressure


def hill_expansion(material: J2, outer: float, c: Floats) -> Floats:
    """Radial displacement of the outer face at the plastic radius c, that of the elastic ring outside of c."""
    return yield_difference(material) * c**2 / (plane_strain_modulus(material) * outer)


@dataclass(frozen=True)
class Tube:
    """Expansion of a tube: arrays over the displacements of the inner face."""

    inner_displacement: Floats
    pressure: Floats
    plastic_radius: Floats
    outer_displacement: Floats


def expanded_tube(material: J2, inner: float, outer: float, displacements: Floats, intervals: int = 400) -> Tube:
    """Expand a tube in plane strain, small strains: linear elements along the radius with one point each."""
    r = np.linspace(inner, outer, intervals + 1)
    middle, length = 0.5 * (r[1:] + r[:-1]), np.diff(r)
    # Strains (radial, hoop) of an element from its two displacements.
    B = np.zeros((intervals, 2, 2))
    B[:, 0] = np.stack([-1.0 / length, 1.0 / length], axis=1)
    B[:, 1] = 0.5 / middle[:, None]
    volume = middle * length
    u, state = np.zeros(intervals + 1), State.virgin(intervals)
    rows = []
    for displacement in displacements:
        change = displacement - u[0]
        for _ in range(50):
            strain = np.zeros((intervals, 3))
            strain[:, :2] = np.einsum("eij,ej->ei", B, np.stack([u[:-1], u[1:]], axis=1))
            tau, moduli, after = flow(material, strain, state)
            f = np.einsum("e,eij,ei->ej", volume, B, tau[:, :2])
            residual = np.append(f[:, 0], 0.0) + np.insert(f[:, 1], 0, 0.0)
            if change == 0.0 and np.abs(residual[1:]).max() < 1e-12 * material.mu:
                break
            K = np.einsum("e,eij,eik,ekl->ejl", volume, B, moduli[:, :2, :2], B)
            bands = np.zeros((3, intervals + 1))
            bands[0, 1:], bands[2, :-1] = K[:, 0, 1], K[:, 1, 0]
            bands[1, :-1] += K[:, 0, 0]
            bands[1, 1:] += K[:, 1, 1]
            residual[0], bands[1, 0], bands[0, 1] = -change, 1.0, 0.0
            u -= solve_banded((1, 1), bands, residual)
            change = 0.0
        state = after
        flowing = np.flatnonzero(state.eqps > 0.0)
        radius = r[flowing[-1] + 1] if len(flowing) else inner
        rows.append((residual[0] / inner, radius, u[-1]))
    pressure, plastic_radius, outside = np.array(rows).T
    return Tube(np.asarray(displacements), pressure, plastic_radius, outside)

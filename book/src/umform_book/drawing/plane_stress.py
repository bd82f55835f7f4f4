"""J2 in plane stress with fixed principal axes, in numpy: the flow of the membrane."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.materials import J2
from umform_book.plastic.plane_strain import yield_curve

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class State:
    """Plastic strains (n, 2) along the meridian and around, and their equivalent (n,)."""

    plastic: Floats
    p: Floats


def flow(material: J2, strain: Floats, state: State) -> tuple[Floats, Floats, State]:
    """Backward Euler of J2 in plane stress with fixed principal axes: Kirchhoff stress, moduli (n, 2, 2), state.

    In the sum and difference of the two stresses over sqrt 2, elasticity and the quadratic form of Mises are diagonal
    (Simo & Hughes 1998, section 3.4.1).
    """
    E, nu = material.E, material.nu
    Q = np.array([[1.0, 1.0], [-1.0, 1.0]]) / np.sqrt(2.0)
    stiff, form = np.array([E / (1.0 - nu), E / (1.0 + nu)]), np.array([1.0 / 3.0, 1.0])
    trial = (strain - state.plastic) @ Q.T * stiff
    gamma, p = np.zeros(len(strain)), state.p
    y, slope = yield_curve(material.hardening, p)
    yields = 1.5 * (form * trial**2).sum(axis=1) > y**2
    for _ in range(50):
        eta = trial / (1.0 + gamma[:, None] * stiff * form)
        mises = np.sqrt(1.5 * (form * eta**2).sum(axis=1))
        p = state.p + gamma * mises / 1.5
        y, slope = yield_curve(material.hardening, p)
        miss = np.where(yields, mises - y, 0.0)
        if np.abs(miss).max() <= 1e-11 * y.max():
            break
        softer = stiff * form / (1.0 + gamma[:, None] * stiff * form)
        change = -1.5 * (form * eta**2 * softer).sum(axis=1) / np.maximum(mises, 1e-300)
        rate = change - slope * (mises + gamma * change) / 1.5
        gamma = np.maximum(gamma - miss / rate, 0.0)
    Xi = stiff / (1.0 + gamma[:, None] * stiff * form)
    across = Xi * form * eta
    square = (form * eta**2).sum(axis=1)
    beta = slope / 1.5 * square / (1.0 - slope / 1.5 * gamma)
    moduli = Xi[:, :, None] * np.eye(2)
    part = np.einsum("ei,ej->eij", across, across) / ((form * eta * across).sum(axis=1) + beta)[:, None, None]
    moduli = moduli - np.where(yields[:, None, None], part, 0.0)
    plastic = state.plastic + (gamma[:, None] * form * eta) @ Q
    return eta @ Q, np.einsum("ki,ekl,lj->eij", Q, moduli, Q), State(plastic, p)

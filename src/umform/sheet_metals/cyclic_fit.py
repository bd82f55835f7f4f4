"""Hardening curves from tension, and back stresses from cycles of tension and compression."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.errors import InvalidValue
from umform.materials import Hardening, Metal, Swift, Voce, tension
from umform.sheet_metals.least_squares import Fit, fit

Floats = NDArray[np.float64]


def fit_hardening(
    eqps: ArrayLike, stress: ArrayLike, build: Callable[[Mapping[str, float]], Hardening], start: Mapping[str, float]
) -> Fit[Hardening]:
    """Constants of a hardening curve from plastic strains and true stresses.

    Parameters
    ----------
    eqps, stress : array_like, shape (n,)
        Plastic strain and true stress.
    build : callable
        Makes the curve of its constants, ``lambda c: LinearVoce(**c)`` for one.
    start : mapping of str to float
        First guess, all positive.
    """
    strains, stresses = _pairs(eqps, stress)
    scale = 0.01 * float(np.abs(stresses).max())

    def residuals(law: Hardening) -> Floats:
        curve = law.curve()
        return (np.array([curve(e)[0] for e in strains]) - stresses) / scale

    return fit(build, residuals, start, positive=True)


def fit_swift(eqps: ArrayLike, stress: ArrayLike) -> Fit[Hardening]:
    """Swift's curve from plastic strains and true stresses."""
    top = float(np.max(np.asarray(stress, dtype=float)))
    start = {"strength": 1.5 * top, "offset": 0.005, "exponent": 0.2}
    return fit_hardening(eqps, stress, lambda c: Swift(**c), start)


def fit_voce(eqps: ArrayLike, stress: ArrayLike) -> Fit[Hardening]:
    """Voce's curve from plastic strains and true stresses."""
    values = np.asarray(stress, dtype=float)
    start = {"yield_stress": float(values.min()), "saturation": 1.05 * float(values.max()), "rate": 10.0}
    return fit_hardening(eqps, stress, lambda c: Voce(**c), start)


def fit_cycles(
    strain: ArrayLike,
    stress: ArrayLike,
    build: Callable[[Mapping[str, float]], Metal],
    start: Mapping[str, float],
    largest_step: float = 1e-3,
) -> Fit[Metal]:
    """Constants of a metal from a bar that is pulled and pushed along the rolling direction.

    Parameters
    ----------
    strain, stress : array_like, shape (n,)
        Logarithmic strains in their order, and true stresses.
    build : callable
        Makes the metal of its constants.
    start : mapping of str to float
        First guess, all positive.
    largest_step : float
        Strains farther apart than this are reached in steps.
    """
    strains, stresses = _pairs(strain, stress)
    path: list[float] = []
    ends, before = [], 0.0
    for e in strains:
        steps = max(int(np.ceil(abs(e - before) / largest_step)), 1)
        path += np.linspace(before, e, steps + 1)[1:].tolist()
        ends.append(len(path) - 1)
        before = float(e)
    scale = 0.01 * float(np.abs(stresses).max())

    def residuals(metal: Metal) -> Floats:
        return (tension(metal, path)[1][ends] - stresses) / scale

    return fit(build, residuals, start, positive=True)


def _pairs(first: ArrayLike, second: ArrayLike) -> tuple[Floats, Floats]:
    a, b = np.asarray(first, dtype=float), np.asarray(second, dtype=float)
    if a.ndim != 1 or a.shape != b.shape or len(a) < 3 or not (np.isfinite(a).all() and np.isfinite(b).all()):
        raise InvalidValue(
            "a curve is three or more pairs of finite strains and stresses",
            where="fit",
            value=f"strains {a.shape}, stresses {b.shape}",
            cause="columns of different length, or empty cells",
            remedy="one stress for each strain",
        )
    return a, b

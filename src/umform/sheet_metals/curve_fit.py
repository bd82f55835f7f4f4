"""Hardening curves from plastic strains and true stresses."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.errors import InvalidValue
from umform.materials import Hardening, Linear, LinearVoce, Perfect, Swift, Table, Voce
from umform.sheet_metals.least_squares import Fit, fit

Floats = NDArray[np.float64]
#: Points of a table.
_POINTS = 25


def fit_hardening(
    eqps: ArrayLike, stress: ArrayLike, build: Callable[[Mapping[str, float]], Hardening], start: Mapping[str, float]
) -> Fit[Hardening]:
    """Constants of a hardening curve from plastic strains and true stresses.

    Parameters
    ----------
    eqps, stress : array_like, shape (n,)
        Plastic strain and true stress.
    build : callable
        Makes the curve from its constants, for instance ``lambda c: LinearVoce(**c)``.
    start : mapping of str to float
        First guess, all positive.
    """
    strains, stresses = pairs(eqps, stress)
    scale = 0.01 * float(np.abs(stresses).max())

    def residuals(law: Hardening) -> Floats:
        curve = law.curve()
        return (np.array([curve(e)[0] for e in strains]) - stresses) / scale

    return fit(build, residuals, start, positive=True)


def fit_swift(eqps: ArrayLike, stress: ArrayLike) -> Fit[Hardening]:
    """Swift's curve from plastic strains and true stresses.

    Parameters
    ----------
    eqps, stress : array_like, shape (n,)
        Plastic strain and true stress.
    """
    top = float(np.max(np.asarray(stress, dtype=float)))
    start = {"strength": 1.5 * top, "offset": 0.005, "exponent": 0.2}
    return fit_hardening(eqps, stress, lambda c: Swift(**c), start)


def fit_voce(eqps: ArrayLike, stress: ArrayLike) -> Fit[Hardening]:
    """Voce's curve from plastic strains and true stresses.

    Parameters
    ----------
    eqps, stress : array_like, shape (n,)
        Plastic strain and true stress.
    """
    values = np.asarray(stress, dtype=float)
    start = {"yield_stress": float(values.min()), "saturation": 1.05 * float(values.max()), "rate": 10.0}
    return fit_hardening(eqps, stress, lambda c: Voce(**c), start)


def fit_linear_voce(eqps: ArrayLike, stress: ArrayLike) -> Fit[Hardening]:
    """Voce's curve with a linear part, from plastic strains and true stresses.

    Parameters
    ----------
    eqps, stress : array_like, shape (n,)
        Plastic strain and true stress.
    """
    strains, stresses = pairs(eqps, stress)
    first, top = float(stresses.min()), float(stresses.max())
    slope = max(float(np.ptp(stresses[-3:]) / max(np.ptp(strains[-3:]), 1e-12)), 0.01 * top)
    start = {"yield_stress": first, "modulus": slope, "growth": 0.7 * (top - first) + 1e-3 * top, "rate": 20.0}
    return fit_hardening(
        eqps,
        stress,
        lambda c: LinearVoce(c["yield_stress"], c["modulus"], c["yield_stress"] + c["growth"], c["rate"]),
        start,
    )


def fit_linear(eqps: ArrayLike, stress: ArrayLike) -> Fit[Hardening]:
    """A straight line, from plastic strains and true stresses.

    Parameters
    ----------
    eqps, stress : array_like, shape (n,)
        Plastic strain and true stress.
    """
    values = np.asarray(stress, dtype=float)
    start = {"yield_stress": float(values.min()), "modulus": float(np.ptp(values)) + 1e-3 * float(values.max())}
    return fit_hardening(eqps, stress, lambda c: Linear(**c), start)


def fit_perfect(eqps: ArrayLike, stress: ArrayLike) -> Fit[Hardening]:
    """A constant yield stress, from plastic strains and true stresses.

    Parameters
    ----------
    eqps, stress : array_like, shape (n,)
        Plastic strain and true stress.
    """
    return fit_hardening(
        eqps, stress, lambda c: Perfect(**c), {"yield_stress": float(np.mean(np.asarray(stress, dtype=float)))}
    )


def fit_table(eqps: ArrayLike, stress: ArrayLike) -> Fit[Hardening]:
    """An increasing table of at most 25 points, means over equal numbers of measurements, without other smoothing.

    Parameters
    ----------
    eqps, stress : array_like, shape (n,)
        Plastic strain and true stress.
    """
    strains, stresses = pairs(eqps, stress)
    order = np.argsort(strains, kind="stable")
    parts = np.array_split(order, min(_POINTS, len(order)))
    e, s = (np.array([values[part].mean() for part in parts]) for values in (strains, stresses))
    rising = np.concatenate([[True], np.diff(e) > 0.0])
    e, s = e[rising], np.maximum.accumulate(s[rising])
    first = max(float(s[0] - e[0] * (s[1] - s[0]) / (e[1] - e[0])), 0.5 * float(s[0]))
    if e[0] > 0.0:
        e, s = np.concatenate([[0.0], e]), np.concatenate([[first], s])
    law = Table(tuple(e.tolist()), tuple(s.tolist()))
    curve, scale = law.curve(), 0.01 * float(np.abs(stresses).max())
    residual = np.array([curve(p)[0] for p in strains]) - stresses
    return Fit(law, {}, {}, float(np.sqrt(np.mean((residual / scale) ** 2))))


#: Fits of the hardening curves by name.
CURVE_FITS: dict[str, Callable[[ArrayLike, ArrayLike], Fit[Hardening]]] = {
    "swift": fit_swift,
    "voce": fit_voce,
    "linear-voce": fit_linear_voce,
    "linear": fit_linear,
    "perfect": fit_perfect,
    "table": fit_table,
}


def pairs(first: ArrayLike, second: ArrayLike) -> tuple[Floats, Floats]:
    """Two columns of numbers, checked."""
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

"""A falling Young's modulus from the slopes of unloading at several plastic strains."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.materials import FallingModulus
from umform.sheet_metals.curve_fit import pairs
from umform.sheet_metals.least_squares import Fit, fit

Floats = NDArray[np.float64]


def fit_falling_modulus(eqps: ArrayLike, modulus: ArrayLike, young: float) -> Fit[FallingModulus]:
    """Limit and rate of a falling modulus from slopes of unloading.

    Parameters
    ----------
    eqps, modulus : array_like, shape (n,)
        Plastic strains, and the slope of unloading from each.
    young : float
        Young's modulus without plastic strain.

    Returns
    -------
    Fit
        Constants saturated and rate; the misfit is in units of 1 % of Young's modulus.
    """
    strains, slopes = pairs(eqps, modulus)
    lowest = float(np.clip(slopes.min(), 0.4 * young, 0.99 * young))
    start = {"saturated": lowest, "rate": 1.0 / max(float(np.median(strains)), 1e-3)}

    def build(c: Mapping[str, float]) -> FallingModulus:
        return FallingModulus(**c)

    def residuals(law: FallingModulus) -> Floats:
        return (law.share(young, strains) - slopes / young) / 0.01

    return fit(build, residuals, start, positive=True, bounds={"saturated": (young / 3.0, young)})

"""Back stresses from cycles of tension and compression: Chaboche with one to four parts, Yoshida and Uemori."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.materials import (
    Chaboche,
    FallingModulus,
    Metal,
    Mises,
    Perfect,
    Voce,
    YieldFunction,
    YoshidaUemori,
    tension,
)
from umform.sheet_metals.curve_fit import pairs
from umform.sheet_metals.least_squares import Fit, fit

Floats = NDArray[np.float64]
#: Strains and stresses of a bar, one test.
Test = tuple[ArrayLike, ArrayLike]

#: Flat valleys, of correlated constants, are not followed farther.
_TOLERANCE = 1e-6
#: Recalls of the back stresses of a first guess.
_RECALLS = ((60.0,), (200.0, 15.0), (500.0, 60.0, 6.0), (1000.0, 150.0, 25.0, 4.0))


def fit_cycles(
    strain: ArrayLike,
    stress: ArrayLike,
    build: Callable[[Mapping[str, float]], Metal],
    start: Mapping[str, float],
    largest_step: float = 1e-3,
) -> Fit[Metal]:
    """Constants of a metal from tension and compression of a bar along the rolling direction.

    Parameters
    ----------
    strain, stress : array_like, shape (n,)
        Logarithmic strains in order, and true stresses.
    build : callable
        Makes the metal from its constants.
    start : mapping of str to float
        First guess, all positive.
    largest_step : float
        Larger strain differences are divided into steps.
    """
    return fit_tests([(strain, stress)], build, start, largest_step)


def fit_tests(
    tests: Sequence[Test],
    build: Callable[[Mapping[str, float]], Metal],
    start: Mapping[str, float],
    largest_step: float = 1e-3,
    bounds: Mapping[str, tuple[float, float]] | None = None,
) -> Fit[Metal]:
    """Constants of a metal from several tests along the rolling direction; parameters as in :func:`fit_cycles`."""
    prepared = [_prepared(*test, largest_step) for test in tests]

    def residuals(metal: Metal) -> Floats:
        found = [(tension(metal, path)[1][ends] - stresses) / scale for path, ends, stresses, scale in prepared]
        return np.concatenate(found)

    return fit(build, residuals, start, positive=True, bounds=bounds, tolerance=_TOLERANCE)


def fit_chaboche(
    tests: Sequence[Test],
    parts: int,
    young: float,
    poisson: float,
    yield_function: YieldFunction | None = None,
    largest_step: float = 1e-3,
    modulus: FallingModulus | None = None,
) -> Fit[Metal]:
    """Voce's hardening and back stresses of Chaboche from tests along the rolling direction.

    Parameters
    ----------
    tests : sequence of pairs of array_like
        Logarithmic strains and true stresses of each test; one at least must turn back. NaN is a stress that was not
        measured: the strains must include every turning point.
    parts : int
        Number of back stresses, 1 to 4.
    young, poisson : float
        Elastic constants.
    yield_function : YieldFunction, optional
        Default: von Mises.
    largest_step : float
        Larger strain differences are divided into steps.
    modulus : FallingModulus, optional
        Decrease of Young's modulus.

    Returns
    -------
    Fit
        Constants Y, Q, d of Y + Q (1 - exp(-d p)), and C1, gamma1, ...
    """
    first, top = _levels(tests, young)
    metal = partial(Metal, young, poisson, yield_function=yield_function or Mises(), modulus=modulus)
    recalls = _RECALLS[parts - 1]
    start = {"Y": 0.8 * first, "Q": 0.3 * (top - 0.8 * first), "d": 10.0}
    for number, recall in enumerate(recalls, start=1):
        start |= {f"C{number}": recall * 0.6 * (top - 0.8 * first) / parts, f"gamma{number}": recall}

    def build(c: Mapping[str, float]) -> Metal:
        back = Chaboche(tuple((c[f"C{n}"], c[f"gamma{n}"]) for n in range(1, parts + 1)))
        curve = Voce(c["Y"], c["Y"] + c["Q"], c["d"])
        return metal(hardening=curve, back_stress=back)

    return fit_tests(tests, build, start, largest_step, bounds={"Y": (0.05 * top, top)})


def fit_yoshida_uemori(
    tests: Sequence[Test],
    young: float,
    poisson: float,
    yield_function: YieldFunction | None = None,
    largest_step: float = 1e-3,
    modulus: FallingModulus | None = None,
) -> Fit[Metal]:
    """The two surfaces of Yoshida and Uemori from tests along the rolling direction; parameters as `fit_chaboche`.

    Returns
    -------
    Fit
        Constants Y, C, B - Y, growth, b, m and h. Without a large cycle that follows a reversal, h is not determined.
    """
    first, top = _levels(tests, young)
    metal = partial(Metal, young, poisson, yield_function=yield_function or Mises(), modulus=modulus)
    small = 0.8 * first
    start = {"Y": small, "C": 300.0, "B - Y": 0.4 * (top - small), "growth": 0.6 * (top - small)}
    start |= {"b": 0.2 * (top - small), "m": 15.0, "h": 0.5}

    def build(c: Mapping[str, float]) -> Metal:
        back = YoshidaUemori(c["C"], c["Y"] + c["B - Y"], c["growth"], c["b"], c["m"], c["h"])
        return metal(hardening=Perfect(c["Y"]), back_stress=back)

    return fit_tests(tests, build, start, largest_step, bounds={"h": (0.0, 1.0), "Y": (0.05 * top, top)})


def _levels(tests: Sequence[Test], young: float) -> tuple[float, float]:
    """Stress where the first test leaves Hooke's line by a strain of 2e-4, and the largest stress."""
    strain, stress = _test(*tests[0])
    with np.errstate(invalid="ignore"):
        over = np.flatnonzero(np.abs(strain - stress / young) > 2e-4)
    top = max(float(np.nanmax(np.abs(_test(*test)[1]))) for test in tests)
    return (abs(float(stress[over[0]])) if len(over) else top), top


def _prepared(
    strain: ArrayLike, stress: ArrayLike, largest_step: float
) -> tuple[list[float], list[int], Floats, float]:
    """Path of a test in small steps, where its measurements lie on it, these, and 1 % of the largest stress."""
    strains, stresses = _test(strain, stress)
    path: list[float] = []
    ends, before = [], 0.0
    for e in strains:
        steps = max(int(np.ceil(abs(e - before) / largest_step)), 1)
        path += np.linspace(before, e, steps + 1)[1:].tolist()
        ends.append(len(path) - 1)
        before = float(e)
    known = np.isfinite(stresses)
    measured = stresses[known]
    return path, np.array(ends)[known].tolist(), measured, 0.01 * float(np.abs(measured).max())


def _test(strain: ArrayLike, stress: ArrayLike) -> tuple[Floats, Floats]:
    """Strains and stresses, NaN at strains without a measured stress."""
    strains, stresses = np.asarray(strain, dtype=float), np.asarray(stress, dtype=float)
    known = np.isfinite(stresses) if stresses.shape == strains.shape else slice(None)
    pairs(strains[known], stresses[known])
    return strains, stresses

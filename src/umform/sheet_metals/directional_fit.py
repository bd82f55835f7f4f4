"""Yield functions from tension at several angles and biaxial tension."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.materials import Hill48, Transformation, YieldFunction, Yld2004
from umform.sheet_metals.least_squares import Fit, fit

Floats = NDArray[np.float64]

#: The same share of the stress may be added to all normal components of both transformed stresses: one row stays.
_OF_FIRST = ("c21", "c23", "c31", "c32", "shear12")
_OF_SECOND = ("c12", "c13", "c21", "c23", "c31", "c32", "shear12")
#: Starts of Yld2004, whose sum of squares has several minima.
_STARTS, _SPREAD = 12, 0.3


@dataclass(frozen=True)
class Directions:
    """Measurements of a sheet; missing ones are left out.

    Attributes
    ----------
    stress : mapping of float to float
        Yield stress relative to that of the hardening curve, by the angle to the rolling direction in degrees.
    r : mapping of float to float
        r-value by the same angle.
    biaxial : float, optional
        Equibiaxial yield stress, relative to that of the curve.
    r_biaxial : float, optional
        Ratio of the strains across and along the rolling direction in that test.
    """

    stress: Mapping[float, float]
    r: Mapping[float, float]
    biaxial: float | None = None
    r_biaxial: float | None = None

    def __post_init__(self) -> None:
        given = {**{f"stress at {a}": s for a, s in self.stress.items()}, **{f"r at {a}": r for a, r in self.r.items()}}
        given |= {name: v for name in ("biaxial", "r_biaxial") if (v := getattr(self, name)) is not None}
        for name, value in given.items():
            if not (math.isfinite(value) and value > 0):
                raise InvalidValue(
                    f"{name} must be positive",
                    where="Directions",
                    value=value,
                    cause="a sign, or an empty cell of a table",
                    remedy="leave out what was not measured",
                )


def uniaxial(function: YieldFunction, angle: float) -> tuple[float, float]:
    """Tension at an angle to the rolling direction. eq. (3.140)

    Parameters
    ----------
    function : YieldFunction
        The yield function.
    angle : float
        Degrees from the rolling direction.

    Returns
    -------
    stress, r : float
        Yield stress relative to that of the curve, and r-value.
    """
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    phi, n = function.function()(np.array([c * c, s * s, 0.0, c * s, 0.0, 0.0]))
    return 1.0 / phi, float(s * s * n[0] + c * c * n[1] - c * s * n[3]) / float(n[2])


def balanced(function: YieldFunction) -> tuple[float, float]:
    """Equibiaxial tension.

    Parameters
    ----------
    function : YieldFunction
        The yield function.

    Returns
    -------
    stress, r : float
        Yield stress relative to that of the curve, and ratio of the strains across and along the rolling direction.
    """
    phi, n = function.function()(np.array([1.0, 1.0, 0.0, 0.0, 0.0, 0.0]))
    return 1.0 / phi, float(n[1] / n[0])


def fit_hill48(measured: Directions) -> Fit[Hill48]:
    """Hill (1948) by least squares from stresses and r-values, which its four constants cannot all meet.

    Parameters
    ----------
    measured : Directions
        Stresses and r-values over the angle, and the biaxial point.
    """

    def build(constants: Mapping[str, float]) -> Hill48:
        return Hill48(constants["r0"], constants["r45"], constants["r90"])

    start = {f"r{angle}": float(measured.r.get(angle, 1.0)) for angle in (0, 45, 90)}
    return fit(build, lambda function: _residuals(function, measured), start, positive=True)


def fit_yld2004(measured: Directions, exponent: float = Yld2004.exponent) -> Fit[Yld2004]:
    """Yld2004-18p by least squares, the best of twelve starts; the shears 23 and 13, which sheet tests do not
    determine, stay 1.

    Parameters
    ----------
    measured : Directions
        Seven angles with stress and r, and the biaxial point, determine the function well.
    exponent : float
        6 for bcc metals, 8 for fcc metals.
    """

    def build(constants: Mapping[str, float]) -> Yld2004:
        first = Transformation(**{name: constants[f"first.{name}"] for name in _OF_FIRST})
        second = Transformation(**{name: constants[f"second.{name}"] for name in _OF_SECOND})
        return Yld2004(first, second, exponent)

    names = [f"first.{name}" for name in _OF_FIRST] + [f"second.{name}" for name in _OF_SECOND]
    random = np.random.default_rng(0)
    guesses = [dict(zip(names, 1.0 + _SPREAD * random.normal(size=len(names)), strict=True)) for _ in range(_STARTS)]
    fits = [fit(build, lambda function: _residuals(function, measured), guess, positive=False) for guess in guesses]
    return min(fits, key=lambda found: found.misfit)


def _residuals(function: YieldFunction, measured: Directions) -> Floats:
    """Differences of stresses over 1 %, of r-values over 5 %: their measurement uncertainties."""
    found = [(uniaxial(function, angle)[0] - stress) / (0.01 * stress) for angle, stress in measured.stress.items()]
    found += [(uniaxial(function, angle)[1] - r) / (0.05 * max(r, 0.2)) for angle, r in measured.r.items()]
    if measured.biaxial is not None:
        found.append((balanced(function)[0] - measured.biaxial) / (0.01 * measured.biaxial))
    if measured.r_biaxial is not None:
        found.append((balanced(function)[1] - measured.r_biaxial) / (0.05 * measured.r_biaxial))
    return np.array(found)

"""A law from measurements: yield function, then hardening and back stress along the rolling direction."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from umform.errors import InvalidValue
from umform.materials import J2, FallingModulus, Hardening, Hill48, Metal, Mises, YieldFunction, Yld2004
from umform.sheet_metals import (
    CURVE_FITS,
    Fit,
    fit_chaboche,
    fit_falling_modulus,
    fit_hill48,
    fit_yld2004,
    fit_yoshida_uemori,
    uniaxial,
)
from umform.spec import check_value
from umform.studies.calibration.measurements import Measurements, Test

YIELD_FUNCTIONS = ("hill48", "yld2004")
HARDENINGS = ("auto", *CURVE_FITS)
BACK_STRESSES = ("chaboche1", "chaboche2", "chaboche3", "chaboche4", "yoshida-uemori")
#: Curves from which the best one is selected.
_CANDIDATES = ("swift", "voce", "linear-voce")
#: Plastic strain below which a tension test depends more on the extensometer than on the metal.
_FIRST_PLASTIC = 5e-4
#: Rounds in which plastic strains and the modulus that falls with them find each other: each gains two digits.
_ROUNDS = 8


@dataclass(frozen=True)
class Calibration:
    """Result of a calibration.

    Attributes
    ----------
    measurements : Measurements
        The data.
    law : J2 or Metal or None
        The law; None if only values over the angle were given.
    yield_function : YieldFunction
        Its yield function.
    fits : mapping of str to Fit
        The fits of the law, by "yield function", "modulus", "hardening" and "cycles".
    others : mapping of str to float
        Misfits of the other hardening curves.
    young : float
        Young's modulus.
    """

    measurements: Measurements
    law: J2 | Metal | None
    yield_function: YieldFunction
    fits: Mapping[str, Fit[Any]]
    others: Mapping[str, float] = field(default_factory=dict)
    young: float = 0.0


def calibrate(
    measurements: Measurements,
    young: float,
    poisson: float = 0.3,
    *,
    yield_function: str = "hill48",
    exponent: float = Yld2004.exponent,
    hardening: str = "auto",
    back_stress: str = "chaboche2",
    largest_step: float = 1e-3,
) -> Calibration:
    """Fit a law to measurements.

    Parameters
    ----------
    measurements : Measurements
        Measurements, at least of one kind.
    young, poisson : float
        Elastic constants.
    yield_function : {"hill48", "yld2004"}
        Function to fit to the values over the angle.
    exponent : float
        Of Yld2004: 6 for bcc metals, 8 for fcc metals.
    hardening : str
        Curve to fit to tension, one of `HARDENINGS`; "auto": the best of Swift, Voce and the sum of linear and Voce.
    back_stress : str
        Model to fit to cycles, one of `BACK_STRESSES`; its hardening is then Voce's, or none.
    largest_step : float
        Largest strain increment along the cycles.

    Raises
    ------
    InvalidValue
        If there are no measurements, a name is unknown, or a constant is impossible.
    """
    for name, value, known in (
        ("yield_function", yield_function, YIELD_FUNCTIONS),
        ("hardening", hardening, HARDENINGS),
        ("back_stress", back_stress, BACK_STRESSES),
    ):
        if value not in known:
            raise InvalidValue(
                f"unknown {name.replace('_', ' ')}", where=name, value=value, remedy=f"one of {', '.join(known)}"
            )
    if measurements == Measurements():
        raise InvalidValue(
            "there are no measurements to fit",
            where="angles, tension, cycles",
            cause="no file of measurements",
            remedy="values over the angle, a tension test, or cycles of tension and compression",
        )
    for argument, constant, number in (("young", "E", young), ("poisson", "nu", poisson)):
        try:
            check_value(J2, constant, number)
        except InvalidValue as error:
            error.where = argument
            raise
    fits: dict[str, Fit[Any]] = {}
    function: YieldFunction = Mises()
    if measurements.directions is not None:
        found = _function(measurements, yield_function, exponent)
        fits["yield function"], function = found, found.law
    modulus: FallingModulus | None = None
    if measurements.unloading is not None:
        slopes = fit_falling_modulus(measurements.unloading.eqps, measurements.unloading.modulus, young)
        fits["modulus"], modulus = slopes, slopes.law
    law: J2 | Metal | None = None
    others: dict[str, float] = {}
    if measurements.cycles is not None:
        cycles = _cycles(measurements, young, poisson, function, back_stress, largest_step, modulus)
        fits["cycles"], law = cycles, cycles.law
    elif measurements.tension is not None:
        curve, others = _curve(measurements.tension, young, function, hardening, modulus)
        fits["hardening"] = curve
        law = (
            J2(young, poisson, hardening=curve.law)
            if isinstance(function, Mises) and modulus is None
            else Metal(young, poisson, hardening=curve.law, yield_function=function, modulus=modulus)
        )
    return Calibration(measurements, law, function, fits, others, young)


def _function(measurements: Measurements, kind: str, exponent: float) -> Fit[Hill48] | Fit[Yld2004]:
    directions = measurements.directions
    assert directions is not None
    count = len(directions.stress) + len(directions.r)
    count += sum(value is not None for value in (directions.biaxial, directions.r_biaxial))
    if kind == "hill48":
        if len(directions.r) + len(directions.stress) < 3:
            raise _too_few("Hill48", count, "values at 0, 45 and 90 degrees")
        return fit_hill48(directions)
    if count < 12:
        raise _too_few("Yld2004", count, "stress and r at seven angles and the biaxial point, or hill48")
    return fit_yld2004(directions, exponent)


def _too_few(name: str, count: int, remedy: str) -> InvalidValue:
    return InvalidValue(
        f"too few measurements for {name}",
        where="yield_function",
        value=f"{count} values",
        cause="more constants than measurements",
        remedy=remedy,
    )


def _curve(
    tension: Test, young: float, function: YieldFunction, kind: str, modulus: FallingModulus | None
) -> tuple[Fit[Hardening], dict[str, float]]:
    """The hardening curve: stresses along the rolling direction over the value of the yield function there."""
    s0, _ = uniaxial(function, 0.0)
    eqps = (tension.strain - tension.stress / young) * s0  # equal plastic work
    if modulus is not None:
        for _ in range(_ROUNDS):
            present = young * modulus.share(young, np.maximum(eqps, 0.0))
            eqps = (tension.strain - tension.stress / present) * s0
    flows = eqps >= _FIRST_PLASTIC
    if np.count_nonzero(flows) < 4:
        raise InvalidValue(
            "the tension test has hardly any plastic strain",
            where="tension",
            value=f"{np.count_nonzero(flows)} measurements beyond a plastic strain of {_FIRST_PLASTIC:g}",
            cause="only the elastic part, per cent in place of fractions, or a modulus too small",
            remedy="measurements up to the largest force",
        )
    eqps, stress = eqps[flows], tension.stress[flows] / s0
    names = _CANDIDATES if kind == "auto" else (kind,)
    found = {name: CURVE_FITS[name](eqps, stress) for name in names}
    best = min(found, key=lambda name: found[name].misfit)
    return found[best], {name: each.misfit for name, each in found.items()}


def _cycles(
    measurements: Measurements,
    young: float,
    poisson: float,
    function: YieldFunction,
    kind: str,
    largest_step: float,
    modulus: FallingModulus | None,
) -> Fit[Metal]:
    tests = [test for test in (measurements.cycles, measurements.tension) if test is not None]
    pairs = [(test.strain, test.stress) for test in tests]
    if kind == "yoshida-uemori":
        return fit_yoshida_uemori(pairs, young, poisson, function, largest_step, modulus)
    return fit_chaboche(pairs, int(kind[-1]), young, poisson, function, largest_step, modulus)

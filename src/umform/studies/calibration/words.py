"""Constants of a calibration with their uncertainties, and those that the measurements do not determine."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from umform.sheet_metals import Fit
from umform.studies.calibration.calibrate import Calibration

#: Pairs of constants that are named.
_PAIRS = 3
HEADER = ("fit", "constant", "value", "standard error", "determined")


def rows(found: Calibration) -> Iterator[tuple[str, str, str, str, str]]:
    """Rows of the table of constants."""
    for name, fit in found.fits.items():
        for constant, value in fit.constants.items():
            deviation = fit.deviations[constant]
            error = "-" if math.isinf(deviation) else f"{deviation:.2g}"
            yield name, constant, f"{value:.6g}", error, "no" if constant in fit.undetermined else "yes"


def remarks(found: Calibration) -> Iterator[str]:
    """Sentences: how good each fit is, and what is not determined."""
    units = {"yield function": "in units of 1 % of a stress and 5 % of an r-value"}
    units["modulus"] = "in units of 1 % of Young's modulus"
    for name, fit in found.fits.items():
        unit = units.get(name, "in units of 1 % of the largest stress")
        yield f"{name}: misfit {fit.misfit:.3g} {unit}"
        yield from vague(name, fit)
    if len(found.others) > 1:
        tried = ", ".join(f"{name} {misfit:.3g}" for name, misfit in found.others.items())
        yield f"hardening: misfits of the curves that were tried: {tried}"


def vague(name: str, fit: Fit[Any]) -> Iterator[str]:
    """Sentences: constants, and combinations of them, that measurements do not determine."""
    if fit.undetermined:
        yield (
            f"{name}: the measurements do not determine {', '.join(fit.undetermined)}: the standard error is more "
            "than half of the number, or it ended at a bound"
        )
    tied = sorted(fit.tied, key=lambda pair: -abs(pair[2]))
    for first, second, correlation in tied[:_PAIRS]:
        alone = fit.undetermined and {first, second} & set(fit.undetermined)
        what = "only a combination of {} and {} is determined" if alone else "{} and {} are hardly told apart"
        yield f"{name}: {what.format(first, second)} (correlation {correlation:.3f})"
    if len(tied) > _PAIRS:
        yield (
            f"{name}: the same holds for {len(tied) - _PAIRS} more pairs: other constants give the same function "
            "at the measured points"
        )

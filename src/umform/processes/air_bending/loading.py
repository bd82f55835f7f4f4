"""The press brake: the loading and unloading steps, forces and contact on flanks."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.analysis.newton.options import NewtonOptions
from umform.analysis.steps.release import Release
from umform.model.contact import ContactPoints
from umform.model.terms.control import Control
from umform.processes.air_bending.spec import AirBending

#: Near zero force the sheet rests on single rows of contact points, and plain Newton jumps between two rows. Tight
#: tolerances give angles to 1e-6 degrees. The quadratic predictor saves a fourth of the evaluations.
OPTIONS = NewtonOptions(residual=1e-6, increment=1e-4, line_search=True, extrapolate=2)
#: Increments of one step of the loading.
INCREMENTS = 5
#: Increments of the pressing of bottoming, where most of the work is done, for one of the bend in the air; where it
#: begins, in thicknesses before the bottom.
_FINER, _PRESSED = 4, 0.5
#: Force that counts as zero, relative to the force before unloading: an error of the angle of about 0.002 degrees; and
#: where the sheet was pressed with many times the force of a bend.
_ZERO_FORCE, _ZERO_PRESSED = 2e-3, 2e-5
#: First increment of unloading in thicknesses.
_FIRST_BACK = 0.02


def loading(case: AirBending, stroke: float) -> list[tuple[float, int]]:
    """Strokes at the ends of the loading steps, and the increments of each: steps of equal increments, then the rest.

    The steps are the same for all strokes, so that a search and a table follow the path of a single bend.
    """
    part = INCREMENTS * case.way
    whole = max(0, math.ceil(stroke / part - 1e-9) - 1)
    ends = [(part_end(case, number), INCREMENTS) for number in range(1, whole + 1)]
    steps = [*ends, (stroke, increments(case, stroke - whole * part))]
    return [(end, _FINER * count if _presses(case, end) else count) for end, count in steps]


def _presses(case: AirBending, stroke: float) -> bool:
    """Whether the sheet is pressed onto the flanks at a stroke, or nearly."""
    return case.bottoming and stroke > case.bottom_stroke - _PRESSED * case.thickness


def part_end(case: AirBending, number: int) -> float:
    """Stroke at the end of a loading step, counted from 1."""
    return number * (INCREMENTS * case.way)


def increments(case: AirBending, way: float) -> int:
    """Number of increments for a travel of the punch."""
    return max(1, math.ceil(way / case.way - 1e-9))


def unloading(case: AirBending, punch: Control) -> Release:
    """Step that takes the punch back until its force is zero."""
    return Release(punch, **unloading_keys(case))


def unloading_keys(case: AirBending, tolerance: float | None = None) -> dict[str, Any]:
    """First increment and tolerance of unloading."""
    usual = _ZERO_PRESSED if case.bottoming else _ZERO_FORCE
    return {"increment": _FIRST_BACK * case.thickest, "tolerance": tolerance or usual}


def force_per_width(case: AirBending, force: NDArray[np.float64]) -> NDArray[np.float64]:
    """Force per length of bend on the whole sheet, from the force on the modelled part."""
    modelled = case.thickest if case.width is None else 0.5 * case.width
    return 2.0 / modelled * force


def against_flank(case: AirBending, contacts: Mapping[str, ContactPoints]) -> str:
    """Tool, "die" or "punch", whose flank the sheet touches, a quarter of a thickness beyond the radius."""
    beyond = 0.25 * case.thickest
    die, punch = (0.5 * math.radians(180.0 - angle) for angle in (case.die_angle, case.punch_angle))
    x_die = np.abs(contacts["die"].x[contacts["die"].gap <= 0.0, 0])
    if (x_die < case.shoulder - case.die_radius * math.sin(die) - beyond * math.cos(die)).any():
        return "die"
    x_punch = np.abs(contacts["punch"].x[contacts["punch"].gap <= 0.0, 0])
    return "punch" if (x_punch > case.punch_radius * math.sin(punch) + beyond * math.cos(punch)).any() else ""

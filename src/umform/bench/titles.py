"""A few words on the work of a form, for lists of jobs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from umform.bench.form import DRAWS, SECOND
from umform.processes.air_bending.goal import Goal

#: Most letters of the title of a bend table.
_LONGEST_TITLE = 120


def title_of(values: Mapping[str, Any], goal: Goal) -> str:
    """The title of a job.

    Parameters
    ----------
    values : mapping of str to object
        Values of the form.
    goal : Goal
        What is wanted of a bend.
    """
    work = values["work"]
    if work == "flat":
        return f"{values['part']}, {values['material']}"
    if work == "table":
        sheets = f"{', '.join(values['metals'])}, {_listed(values['thicknesses'])} mm"
        return f"{sheets}, V{_listed(values['openings'])}, {_listed(values['angles'])}°"[:_LONGEST_TITLE]
    if work in DRAWS:
        size = f"cup of {values['cup_punch']:g} mm" if work == "cup" else f"U of {values['u_punch_width']:g} mm"
        return f"{values['material']} {values[f'{work}_thickness']:g} mm, {size}"
    sheets = f"{values['material']} {values['thickness']:g} mm"
    if values.get(f"{SECOND}material"):
        sheets += f" + {values[f'{SECOND}material']} {values[f'{SECOND}thickness']:g} mm"
    return f"{sheets}, {_bent(values, goal)}"


def _bent(values: Mapping[str, Any], goal: Goal) -> str:
    """The part and its bends."""
    work, die = values["work"], f"V{values['opening']:.4g}"
    if work == "outside":
        return f"outside {_listed(values['outside']['flanges'])} mm"
    if work == "sequence":
        return " ".join(f"{row['angle']:g}°" for row in values["bends"] if "angle" in row)
    if work == "hem":
        return f"{values['form']} hem"
    if work == "correct":
        return f"{die}, measured {values['measured_angle']:g}°"
    if work == "bottom":
        return (
            f"{die}, {goal.force_per_metre:g} kN/m"
            if goal.force_per_metre is not None
            else f"{die}, {goal.travel:+g} mm"
        )
    return f"{die}, {goal.angle:g}°" if goal.angle is not None else f"{die}, {values['stroke']:g} mm"


def _listed(values: list[float]) -> str:
    return " ".join(f"{value:.4g}" for value in values)

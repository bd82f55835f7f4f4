"""Numbers that any run has, for the first screen of its report."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from umform.model.tools.tool_controls import ToolTurn
from umform.report.looks import Units, look_of
from umform.report.symmetry import modelled_part
from umform.report.words import column_text
from umform.results.leading_controls import leading_controls
from umform.results.quantity import Quantity

if TYPE_CHECKING:
    from umform.results.history import History

#: Fields whose largest value at the end is shown.
_FIELDS = ("thickness_change", "plastic_strain_max", "stress_von_mises")


def key_numbers(result: History, units: Units) -> list[Quantity]:
    """Numbers that any run has: the largest force of the leading control, and extremes of the fields at the end."""
    found = []
    for control in leading_controls(result)[:1]:
        force, of = result[f"{control.name}_force"], modelled_part(result.model)
        at = int(np.abs(force).argmax())
        turns, name = isinstance(control, ToolTurn), column_text(control.name)
        label, unit = (f"largest {name} moment", units.moment) if turns else (f"largest {name} force", units.force)
        hint = of and "of the computed part, by symmetry"
        found.append(Quantity(label, unit, value=abs(float(force[at])), hint=hint))
        unit = "rad" if turns else units.length
        found.append(Quantity(f"{name} at the end", unit, value=float(result[control.name][-1])))
    last = result.frames[-1] if result.frames else None
    fields = {} if last is None else {**last.points, **last.cells}
    for name in _FIELDS:
        if name in fields and np.isfinite(fields[name]).all():
            look = look_of(name)
            words = look.words if look.words.startswith("largest") else f"largest {look.words}"
            found.append(Quantity(words, look.unit_in(units), value=float((look.factor * fields[name]).max())))
    return [replace(one, of_mesh=True) for one in found]

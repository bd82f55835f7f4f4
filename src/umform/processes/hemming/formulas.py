"""An estimate of the force that flattens a hem, before it is computed."""

from __future__ import annotations

from umform.processes.air_bending.formulas import strength
from umform.processes.air_bending.spec import AirBending

#: Factors of Rm t²/(t + gap): over an insert, which is clamped at the end, and open. Those of the table of hems in
#: docs/bending-operations.md are 1.6 to 2 and 0.5; a stainless steel has 2.3.
_OVER_INSERT, _OPEN = (1.5, 2.5), (0.4, 0.8)


def flattening_forces(sheet: AirBending, gap: float, *, insert: bool) -> tuple[float, float]:
    """Range of the largest force of flattening in N/mm: the loop is a plastic hinge with an arm of (t + gap)/2."""
    base = strength(sheet) * sheet.thickness**2 / (sheet.thickness + gap)
    low, high = _OVER_INSERT if insert else _OPEN
    return low * base, high * base

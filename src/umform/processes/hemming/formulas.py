"""An estimate of the force that flattens a hem, before it is computed."""

from __future__ import annotations

from umform.processes.air_bending.formulas import strength
from umform.processes.air_bending.spec import AirBending
from umform.processes.hemming.spec import GAPS

#: Factors of Rm t²/(t + gap) by the form. A plate that stops at its height meets metal without clearance at the end:
#: the force depends on the last 0.01 mm (docs/bending-operations.md).
_FACTORS = {"flat": (1.0, 2.5), "inner": (1.0, 2.5), "insert": (1.5, 2.5), "open": (0.4, 1.5), "rope": (0.1, 1.0)}


def flattening_forces(sheet: AirBending, form: str, gap: float | None, force: float | None) -> tuple[float, float]:
    """Range of the largest force of flattening in kN/m: the loop is a plastic hinge with an arm of (t + gap)/2.

    Parameters
    ----------
    sheet : AirBending
        Sheet and metal.
    form : str
        Form of the hem.
    gap, force : float or None
        Its gap, by default that of the form; the force of the plate, if it is given.
    """
    if force is not None:
        return force, force
    filled = GAPS[form] * sheet.thickness if gap is None else gap
    base = strength(sheet) * sheet.thickness**2 / (sheet.thickness + filled)
    low, high = _FACTORS[form]
    return low * base, high * base

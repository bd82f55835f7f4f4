"""Check the r-values that a yield function gives: a bar that grows wider as it is pulled has a wrong sign or order."""

from __future__ import annotations

from collections.abc import Iterator

from umform.materials import Metal
from umform.model import Model
from umform.problem.findings import Finding, error, ok
from umform.sheet_metals import uniaxial

#: Degrees to the rolling direction.
_ANGLES = range(0, 91, 15)


def r_values(model: Model) -> Iterator[Finding]:
    """Lowest and highest r-value over the angle to the rolling direction, of a metal with directions.

    Parameters
    ----------
    model : Model
        The model, which is unchanged.
    """
    for body in model.bodies:
        if isinstance(body.material, Metal) and body.material.yield_function.directional:
            yield _of_metal(body.material)


def _of_metal(material: Metal) -> Finding:
    values = {angle: float(uniaxial(material.yield_function, angle)[1]) for angle in _ANGLES}
    least = min(values, key=values.__getitem__)
    if values[least] >= 0.0:
        return ok("material", f"r-values from {values[least]:.3g} to {max(values.values()):.3g}")
    text = f"the r-value at {least} degrees to the rolling direction is {values[least]:.3g}: a pulled bar grows wider"
    return error("material", text, "check signs and order of the constants of the yield function")

"""Mesh of half of the sheet: fine in the bend and where the shoulder touches, coarse elsewhere."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from umform import mesh
from umform.mesh.mesh import Floats
from umform.processes.air_bending.spec import AirBending

#: How fast elements grow outside of the fine zones: by this part of the way.
_GROWTH = 0.3


def lines_of(case: AirBending) -> tuple[Floats, Floats, Floats]:
    """Element borders of half of the sheet on the die: x from the middle of the bend, z from 0 to the thickness.

    With a width, y goes from the middle of the sheet to its edge; in plane strain over one element.
    """
    if case.width is None:
        across: Floats = np.array([0.0, case.thickness])
    else:  # finer towards the edge, where the sheet curls
        across = mesh.graded(0.5 * case.width, case.width_elements, 0.5)
    return lines_along(case), across, mesh.graded(case.thickness, case.layers)


def lines_along(case: AirBending) -> Floats:
    """Element borders along the sheet, from the middle to the end."""
    fine = max(case.thickness, case.opening / 16.0) / case.elements_per_thickness
    coarse = max(case.thickness, case.opening / 8.0)
    margin = 0.5 * case.thickness
    zones = [(0.0, max(0.25 * case.opening, 2.0 * case.thickness)), (case.shoulder - margin, case.reach + margin)]
    return _march(case.half_length, fine, coarse, zones)


def _march(length: float, fine: float, coarse: float, zones: Sequence[tuple[float, float]]) -> Floats:
    """Lines from 0 to a length: fine in the zones, growing with the distance to them, nowhere above coarse."""
    lines = [0.0]
    while lines[-1] < length - 1e-9 * length:
        x = lines[-1]
        away = min(max(first - x, x - last, 0.0) for first, last in zones)
        lines.append(x + min(fine + _GROWTH * away, max(coarse, fine)))
    return np.array(lines) * (length / lines[-1])

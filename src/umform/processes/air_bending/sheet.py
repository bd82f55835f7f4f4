"""Mesh of half of the sheet: fine in the bend and where the shoulder touches, coarse elsewhere."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from umform import mesh
from umform.elements import element
from umform.mesh.mesh import Floats
from umform.processes.air_bending.spec import AirBending
from umform.processes.air_bending.stack import bonded_sheets
from umform.results.studies import StudiedMesh

if TYPE_CHECKING:
    from umform.materials import J2, Metal

#: How fast elements grow outside of the fine zones: by this part of the way.
_GROWTH = 0.3
#: Size of the elements of the coarse mesh of the studies of errors over that of the default.
_COARSE = 2.0
#: Longest fine elements over the thickness of a bonded sheet. Elements ten times as long as a foil of 0.1 mm is thick
#: turn inside out below 3 mm of DC04; those 3.3 and 5 times as long leave 0.72 of it.
_SLENDER = 6.0
#: Slope of the yield stress over the stress below which the studies have no bends.
_LEAST_SLOPE = 0.01


def lines_of(case: AirBending) -> tuple[Floats, Floats, Floats]:
    """Element borders of half of the first sheet: x from the middle of the bend, z from 0 to the thickness.

    With a width, y goes from the middle of the sheet to its edge; in plane strain over one element.
    """
    if case.width is None:
        across: Floats = np.array([0.0, case.thickest])
    else:  # finer towards the edge, where the sheet curls
        across = mesh.graded(0.5 * case.width, case.width_elements, 0.5)
    return lines_along(case), across, lines_through(case, 0)


def lines_through(case: AirBending, number: int) -> Floats:
    """Element borders through a sheet, counted from the die from 0; bonded ones share the layers."""
    thickness = case.sheets[number].thickness
    whole = next(sheets for sheets in bonded_sheets(case) if number in sheets)
    share = thickness / sum(case.sheets[one].thickness for one in whole)
    return mesh.graded(thickness, math.ceil(case.layers * share - 1e-9))


def lines_along(case: AirBending) -> Floats:
    """Element borders along the sheet, from the middle to the end."""
    fine = max(case.thickest, case.opening / 16.0) / case.elements_per_thickness
    thin = [case.sheets[number].thickness for sheets in bonded_sheets(case) if len(sheets) > 1 for number in sheets]
    fine = min(fine, *(_SLENDER * thickness for thickness in thin)) if thin else fine
    coarse = max(case.thickest, case.opening / 8.0)
    margin = 0.5 * case.height
    zones = [(0.0, max(0.25 * case.opening, 2.0 * case.height)), (case.shoulder - margin, case.reach + margin)]
    return _march(case.half_length, fine, coarse, zones)


def _march(length: float, fine: float, coarse: float, zones: Sequence[tuple[float, float]]) -> Floats:
    """Lines from 0 to a length: fine in the zones, growing with the distance to them, nowhere above coarse."""
    lines = [0.0]
    while lines[-1] < length - 1e-9 * length:
        x = lines[-1]
        away = min(max(first - x, x - last, 0.0) for first, last in zones)
        lines.append(x + min(fine + _GROWTH * away, max(coarse, fine)))
    return np.array(lines) * (length / lines[-1])


def studied_mesh(
    case: AirBending, strain: float | None = None, process: str = "air bending", like: AirBending | None = None
) -> StudiedMesh | None:
    """Mesh of a bend beside those of the studies of errors, by the elements along the sheet.

    None for fewer layers than those of the studies, and for elements with another number of nodes.

    Parameters
    ----------
    case : AirBending
        The parameters of the sheet.
    strain : float, optional
        Largest logarithmic strain of the outer face; None for numbers that belong to no bend.
    process : str
        Process of the studies.
    like : AirBending, optional
        Their default mesh.
    """
    like = like or AirBending()
    if element(case.element).cell != element(like.element).cell or case.layers < like.layers:
        return None
    soft = 1.0 if strain is None else softness(case.material, strain)
    return StudiedMesh.nearest(process, like.elements_per_thickness / case.elements_per_thickness, _COARSE, soft)


def softness(material: J2 | Metal, strain: float) -> float:
    """Yield stress over its slope at a strain: where little hardening is left, a bend is sharper than its mesh.

    The errors of the studies follow a power of it (docs/bands.md); sharpness, the thickness over the inside radius,
    does not tell large errors from small ones.
    """
    stress, slope = material.hardening.curve()(max(strain, 0.0))
    return stress / max(slope, _LEAST_SLOPE * stress)

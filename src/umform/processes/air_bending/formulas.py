"""Workshop formulas for comparison, and the material data that they need."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from umform.materials import J2, Metal, Table
from umform.processes.air_bending.spec import AirBending
from umform.processes.air_bending.stack import bonded_sheets
from umform.sheet_metals import tension_test
from umform.sheet_metals.tensile_test import necking_strain

#: Factors in use for F = factor Rm t² / V.
FORCE_FACTORS = (1.33, 1.42)
#: The rule for people.
RULE = "rule of the shop, {:g} to {:g} Rm t²/V".format(*FORCE_FACTORS)
#: Inside radius over the opening that the shop reckons with, for steel.
INNER_RADIUS = 0.16


@lru_cache(maxsize=256)
def tensile_strength(material: J2 | Metal, angle: float = 0.0) -> float:
    """Tensile strength Rm: for J2 the maximum of y(e) exp(-e), y the true yield stress (Considère); else from a bar.

    For J2, elastic strains are neglected. ``angle``: degrees from the rolling direction to the bar.
    """
    if isinstance(material, Metal):
        return tension_test(material, angle).tensile_strength
    strain = necking_strain(material.hardening)
    return material.hardening.curve()(strain)[0] * math.exp(-strain)


def uniform_strain(material: J2 | Metal, angle: float = 0.0) -> float:
    """Plastic strain up to which a tensile test determines the flow curve: at the largest force, or the end of a table.

    ``angle``: degrees from the rolling direction to the bar.
    """
    if isinstance(material.hardening, Table):
        return float(material.hardening.eqps[-1])
    if isinstance(material, Metal):
        test = tension_test(material, angle)
        return float(np.log1p(test.uniform_elongation))
    return necking_strain(material.hardening)


def strength(case: AirBending, material: J2 | Metal | None = None) -> float:
    """Tensile strength of a bar across the bend line, of the first sheet or of another metal."""
    return tensile_strength(material or case.material, 0.0 if case.rolling is None else 90.0 - case.rolling)


def shop_forces(case: AirBending) -> tuple[float, float]:
    """Largest force of air bending by the rule of the shop, F = factor Rm t² / V, in kN/m, V the opening.

    That of several sheets is the sum, without friction between them. Those that are bonded have the plastic moment of
    their section in place of Rm t² / 4.
    """
    layers = [(strength(case, sheet.material), sheet.thickness) for sheet in case.sheets]
    base = sum(_bending([layers[number] for number in sheets]) for sheets in bonded_sheets(case)) / case.opening
    return FORCE_FACTORS[0] * base, FORCE_FACTORS[1] * base


def _bending(layers: Sequence[tuple[float, float]]) -> float:
    """Four plastic moments of bonded layers (strength, thickness); of a single one Rm t²."""
    strengths, borders = np.array([one for one, _ in layers]), np.cumsum([0.0, *(thick for _, thick in layers)])
    pulled = np.cumsum([0.0, *(strengths * np.diff(borders))])
    from_neutral = borders - np.interp(0.5 * pulled[-1], pulled, borders)
    return float(2.0 * strengths @ np.diff(from_neutral * np.abs(from_neutral)))

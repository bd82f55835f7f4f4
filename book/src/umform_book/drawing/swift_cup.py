"""Cups whose answer is known: four-fold symmetry without directions, and Yld2004 of exponent 2 beside Hill48."""

from __future__ import annotations

import numpy as np

from umform.materials import Hill48, Metal
from umform.sheet_metals import balanced, uniaxial
from umform_book.case import Case
from umform_book.drawing.cups import COLUMNS, aa6016, esaform, isotropic, make
from umform_book.drawing.rim import SYMMETRIC
from umform_book.page import Page


def hill_of(metal: Metal) -> Metal:
    """The function of Hill that equals a quadratic Yld2004 whose shears across the sheet are 1: same yield stresses."""
    given = metal.yield_function
    s0, s45, s90 = (uniaxial(given, angle)[0] for angle in (0.0, 45.0, 90.0))
    function = Hill48.from_stresses(s0, s45, s90, balanced(given)[0])
    return Metal(70e3, 0.33, hardening=metal.hardening, yield_function=function)


def run(page: Page) -> None:
    """Fill the page."""
    coarse: dict[str, object] = {"turn": 30.0, "around": 8, "penalty": 1e4, "contact_points": 2}
    if page.short:
        coarse = {"turn": 45.0, "around": 6, "penalty": 3e3, "contact_points": 2, "stroke": 5.0}
    quadratic = aa6016(exponent=2)
    cases = {
        "without directions": esaform(isotropic(), **coarse),
        "Yld2004 of exponent 2": esaform(quadratic, **coarse),
        "Hill48 of the same stresses": esaform(hill_of(quadratic), **coarse),
    }
    made = {label: make(page, label, cases[label]) for label in page.each(list(cases), str)}
    found = {label: cup for label, cup in made.items() if cup is not None}
    page.table("Heights in mm", COLUMNS, [(label, *cup.row()) for label, cup in found.items()])
    height = found["without directions"].ears.height
    page.at_most("without directions: largest difference of heights at theta and 90 degrees - theta, mm",
                 float(np.abs(height - height[::-1]).max()), SYMMETRIC)  # fmt: skip
    both = [found[label].ears.height for label in list(cases)[1:]]
    page.at_most(
        "Yld2004 of exponent 2 minus Hill48: largest difference of heights, mm",
        float(np.abs(both[0] - both[1]).max()),
        0.01,
    )


CASE = Case(
    name="drawing-swift-cup",
    title="Cups with known answers: symmetry, and a quadratic Yld2004 beside Hill48",
    problem="""
The cup of the [page on AA6016-T4](drawing-aa6016-cup.md) on a coarse mesh (30 degrees over an edge, penalty 1e4), drawn
and released with three metals: an isotropic one, whose cup is the same at theta and 90 degrees - theta; the card of
NTNU of Yld2004 with the exponent 2; and the function of Hill that equals it.
""",
    reference="""
Symmetry: the mesh is symmetric about 45 degrees, and so is the cup, except for the staggered heights of the thickness
points. Quadratic Yld2004: a quadratic function of the deviator that is symmetric about the axes of the sheet is that of
Hill (1948); its constants follow from the yield stresses at 0, 45 and 90 degrees and in balanced tension.
""",
    run=run,
    cost=40.0,
)

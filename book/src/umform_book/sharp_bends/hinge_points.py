"""Thickness rules and numbers of points in sharp bends: the moment of a section, and the hinge over a cylinder."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from umform.elements import thickness_rule
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.page import Page
from umform_book.sharp_bends.candidates import BEND8, BEND18, Candidate, of_order
from umform_book.sharp_bends.section import BentSection, ThicknessStrain
from umform_book.sharp_bends.small_cylinders import fold
from umform_book.sharp_bends.strips import bend

Floats = NDArray[np.float64]

STRAINS = tuple(float(x) for x in np.linspace(0.02, 0.3, 29))
#: rule -> numbers of points
POINTS = {"gauss": (5, 6, 7, 8, 9, 11, 13, 15), "lobatto": (5, 6, 7, 8, 9, 11, 13, 15), "split": (6, 8, 10, 12, 14)}
ALL = tuple((rule, n) for rule, numbers in POINTS.items() for n in numbers)
SHORT = (("gauss", 8), ("split", 8), ("split", 12))
#: The selection where all combinations would take too long.
FEW = (("gauss", 5), ("gauss", 8), ("gauss", 15), ("lobatto", 5), ("lobatto", 8), ("split", 8), ("split", 12))
#: The rule that errs least in a section, which the others are compared with in the hinge.
FINEST = ("split", 14)
RECOMMENDED = ("split", 12)
ORDER_4 = ThicknessStrain("order 4", 4)

Rule = tuple[str, int]


def _sections(page: Page) -> None:
    page.heading("Moment of a section, perfect plasticity")
    fine = BentSection(ORDER_4).moments(STRAINS)
    found: dict[Rule, Floats] = {}
    rows: list[tuple[str | float, ...]] = []
    for rule, n in page.each(page.pick(ALL, SHORT), lambda r: f"section, {r[1]} {r[0]}"):
        error = 100.0 * (BentSection(ORDER_4, rule=thickness_rule(n, rule)).moments(STRAINS) / fine - 1.0)
        found[rule, n] = error
        rows.append((f"{n} {rule}", *(float(np.interp(x, STRAINS, error)) for x in (0.02, 0.1, 0.2, 0.3)), _far(error)))
    columns = ("points", *(f"strain {x:g}" for x in (0.02, 0.1, 0.2, 0.3)), "worst of 29 strains")
    page.table("Error of the moment in % of that with 60 points, order 4", columns, rows)
    worst = abs(_far(found[RECOMMENDED])) / 100.0
    page.at_most("section, 12 split points: worst error of the moment, strains 0.02 to 0.3", worst, 0.02)
    if not page.short:
        others = min(abs(_far(error)) for rule, error in found.items() if rule != FINEST) / 100.0
        more = max(0.0, abs(_far(found[FINEST])) / 100.0 - others)
        page.at_most("section, 14 split points: worst error more than the least of all other rules", more, 0.0)
    if page.images is not None and not page.short:
        shown = [("gauss", 5), ("gauss", 8), ("gauss", 15), ("lobatto", 9), ("split", 8), ("split", 12)]
        curves = [Curve(f"{n} {rule}", STRAINS, found[rule, n]) for rule, n in shown]
        figure = plot(curves, "surface strain k h / 2", "error of the moment, %", level=0.0)
        page.figure("section", figure, "Perfect plasticity: error of the moment by rule and number of points")


def _far(errors: Sequence[float] | Floats) -> float:
    return float(max(errors, key=abs))


def _hinge(page: Page, base: Candidate, length: float, radius: float, rules: Sequence[Rule]) -> None:
    """Rules in the hinge over a cylinder, against the finest rule in the same mesh."""
    case = fold(radius)
    chosen = [FINEST, *(rule for rule in rules if rule != FINEST)]
    found = {
        (rule, n): bend(page, case.strip, replace(base, label=label, points=n, rule=rule), case.cells(length))
        for rule, n, label in page.each(
            [(rule, n, f"{base.label}, {n} {rule}") for rule, n in chosen], lambda r: f"R = {radius:g}, {r[2]}"
        )
    }
    reference = found[FINEST]
    rows: list[tuple[str | float, ...]] = []
    errors: dict[Rule, float] = {}
    for (rule, n), b in found.items():
        errors[rule, n] = _far([100.0 * (b.at(u) / reference.at(u) - 1.0) for u in case.marks])
        rows.append((f"{n} {rule}", *(b.at(u) for u in case.marks), errors[rule, n], b.radius))
    columns = ("points", *(f"F({u:g})" for u in case.marks), "worst, % of 14 split", "least R/h at the end")
    page.table(f"{base.label} of length {length:g} h over a cylinder of radius {radius:g} h, force in N", columns, rows)
    worst = abs(errors[RECOMMENDED]) / 100.0
    what = f"{base.label}, cylinder of radius {radius:g} h: 12 against 14 split points, worst force"
    page.at_most(what, worst, 0.01)
    if rules is ALL and page.images is not None:
        curves = [
            Curve(rule, numbers, [max(abs(errors[rule, n]), 1e-3) for n in numbers], "o-")
            for rule, numbers in POINTS.items()
        ]
        figure = plot(curves, "thickness points", "worst error of the force, %", log="y", level=1.0)
        page.figure(f"hinge-{radius:g}", figure, f"BEND8 over the cylinder of radius {radius:g} h")


def run(page: Page) -> None:
    """Fill the page."""
    _sections(page)
    page.heading("The hinge over a cylinder, H = 500 MPa")
    _hinge(page, BEND8, 0.5, 1.0, page.pick(ALL, SHORT[1:]))
    if page.short:
        return
    _hinge(page, BEND8, 0.5, 5.0, FEW)
    _hinge(page, of_order("ANS3DEAS", 2), 0.5, 1.0, FEW)
    _hinge(page, BEND18, 1.0, 1.0, FEW)
    page.text(
        "In a sharp bend the neutral line leaves the mid-surface and passes from point to point, and the error of each "
        "rule changes its sign. Hardening, and a hinge with sections at different strains, average most of it."
    )


CASE = Case(
    name="bend-thickness-points",
    title="Thickness rules and points in sharp bends",
    problem="""
* (a) The section of the [candidates](bend-candidates.md) with order 4, perfect plasticity, surface strains 0.02 to 0.3:
  Gauss, Lobatto, split (half of the Gauss points on each side of the mid-surface).
* (b) The strip over a [small cylinder](bend-small-cylinders.md) of radius h and 5 h, H = 500 MPa, same rules. Order p
  needs at least p + 1 points.

![The hinge, from the page of the hinge](images/bend-hinge-shape.png)
""",
    reference="""
(a) The same section with 60 points. (b) The same mesh with 14 split points, the best rule of (a), so that only the rule
differs. Uncertainty of (b): the error of 14 points in (a).
""",
    own="for (b), 14 split points on the same mesh, umform itself; (a) is a section integrated in numpy",
    run=run,
    cost=35.0,
)

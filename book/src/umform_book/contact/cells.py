"""Contact over cells: where the resultant is, Hertz, and the ripple of the force of a bent strip."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform import mesh
from umform.analysis.steps import Move
from umform.materials import J2, SVK, Perfect
from umform.mesh import Mesh
from umform.model import Model
from umform.surfaces import Cylinder
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.contact.hertz import pressed_to
from umform_book.contact.hertz_line import EXPECTED, LINE
from umform_book.page import Page
from umform_book.variants import Variant

Floats = NDArray[np.float64]

EIGHT, EIGHTEEN = Variant("ANS3DEAS"), Variant("MI9K3DEAS")
RULES: dict[str, dict[str, Any]] = {
    "5 x 5 points": {"points": 5},
    "10 x 10 points": {"points": 10},
    "3 x 3 cells": {"cells": 3},
    "cells, auto": {"cells": "auto"},
}
#: Strip and tool of the bending; length of the strip on the way that is measured.
LENGTH, RADIUS, STROKE = 60.0, 20.0, 15.0
#: Near the one that umform chooses, which would grow by another factor with each rule.
PENALTY = 7700.0
COARSE = "faces as long as a quarter of the radius: the mesh itself is 75 % off, and edges carry the sheet"


# A rigid sheet -----------------------------------------------------------------------------------------------


def flat(shape: str) -> Mesh:
    """A flat sheet of 20 x 6 whose faces have a length of about 2.5."""
    sheet = mesh.strip(20.0, 6.0, 1.0, (8, 3)).moved((0.0, 0.0, 0.5))
    x, y = sheet.points[:, 0].copy(), sheet.points[:, 1].copy()
    if shape == "graded":
        sheet.points[:, 0] = 20.0 * (1.25 ** (x / 2.5) - 1.0) / (1.25**8 - 1.0)
    if shape == "distorted":
        inside = np.sin(np.pi * x / 20.0)
        sheet.points[:, 0] += inside * (0.8 * np.sin(2.1 * x) + 0.6 * np.sin(0.6 * y + 0.9 * x))
        sheet.points[:, 1] += 0.02 * y * (6.0 - y) * np.sin(1.3 * x)
    return sheet


def misplaced(shape: str, half: float, rule: dict[str, Any]) -> float:
    """Largest distance of the resultant from the axis of a cylinder that is moved along, over the half-width."""
    worst = 0.0
    for x in np.linspace(8.0, 11.0, 13):
        model = Model(flat(shape), "ANS3DEAS", material=SVK(E=1.0, nu=0.0))
        tool = Cylinder((x, 0.0, half**2 / (2.0 * RADIUS) - RADIUS), "y", RADIUS)
        contact = model.contact("lower", tool, penalty=1.0, **rule)
        found = contact.locate(np.zeros(model.mesh.points.size), contact.pose)
        force, moment = found.resultant()
        worst = max(worst, abs(moment[1] / force[2] + x) / half if force[2] else 1.0)
    return worst


def by_place(page: Page) -> None:
    """Resultant of a cylinder in a flat sheet, on three meshes."""
    rows: list[tuple[str | float, ...]] = []
    rules = {name: RULES[name] for name in ("5 x 5 points", "3 x 3 cells")} | {"5 x 5 cells": {"cells": 5}}
    for shape in page.pick(("regular", "graded", "distorted"), ("graded", "distorted")):
        for half in (2.0, 0.8):
            found = {name: misplaced(shape, half, rule) for name, rule in rules.items()}
            rows.append((shape, half, *found.values()))
            page.at_most(f"{shape}, half-width {half:g}: place over 3 x 3 cells", found["3 x 3 cells"], 0.01)
    page.table(
        "Distance of the resultant from the axis over the half-width of the contact",
        ("mesh", "half-width", *rules),
        rows,
    )


# Hertz -------------------------------------------------------------------------------------------------------


def by_hertz(page: Page) -> None:
    """Peak pressure and half-width over the meshes."""
    meshes = page.pick((2, 4, 8), (4,))
    rows: list[tuple[str | float, ...]] = []
    for variant, cells in ((EIGHT, 3), (EIGHTEEN, 5)):
        for divisions in meshes:
            found = pressed_to(page, LINE, variant, divisions, cells, over_cells=True)
            rows.append((f"{variant.label}, {cells} x {cells} cells", divisions, found.peak_nodes, found.spread))
            within = EXPECTED[variant.cells(divisions)]
            if within <= 0.05:
                what = f"{variant.label}, {variant.cells(divisions)} elements over the half-width"
                page.check(f"{what}: peak pressure", found.peak_nodes, 1.0, within)
                page.check(f"{what}: half-width by the second moment", found.spread, 1.0, within)
    columns = ("element, rule", "intervals over the half-width", "peak at nodes over Hertz", "half-width over Hertz")
    page.table("Cylinder on a block, over Hertz", columns, rows)


# Bending -----------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Bent:
    """Displacement and force of a bent strip, and the expected ripple of cells."""

    way: Floats
    force: Floats
    expected: float | None

    def apart(self, reference: Bent) -> tuple[float, float]:
        """Root mean square of the difference of the forces over the force, and without a cubic part of it."""
        difference = np.interp(reference.way, self.way, self.force) - reference.force
        smooth = np.polynomial.Polynomial.fit(reference.way, difference, 3)(reference.way)
        size = np.sqrt(np.mean(reference.force**2))
        return float(np.sqrt(np.mean(difference**2)) / size), float(np.sqrt(np.mean((difference - smooth) ** 2)) / size)


def bend(page: Page, divisions: int, name: str, rule: dict[str, Any]) -> Bent:
    """Push the middle of a plastic strip down over a cylinder."""
    strip = mesh.strip(LENGTH, 1.0, 1.0, (divisions, 1))
    model = Model(strip, "ANS3DEAS", material=J2(kappa=175000.0, mu=80770.0, hardening=Perfect(160.0)))
    model.symmetry("x0", "x")
    model.fix(np.arange(len(strip.points)), "y")
    punch = model.prescribe("x0_lower", "z", "punch")
    tool = model.contact(
        "lower", Cylinder((25.0, 0.0, -0.5 - RADIUS), "y", RADIUS), name="tool", penalty=PENALTY, **rule
    )
    result = page.solve(f"bending, {divisions} elements, {name}", model, Move(punch, -STROKE, steps=150))
    return Bent(-result["punch"], -result["punch_force"], tool.ripple)


def by_bending(page: Page) -> None:
    """Deviation from the converged curve, and the ripple over the expected one."""
    meshes = page.pick((12, 24, 48), (24,))
    rules = RULES if not page.short else {name: RULES[name] for name in ("10 x 10 points", "cells, auto")}
    converged = bend(page, page.pick((96,), (48,))[0], "10 x 10 points", {"points": 10})
    rows: list[tuple[str | float, ...]] = []
    curves = []
    for divisions in meshes:
        found = {name: bend(page, divisions, name, rule) for name, rule in rules.items()}
        many = bend(page, divisions, "20 x 20 cells", {"cells": 20})
        for name, run in found.items():
            deviation, (_, ripple) = run.apart(converged)[0], run.apart(many)
            expected = "" if run.expected is None else 100.0 * run.expected
            rows.append((f"{divisions} elements, {name}", 100.0 * deviation, 100.0 * ripple, expected))
            if run.expected is not None:
                what, coarse = f"{divisions} elements, {name}: ripple over the one expected", divisions == 12
                page.at_most(
                    what, ripple / run.expected, 1.0, known=2.0 if coarse else 0.0, cause=COARSE if coarse else ""
                )
        best = found["10 x 10 points"].apart(converged)[0]
        own = found["cells, auto"].apart(converged)[0]
        page.at_most(f"{divisions} elements: deviation of auto over that of 10 x 10 points", own / best, 1.1)
        if divisions == 24:
            for name in page.pick(("5 x 5 points", "cells, auto"), ("cells, auto",)):
                error = np.interp(many.way, found[name].way, found[name].force) - many.force
                curves.append(Curve(name, many.way, 100.0 * error / many.force.max()))
    page.table(
        "Bending: deviation from 96 elements with 10 x 10 points, ripple against 20 x 20 cells, in % of the force",
        ("", "deviation", "ripple", "expected"),
        rows,
    )
    page.figure("ripple", plot(curves, "way", "difference %"), "24 elements: difference from 20 x 20 cells")


def run(page: Page) -> None:
    """Fill the page."""
    by_place(page)
    by_hertz(page)
    by_bending(page)


CASE = Case(
    name="contact-cells",
    title="Contact over cells",
    problem=f"""
* A cylinder of R = {RADIUS:g} moves along a held flat sheet and penetrates it to a contact half-width of 2 or 0.8;
  faces of about 2.5: regular, graded by 1.25, distorted.
* The cylinder on a block ([Hertz](contact-hertz-line.md)) with 3 x 3 cells on 4-node and 5 x 5 on 9-node faces.
* Half of a strip of {LENGTH:g} x 1 x 1, plane strain, perfectly plastic (kappa = 175000, mu = 80770, yield stress 160),
  is bent over a cylinder of R = {RADIUS:g} at x = 25 by {STROKE:g} in 150 increments; default penetration, 12, 24 and
  48 elements of ANS3DEAS.
""",
    reference="""
First: pressures point to the axis, so the resultant is vertical and passes through it (asymmetry of circle and
parabola: below 1e-4). Second: Hertz, as on its page. Third: the curve of twice as many elements with 10 x 10 Gauss
points, whose ripple is some 0.05 %; and the estimate (4.121), which the ripple must not exceed.
""",
    run=run,
    cost=60.0,
)

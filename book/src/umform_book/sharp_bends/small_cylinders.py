"""Strips folded over cylinders of 1 to 10 thicknesses: orders 1 to 4, 8 and 18 nodes, stacks of 2, 4 and 8."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.page import Page
from umform_book.sharp_bends import calculix
from umform_book.sharp_bends.candidates import BEND8, BEND18, Candidate, of_order, stack
from umform_book.sharp_bends.strips import Bend, Strip, bend

HARDENING = 500.0
#: The strip over cylinders up to five thicknesses, and a longer one over that of ten.
SHORT = Strip("fold", 12.0, 8.0, HARDENING, steps=50)
LONG = Strip("fold", 20.0, 12.0, HARDENING, radius=10.0, steps=40)
RADII = (1.0, 2.0, 5.0, 10.0)
#: Deviation allowed for BEND8 and BEND18 on the meshes that one would take.
WITHIN = 0.03

Key = tuple[str, float]


@dataclass(frozen=True)
class Fold:
    """A strip with its marks: displacements at which forces are given."""

    strip: Strip
    marks: tuple[float, ...]

    def cells(self, length: float) -> int:
        """Elements of a length along the strip."""
        return round(self.strip.length / length)


def fold(radius: float) -> Fold:
    """The strip for a radius."""
    if radius > RADII[2]:
        return Fold(replace(LONG, radius=radius), (2.0, 4.0, 8.0, 10.0, 12.0))
    return Fold(replace(SHORT, radius=radius), (1.0, 2.0, 4.0, 6.0, 8.0))


def _chosen(page: Page, radius: float) -> list[tuple[Candidate, float]]:
    """Candidates over a cylinder with the length of their elements; the reference first."""
    length = 0.25 if radius < RADII[-1] else 0.5
    stacks = [(stack("EAS3DEAS", n, p, k), length) for n, p, k in ((4, 2, 4), (2, 2, 4), (2, 1, 4))]
    eight = [(of_order("ANS3DEAS", p), 0.5) for p in (1, 2, 3)] + [(BEND8, 0.5)]
    eighteen = [(of_order("MI9K3DEAS", p), 1.0) for p in (1, 2, 3)] + [(BEND18, 1.0)]
    if page.short:
        return [stacks[0], eight[0], eight[-1], eighteen[-1]]
    if radius == RADII[0]:
        stacks.insert(1, (stack("EAS3DEAS", 8, 2, 3), length))
    if radius == RADII[2]:
        eight.append((BEND8, 0.25))
    return [*stacks, *eight, (BEND8, 1.0), *eighteen, (BEND18, 2.0)]


def _judge(page: Page, case: Fold, found: dict[Key, Bend], reference: Bend) -> None:
    radius = case.strip.radius
    for label, length in (("BEND8", 0.5), ("BEND18", 1.0)):
        for u in case.marks[1:]:
            what = f"{label}, length {length:g} h, cylinder of radius {radius:g} h: F({u:g})"
            page.check(what, found[label, length].at(u), reference.at(u), WITHIN)
    eight = [b for (label, _), b in found.items() if label.startswith("stack of 8")]
    for b in eight:
        for u in case.marks[1:]:
            what = f"stack of 8 against 4 layers, cylinder of radius {radius:g} h: F({u:g})"
            page.check(what, b.at(u), reference.at(u), 0.02)
    _against_calculix(page, case, found)


def _against_calculix(page: Page, case: Fold, found: dict[Key, Bend]) -> None:
    meshes = [m for m in calculix.STORED if m.over == "fold" and m.radius == case.strip.radius]
    for mesh in meshes:
        u, force, origin = calculix.forces(mesh)
        page.text(f"CalculiX with contact, {mesh.layers} layers of length {mesh.size:g} h ({origin}).")
        for mark in case.marks:
            other = float(np.interp(mark, u, force))
            what = f"BEND8, cylinder of radius {mesh.radius:g} h: F({mark:g}) against CalculiX, {mesh.layers} layers"
            page.check(what, found["BEND8", 0.5].at(mark), other, WITHIN)


def _worst(case: Fold, b: Bend, reference: Bend) -> float:
    """Largest deviation of the force from the stack, in per cent, with its sign."""
    deviations = [100.0 * (b.at(u) / reference.at(u) - 1.0) for u in case.marks]
    return max(deviations, key=abs)


def run(page: Page) -> None:
    """Fill the page."""
    errors: dict[str, dict[float, float]] = {}
    curves: list[Curve] = []
    for radius in page.each(page.pick(RADII, RADII[:1]), lambda r: f"cylinder of radius {r:g} h"):
        case = fold(radius)
        chosen = _chosen(page, radius)
        found = {(c.label, length): bend(page, case.strip, c, case.cells(length), frames=2) for c, length in chosen}
        reference = next(iter(found.values()))
        page.heading(f"Cylinder of radius {radius:g} h")
        rows: list[tuple[str | float, ...]] = []
        for (label, length), b in found.items():
            worst = _worst(case, b, reference)
            rows.append((label, length, *(b.at(u) for u in case.marks), worst, b.radius))
            if label.startswith("stack") or length == (1.0 if "18" in label else 0.5):
                errors.setdefault(label, {})[radius] = worst
        columns = ("run", "length / h", *(f"F({u:g})" for u in case.marks), "worst, % of the stack of 4")
        page.table("Force in N on a width of 10 mm", (*columns, "least R/h at the end"), rows)
        _judge(page, case, found, reference)
        best = found["BEND8", 0.5]
        curves += [Curve(f"BEND8, R = {radius:g} h", best.u, best.force)]
        curves += [Curve(f"stack of 4, R = {radius:g} h", reference.u, reference.force, "k--")]
        if radius == RADII[0]:
            title = "BEND8 over the cylinder of radius h"
            page.shape("fold", best.result, title, values="plastic_strain_max", view=(-90, 0))
    page.figure("folds", plot(curves, "displacement u, mm", "force F, N", limits=(0, 150)), "BEND8 and stacks of four")
    _summary(page, errors)
    page.text(
        "Over the cylinder of 5 h the strip lies on the tool at the end, and the force more than doubles in the last "
        "quarter of the stroke: there it depends on the end of the contact, and on the length of the elements."
    )


def _summary(page: Page, errors: dict[str, dict[float, float]]) -> None:
    page.heading("Which order over which cylinder")
    radii = sorted({radius for row in errors.values() for radius in row})
    rows = [(label, *(row.get(radius) for radius in radii)) for label, row in errors.items()]
    columns = ("run", *(f"R = {radius:g} h" for radius in radii))
    title = "Largest deviation of the force from the stack of four layers, %; 8 nodes: length h/2, 18 nodes: h"
    page.table(title, columns, rows)
    lines = [
        Curve(label, list(row), [max(abs(e), 0.05) for e in row.values()], "o--" if "18" in label else "o-")
        for label, row in errors.items()
        if len(row) == len(radii)
    ]
    figure = plot(lines, "radius of the cylinder / h", "largest deviation, %", log="y", level=3.0)
    page.figure("orders", figure, "Largest deviation from the stack of four layers; the line is at 3 %")


CASE = Case(
    name="bend-small-cylinders",
    title="Folding over cylinders of 1 to 10 thicknesses",
    problem=f"""
Plane strain, h = 1 mm, kappa = 175000, mu = 80770, y0 = 160, H = {HARDENING:g}; forces on a width of 10 mm. Half of a
strip lies on a cylinder at x = 0; the lower edge of its end is pushed down. Cylinders of 1, 2 and 5 mm: half length
{SHORT.length:g} mm, stroke {SHORT.stroke:g} mm; of 10 mm: {LONG.length:g} mm and {LONG.stroke:g} mm. Penalty 5000
N/mm^3, 5 x 5 contact points. Order 1 as in the literature, higher orders with E_33 tied; 12 points of the split rule,
in stacks of two and four 4 Gauss points a layer, of eight 3.
""",
    reference="""
Own stack of four layers of EAS3DEAS of order 2, length h/4 (largest cylinder: h/2); eight layers over the smallest.
Over the largest also CalculiX: four layers of C3D20R, length h/2, surface contact, the same penalty. Uncertainty: the
difference of four and eight layers (checks).
""",
    own="four layers of EAS3DEAS of order 2, umform itself; CalculiX beside it over the largest cylinder",
    run=run,
    cost=60.0,
)

"""Air bending against the rules of the shop: force, inside radius, K-factor."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from umform.processes.air_bending import AirBend, AirBending
from umform.processes.air_bending.formulas import shop_forces, tensile_strength
from umform.sheet_metals import get
from umform_book.air_bending.causes import known
from umform_book.air_bending.runs import INCREMENT, bend
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.page import Page

THICKNESS = 2.0
#: Openings over the thickness; 8 is the default.
OPENINGS = (6.0, 8.0, 12.0, 24.0)
METALS = ("1.4301", "EN AW-5754", "DP600")
#: Stroke over that of a sheet wrapped around the tip at 90 degrees: it leaves about 90 degrees.
_STROKE = 0.93


def din_factor(ratio: float) -> float:
    """K of DIN 6935: half of its correction factor k = 0.65 + 0.5 log10(R/t), which is 1 from R/t = 5 on."""
    return 0.5 * min(0.65 + 0.5 * math.log10(ratio), 1.0)


@dataclass(frozen=True)
class Band:
    """Published K-factors of air bends for R/t above ``above``: soft and hard metals."""

    above: float
    soft: float
    hard: float


_TENSILE = (
    "the rule uses the tensile strength, but this metal hardens beyond the strains of the bend: its flow stress up to "
    "a strain of 0.2 is a smaller part of the tensile strength than for mild steel, and so is the force"
)
_CIRCLE = (
    "an air bend is no arc: in a wide die the curvature fades along the leg, R is that of the circle that fits the "
    "middle, and K absorbs the difference; the neutral fibre agrees with the tables"
)
#: Wikipedia, "Bending (metalworking)", table of K-factors for air bending.
BANDS = (Band(0.0, 0.33, 0.40), Band(1.0, 0.40, 0.45), Band(3.0, 0.50, 0.50))
#: Machinery's Handbook, 28th ed.: soft brass, copper; soft steel, aluminium; bronze, cold rolled and spring steel.
HANDBOOK = (0.35, 0.41, 0.45)


def published(ratio: float) -> tuple[float, float]:
    """Smallest and largest of the published K-factors at R/t."""
    band = max((band for band in BANDS if ratio >= band.above), key=lambda band: band.above)
    every = (din_factor(ratio), band.soft, band.hard, *HANDBOOK)
    return min(every), max(every)


def textbook_force(case: AirBending) -> float:
    """Largest force in N/mm, (1 + 4 t/V) Rm t^2 / V."""
    t, V = case.thickness, case.opening
    return (1.0 + 4.0 * t / V) * tensile_strength(case.material) * t**2 / V


def flow_ratio(case: AirBending) -> float:
    """Mean yield stress up to the strain of 0.2, that of a bend, over the tensile strength."""
    curve = case.material.hardening.curve()
    return float(np.mean([curve(e)[0] for e in np.linspace(0.0, 0.2, 201)])) / tensile_strength(case.material)


def brake(opening: float, metal: str = "") -> AirBending:
    """The default brake with an opening of so many thicknesses, the radii of the tools in proportion."""
    V = opening * THICKNESS
    case = AirBending(
        thickness=THICKNESS, opening=V, die_radius=V / 8.0, punch_radius=1.5 / 16.0 * V, increment=INCREMENT
    )
    if metal:
        case = replace(case, material=get(metal).law)
    return replace(case, stroke=_STROKE * case.rigid_stroke(45.0))


def _forces(page: Page, found: dict[str, AirBend]) -> None:
    rows = []
    for label, bent in found.items():
        force, rule = bent.measures.largest_force, textbook_force(bent.case)
        low, high = shop_forces(bent.case)
        Rm = tensile_strength(bent.case.material)
        C = force * bent.case.opening / (Rm * THICKNESS**2)
        rows.append((label, Rm, flow_ratio(bent.case), force, C, rule, force / rule, low, high))
        low_flow = known(0.35, _TENSILE, flow_ratio(bent.case) < 0.95 * flow_ratio(brake(8.0)))
        page.check(f"{label}: largest force over (1 + 4 t/V) Rm t^2/V, workshop formula", force, rule, 0.2, **low_flow)
    columns = ("bend", "Rm MPa", "flow stress/Rm", "largest force N/mm", "C = F V/(Rm t^2)", "C = 1 + 4 t/V", "over it")
    page.table("Largest force", (*columns, "C = 1.33", "C = 1.42"), rows)


def _radii(page: Page, found: dict[str, AirBend]) -> None:
    rows = []
    for label, bent in found.items():
        m = bent.measures
        ratio = m.radius / THICKNESS
        low, high = published(ratio)
        radius = 100.0 * m.radius / bent.case.opening
        rows.append((label, m.angle, ratio, radius, m.k_factor, din_factor(ratio), low, high, m.neutral_fibre))
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        what = f"{label}: K among the published ones at R/t = {ratio:.2f}"
        misfit = known(0.15, _CIRCLE, ratio > 3.0)
        page.check(what, m.k_factor, middle, half, relative=False, **misfit)
        what = f"{label}: neutral fibre, in the flat sheet, among the published K at R/t = {ratio:.2f}"
        page.check(what, m.neutral_fibre, middle, half, relative=False)
    columns = (
        "bend",
        "angle",
        "R/t",
        "R in % of V",
        "K",
        "K by DIN 6935",
        "least published",
        "largest",
        "neutral fibre",
    )
    page.table("Inside radius and K-factor after unloading", columns, rows)


def run(page: Page) -> None:
    """Fill the page."""
    wanted = {f"DC04, V/t = {opening:g}": brake(opening) for opening in page.pick(OPENINGS, OPENINGS[1:2])}
    wanted |= {f"{metal}, V/t = 8": brake(8.0, metal) for metal in page.pick(METALS, ())}
    found = {label: bend(page, label, wanted[label]) for label in page.each(wanted)}
    _forces(page, found)
    _radii(page, found)
    if page.short:
        return
    steel = [found[f"DC04, V/t = {opening:g}"] for opening in OPENINGS]
    ratios = [bent.measures.radius / THICKNESS for bent in steel]
    curves = [
        Curve("computed, DC04", ratios, [bent.measures.k_factor for bent in steel], "o-"),
        Curve("DIN 6935", ratios, [din_factor(r) for r in ratios]),
        Curve("least published", ratios, [published(r)[0] for r in ratios], "k:"),
        Curve("largest published", ratios, [published(r)[1] for r in ratios], "k--"),
    ]
    page.figure("k-factor", plot(curves, "R/t", "K"), "K-factor by R/t, and published values")
    forces = [bent.measures.largest_force / textbook_force(bent.case) for bent in steel]
    flow = [
        bent.measures.largest_force / (flow_ratio(bent.case) * textbook_force(bent.case))
        for bent in found.values()
        if bent.case.opening == 8.0 * THICKNESS
    ]
    figure = plot([Curve("DC04", OPENINGS, forces, "o-")], "V/t", "force over (1 + 4 t/V) Rm t²/V", level=1.0)
    page.figure("force", figure, "Largest force over the workshop formula")
    page.text(
        f"The force is {100 * min(forces):.0f} to {100 * max(forces):.0f} % of the formula for mild steel. Formulas "
        "serve to choose a press: they include friction and are meant as upper bounds; here the tools are "
        f"frictionless. With the flow stress instead of Rm the formula serves all metals: {100 * min(flow):.0f} to "
        f"{100 * max(flow):.0f} % at V/t = 8. The neutral fibre moves outwards with R/t as in the tables. K does not: "
        "tables give it with the radius of the drawing, here it belongs to the circle that fits the bend, and falls "
        "as the fit gets worse. Use the bend deduction, or K together with its R ([air bending](../air-bending.md))."
    )
    page.shape("shape", steel[0].result, "V/t = 6 after unloading", values="plastic_strain_max", view=(-90, 0))


CASE = Case(
    name="air-bend-shop-formulas",
    title="Air bending: workshop formulas",
    problem=f"""
Sheets of t = {THICKNESS:g} mm in plane strain on the brake of `umform bend`, opening V of 6 to 24 thicknesses with
radii in proportion, bent to about 90 degrees and unloaded: metal like DC04; for V/t = 8 also metals of the library.
Measured: largest force; inside radius R and K-factor after unloading. Rm: Considère's rule on the hardening curve.
""",
    reference="""
Rules of thumb, no exact references: they show that the results are realistic for a press brake.

* Force: F = C Rm b t^2 / V with C = 1 + 4 t/V for V/t up to 10 and C = 1 above (German workshops, formula sheet
  "Berechnungen Biegen", scribd.com/doc/125260567); here 1 + 4 t/V for all V/t. Makers of press brakes print C = 1.33 to
  1.42, others up to 1.6 (machinecalcs.com/press-brake-tonnage-calculator). They differ by 10 to 20 %; limit: 20 %.
* Inside radius: 15 to 17 % of V for mild steel (artizono.com/press-brake-tonnage-calculator: 16 %).
* K-factor: DIN 6935, k = 0.65 + 0.5 log10(R/t) for a fibre at k t/2, K = k/2, up to R/t = 5 (as quoted at
  catia-begin.blogspot.com/2009/02 and in Tabellenbuch Metall); soft to hard metals 0.33 to 0.40 up to R/t = 1, 0.40 to
  0.45 up to 3, 0.50 above (Wikipedia, "Bending (metalworking)"); Machinery's Handbook, 28th ed.: 0.35, 0.41 (soft
  steel, aluminium), 0.45 (cold rolled steel), as quoted by PTC ("About Bend Tables", support.ptc.com). Limit: the range
  of these.
""",
    run=run,
    cost=25.0,
)

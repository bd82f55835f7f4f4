"""Deep drawing of AA5182-O by a spherical punch: thickness strains within the band of eight results of four codes."""

from __future__ import annotations

from typing import Any

import numpy as np

from umform.errors import NoConvergence
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.drawing.rim import SYMMETRIC
from umform_book.drawing.spherical import (
    ALUMINIUM,
    BLANK,
    DIE,
    DIE_EDGE,
    FRICTION,
    GAP,
    MISES,
    PUNCH,
    STROKE,
    THICKNESS,
    Drawn,
    Floats,
    Setup,
    made,
)
from umform_book.page import Page
from umform_book.references import table

#: Runs of the page: both metals, and variants of the first, whose law is cheaper.
METALS = {"Mises": Setup(MISES), "Yld2004": Setup(ALUMINIUM)}
VARIED = {
    "3 mm": Setup(MISES, 3.0, 4),
    "3 mm, two layers": Setup(MISES, 3.0, 4, layers=2),
    "3 mm, penalty 4e4": Setup(MISES, 3.0, 4, penalty=4e4),
    "ANS3DEAS, 1.5 mm": Setup(MISES, 1.5, 14, "ANS3DEAS"),
}
#: What each row of the budget is compared with.
BUDGET = {
    "3 mm": "Mises",
    "3 mm, two layers": "3 mm",
    "3 mm, penalty 4e4": "3 mm",
    "ANS3DEAS, 1.5 mm": "Mises",
    "Yld2004": "Mises",
}
#: How far from the band a strain may lie: twice the error of reading the figure.
OUTSIDE = 0.01
#: Known miss with Mises, whose band is narrow and steep over the edge of the die.
_KNOWN = 0.012
_CAUSE = "mesh: elements of 3 mm instead of 2 mm change the strains by 0.01 (see the budget)"
#: Largest relative change of the volume, which is elastic: that of balanced tension of 400 MPa.
VOLUME = 2.0 * 400.0 * (1.0 - 2.0 * 0.33) / 69.2e3


def outside(cup: Drawn, band: dict[str, Floats], metal: str) -> Floats:
    """How far the thickness strains lie outside the band, at its radii; zero within it."""
    strain = np.interp(band["radius"], cup.place, cup.strain)
    low, high = band[f"{metal} low"], band[f"{metal} high"]
    off: Floats = np.maximum(np.maximum(low - strain, strain - high), 0.0)
    return off


def run(page: Page) -> None:
    """Fill the page."""
    if page.short:
        cup, _ = made(page, "10 mm", Setup(MISES, 5.0, 4, "ANS3DEAS"), 10.0)
        page.at_most("10 mm: difference of draw-in at theta and 90 degrees - theta, mm", cup.asymmetry, SYMMETRIC)
        page.at_most("10 mm: relative change of the volume", abs(cup.volume), VOLUME)
        return
    band = table("spherical_punch_codes.csv")
    found: dict[str, Drawn] = {}
    setups = METALS | VARIED
    for label in page.each(setups):
        try:
            found[label], result = made(page, label, setups[label])
        except NoConvergence as error:
            page.text(f"{label}: the run ends before the end of the stroke. {error.where}; {error.cause}.")
            continue
        if label == "Yld2004":
            page.shape("cup", result, f"Yld2004 at {STROKE:g} mm, a quarter of the cup")
    page.table(
        f"At a stroke of {STROKE:g} mm: draw-in in mm, largest force of the punch in kN, logarithmic thickness strains",
        ("", "elements", "draw-in at 0", "45", "90 degrees", "force", "strain at the pole", "least", "at the rim, x"),
        [(label, *cup.row()) for label, cup in found.items()],
    )
    _budget(page, found)
    _figures(page, found, band)
    for metal in ("Mises", "Yld2004"):
        off = outside(found[metal], band, metal)
        where = band["radius"][int(off.argmax())]
        what = f"{metal}: thickness strain outside the band of the codes, at most (at {where:g} mm)"
        excuse: dict[str, Any] = {"known": _KNOWN, "cause": _CAUSE} if metal == "Mises" else {}
        page.at_most(what, float(off.max()), OUTSIDE, **excuse)
    mises = found["Mises"]
    page.at_most("Mises: difference of draw-in at theta and 90 degrees - theta, mm", mises.asymmetry, SYMMETRIC)
    for metal in METALS:
        page.at_most(f"{metal}: relative change of the volume", abs(found[metal].volume), VOLUME)


def _budget(page: Page, found: dict[str, Drawn]) -> None:
    """Effect of mesh, layers, penetration, element and yield function."""
    rows = []
    for label, other in BUDGET.items():
        if label not in found or other not in found:
            continue
        cup, base = found[label], found[other]
        change = np.abs(np.interp(base.place, cup.place, cup.strain) - base.strain)
        ways = (100.0 * (cup.force / base.force - 1.0), *(cup.drawn - base.drawn))
        rows.append((label, other, *ways, float(change[base.place <= PUNCH].max()), float(change.max())))
    columns = ("", "less", "force, %", "draw-in at 0, mm", "45", "90 degrees", f"strain within {PUNCH:g} mm", "all")
    page.table("Budget: effect of each change; largest strains, along x", columns, rows)


def _figures(page: Page, found: dict[str, Drawn], band: dict[str, Floats]) -> None:
    curves = []
    for metal, dots in (("Mises", "C0"), ("Yld2004", "C1")):
        for edge in ("low", "high"):
            label = f"{metal}, four codes" if edge == "low" else ""
            curves.append(Curve(label, band["radius"], band[f"{metal} {edge}"], f"{dots}:"))
        curves.append(Curve(metal, found[metal].place, found[metal].strain, f"{dots}-"))
    caption = "Thickness strain along the rolling direction; dotted: lowest and highest result of the codes"
    page.figure("thickness", plot(curves, "radius before, mm", "logarithmic thickness strain"), caption)
    rims = [Curve(metal, found[metal].angle, found[metal].rim) for metal in METALS if metal in found]
    page.figure("rim", plot(rims, "angle to the rolling direction, degrees", "draw-in, mm"), "Draw-in of the rim")


CASE = Case(
    name="drawing-spherical-punch",
    title="Deep drawing of AA5182-O by a spherical punch",
    problem=f"""
A disc of {2 * BLANK:g} mm in diameter, {THICKNESS:g} mm thick, lies between die and holder with a fixed gap of {GAP:g}
mm. A spherical punch of radius {PUNCH:g} mm draws it by {STROKE:g} mm through an opening of {2 * DIE:g} mm, edge radius
{DIE_EDGE:g} mm; mu = {FRICTION:g} on all tools. E = 69.2 GPa, nu = 0.33, yield stress 126 + 189.1 (1 - exp(-13.1 p)) +
220.7 p MPa; Mises, and Yld2004-18p of the card AA5182-O. A quarter, one layer of BEND18, elements of 2 mm along the
radius and 6 on the quarter of the rim, 3 x 3 contact points, penalty 2e4 MPa/mm. The rolling direction is x. The sheet
is not released.
""",
    reference="""
Example 4 of the UMMDp (tools, hardening, coefficients). Strains: Inoue, Takizawa, Kuwabara 2018, J. Phys. Conf. Ser.
1063, 012102, fig. 3: eight results of four codes along the rolling direction, with Mises and with Yld2004-18p, each
with five layers of linear solid elements. These are results of codes, not measurements. The lowest and the highest
were read from the figure to 0.005; with Yld2004 the codes are up to 0.11 apart. Forces and draw-in were not published:
the page shows them without a reference. With an isotropic metal the cup must be symmetric about 45 degrees, as the mesh
is; plastic flow keeps the volume.
""",
    run=run,
    cost=400.0,
)

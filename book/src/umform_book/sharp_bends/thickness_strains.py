"""Candidates for the variation of E_33 through the thickness: accuracy and cost in a sharp bend."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from umform.elements import thickness_rule
from umform.materials import NeoHooke
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.page import Page
from umform_book.printed import about
from umform_book.sharp_bends.arc_bending import ArcBending
from umform_book.sharp_bends.candidates import of_order, stack
from umform_book.sharp_bends.section import BentSection, ThicknessStrain
from umform_book.sharp_bends.states import STATES, Patch, lowest_eigenvalues, stress_free
from umform_book.sharp_bends.strips import Strip, bend
from umform_book.variants import Variant

Floats = NDArray[np.float64]

HARDENING = 500.0
STRAINS = (0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3)
#: With hardening the comparison goes on to R/h = 1.
HARDENING_STRAINS = (0.1, 0.2, 0.3, 0.4, 0.5)
ORDERS = tuple(ThicknessStrain(f"order {p}", p) for p in (1, 2, 3, 4, 5))
LIMIT = ThicknessStrain("E_33 free at each point", None)
LOGARITHMIC = tuple(ThicknessStrain(f"logarithm, order {p}", p, logarithmic=True) for p in (1, 2, 3))
#: order of E_33, order of the volume change
AVERAGED = tuple(
    ThicknessStrain(f"order {p}, volume of order {q}", p, volume=q) for p, q in ((1, 0), (1, 1), (2, 1), (2, 2))
)
STABILISED = tuple(ThicknessStrain(f"order 4, stabilised by {c:g}", 4, stabilisation=c) for c in (0.001, 0.01, 0.1))
ALL = (*ORDERS, LIMIT, *LOGARITHMIC, *AVERAGED, *STABILISED)

#: Elements of higher orders with 12 split points: order 11 is free at each of them.
HIGHER = tuple(of_order("ANS3DEAS", p) for p in (5, 7, 11))
HINGE = Strip("supports", 25.0, 20.0, 100.0)

Ratios = dict[str, Floats]


def parameters(strain: ThicknessStrain) -> str:
    """Unknowns of a section beside its two of the mid-line and the director."""
    if strain.order is None:
        return "1 a point"
    pressures = 0 if strain.volume is None else strain.volume + 1
    return f"{strain.order} + {pressures}" if pressures else str(strain.order)


def _perfect(page: Page) -> Ratios:
    page.heading("Perfect plasticity: moment over that of Hill")
    chosen = page.pick(ALL, (ORDERS[0], ORDERS[3], LIMIT, LOGARITHMIC[2], AVERAGED[3]))
    found = {s.label: BentSection(s).moments(STRAINS) for s in page.each(chosen, lambda s: s.label)}
    rows = [(s.label, parameters(s), *found[s.label].tolist()) for s in chosen]
    page.table("By surface strain", ("thickness strain", "parameters", *(f"{x:g}" for x in STRAINS)), rows)
    to = STRAINS.index(0.2)
    for strain in (*ORDERS[2:4], LIMIT):
        if strain.label in found:
            row = found[strain.label][: to + 1].tolist()
            worst = max(row, key=lambda ratio: abs(ratio - 1.0))
            page.check(f"{strain.label}: worst moment over Hill's to a surface strain of 0.2", worst, 1.0, 0.04)
    at = STRAINS.index(0.3)
    order_4, limit = (float(found[s.label][at]) for s in (ORDERS[3], LIMIT))
    page.check("order 4 against E_33 free at each point, surface strain 0.3", order_4, limit, 0.01)
    _logarithm(page, found[LIMIT.label] - found[LOGARITHMIC[2].label])
    return found


def _logarithm(page: Page, less: Floats) -> None:
    """Eq. (2.39): the moment that is lost with the logarithm."""
    columns = ("", *(f"{x:g}" for x in STRAINS))
    leading = [2.0 / 3.0 * x**2 for x in STRAINS]
    rows: list[tuple[str | float, ...]] = [("measured", *less.tolist()), ("estimate (2/3) x²", *leading)]
    page.table("Moment of free E_33 minus that of the logarithm, order 3, over Hill's", columns, rows)
    at = STRAINS.index(0.2)
    page.check("logarithm: moment lost at 0.2 against the estimate (2.39)", float(less[at]), leading[at], 0.3)


def _hardening(page: Page) -> Ratios:
    page.heading(f"Hardening modulus {HARDENING:g} MPa: moment over that of a stack")
    sheet = stack("ANS3DEAS", page.pick((32,), (16,))[0], 2)
    reference = ArcBending(sheet, HARDENING).moments(HARDENING_STRAINS)
    chosen = page.pick(ALL, (ORDERS[0], ORDERS[3]))
    found = {
        s.label: BentSection(s, HARDENING).moments(HARDENING_STRAINS) / reference
        for s in page.each(chosen, lambda s: f"{s.label}, hardening")
    }
    columns = ("thickness strain", "parameters", *(f"{x:g}" for x in HARDENING_STRAINS))
    rows = [(s.label, parameters(s), *found[s.label].tolist()) for s in chosen]
    page.table(f"Over the moment of a {sheet.label}, by surface strain", columns, rows)
    _against_elements(page, reference)
    return found


def _against_elements(page: Page, reference: Floats) -> None:
    """The section without elements against elements with the same points."""
    chosen = [of_order("ANS3DEAS", p) for p in page.pick((1, 2, 3, 4), (4,))] + list(page.pick(HIGHER, ()))
    rows: list[tuple[str | float, ...]] = []
    for candidate in page.each(chosen, lambda c: c.label):
        order = candidate.variant.element.thickness_order
        rule = thickness_rule(candidate.points, candidate.rule)
        section = BentSection(ThicknessStrain(candidate.label, order), HARDENING, rule).moments(HARDENING_STRAINS)
        found = ArcBending(candidate, HARDENING).moments(HARDENING_STRAINS)
        rows.append((candidate.label, *(found / reference).tolist()))
        far = float(np.abs(found / section - 1.0).max())
        page.at_most(f"{candidate.label}: element against section with the same points, largest difference", far, 0.005)
    columns = ("element", *(f"{x:g}" for x in HARDENING_STRAINS))
    page.table("The same, of elements of length h/10 with 12 split points", columns, rows)


def _hinge(page: Page) -> None:
    page.heading("The hinge with E_33 free at each point")
    candidates = (of_order("ANS3DEAS", 4), HIGHER[0], HIGHER[2])
    found = {c.label: bend(page, HINGE, c, 50) for c in page.each(candidates, lambda c: f"hinge, {c.label}")}
    marks = (5.0, 10.0, 15.0, 20.0)
    rows: list[tuple[str | float, ...]] = []
    rows += [(label, *(b.at(u) for u in marks), b.radius, about(b.iterations)) for label, b in found.items()]
    columns = ("element", *(f"F({u:g})" for u in marks), "least R/h at the end", "iterations, about")
    page.table("Three-point bend, H = 100 MPa, elements of length h/2, force in N on a width of 10 mm", columns, rows)
    order_4, free = (found[c.label].at(20.0) for c in (candidates[0], candidates[2]))
    page.check("three-point bend, F(20): order 4 against order 11", order_4, free, 0.01)


def _squeezed(page: Page) -> None:
    """Whether the order or the tying causes the negative eigenvalues of a squeezed patch."""
    page.heading("Negative eigenvalues that a stabilisation would address")
    law = NeoHooke(E=1000.0, nu=0.3)
    state = next(s for s in STATES if s.name == "through the thickness 0.5")
    stretches = {state.name: stress_free(state, law, (1.0,))}
    rows: list[tuple[str | float, ...]] = []
    counts = {}
    for tied in (False, True):
        for order in page.pick((1, 2, 3, 4), (1, 4)):
            variant = Variant("ANS3DEAS", {"thickness_order": order, "tie_E33": tied})
            low, count = lowest_eigenvalues(Patch(variant, 4), law, stretches, (1.0,))[state.name]
            rows.append((f"order {order}, E_33 {'tied' if tied else 'not tied'}", count, low))
            counts[tied, order] = count
    columns = ("ANS3DEAS", "negative eigenvalues", "lowest, MPa mm")
    page.table("Patch of 4 x 4 elements squeezed elastically to half its thickness", columns, rows)
    for tied in (False, True):
        what = f"E_33 {'tied' if tied else 'not tied'}: negative eigenvalues at order 4 minus those at order 1"
        page.check(what, counts[tied, 4] - counts[tied, 1], 0.0, 0.5, relative=False)


def _figures(page: Page, perfect: Ratios, hardening: Ratios) -> None:
    shown = [*ORDERS[:4], LIMIT, *LOGARITHMIC[1:], AVERAGED[1], AVERAGED[3], STABILISED[1]]

    def curves(found: Ratios, x: Sequence[float]) -> list[Curve]:
        return [Curve(s.label, x, found[s.label], "o--" if s.logarithmic else "o-") for s in shown]

    figure = plot(curves(perfect, STRAINS), "surface strain k h / 2", "moment over Hill's", level=1, limits=(0.85, 1.3))
    page.figure("perfect", figure, "Perfect plasticity")
    drawn = curves(hardening, HARDENING_STRAINS)
    figure = plot(drawn, "surface strain k h / 2", "moment over that of the stack", level=1, limits=(0.8, 1.3))
    page.figure("hardening", figure, f"H = {HARDENING:g} MPa")


def _verdict(page: Page, perfect: Ratios, hardening: Ratios) -> None:
    page.heading("Choice and reasons")

    def off(found: Ratios, strain: ThicknessStrain, at: int) -> str:
        return f"{100 * (float(found[strain.label][at]) - 1):+.1f} %"

    a, b = STRAINS.index(0.2), HARDENING_STRAINS.index(0.3)
    pairs = {
        name: f"{off(perfect, s, a)} from Hill at 0.2, {off(hardening, s, b)} from the stack at 0.3"
        for name, s in {
            "free": LIMIT,
            "logarithm": LOGARITHMIC[2],
            "linear": AVERAGED[1],
            "quadratic": AVERAGED[3],
            "four": ORDERS[3],
            "stabilised": STABILISED[1],
        }.items()
    }
    gain = 100.0 * (hardening[ORDERS[3].label] / hardening[LIMIT.label] - 1.0)
    gains = [float(gain[HARDENING_STRAINS.index(x)]) for x in (0.3, 0.5)]
    page.text(
        f"""\
* **Order 4** ({pairs["four"]}): three parameters more than the literature on 8 nodes. Used in BEND8 and BEND18 with an
  elastic law.
* **S_33 linear in t, E_33 solved at each point** ({pairs["free"]}) is the limit of the orders. Its linear part
  vanishes with the mode t, so S_33 is constant over the thickness. Order 11 with 12 points is this element. It gains
  {gains[0]:.1f} % at a surface strain of 0.3 and {gains[1]:.1f} % at 0.5 (R/h = 1), with 11 parameters instead of 4.
  Used for plastic laws because of [springback](bend-springback.md): the complete order.
* **The logarithm of the thickness stretch** ({pairs["logarithm"]}) keeps the volume with one order less, but makes
  S_33 C_33 constant, the Kirchhoff stress across the sheet, which loses (2/3) x² of the moment, eq. (2.39). The error
  does not fall with the order. Not used.
* **Averaged volumetric part.** The mean alone halves the moment ({float(perfect[AVERAGED[0].label][a]):.2f} of Hill's):
  the pressure must jump where the flow changes its sign. Linear in t with order 1 it does not lock, with three
  parameters ({pairs["linear"]}), but is too soft. Quadratic with order 2 it equals order 4 ({pairs["quadratic"]}) with
  five. Not used: a law would have to give its volumetric part separately, which user laws and tables cannot.
* **Stabilised enhancement.** c mu a_j^2 on the orders above 1 stiffens a sharp bend in proportion: c = 0.01
  has {pairs["stabilised"]}. It is not needed: in the one state where BEND8 has more negative eigenvalues than the
  element of the literature, they come with the tying of E_33 and not with the order (table above).
  Not used."""
    )


def run(page: Page) -> None:
    """Fill the page."""
    perfect = _perfect(page)
    hardening = _hardening(page)
    if not page.short:
        _hinge(page)
    _squeezed(page)
    if page.images is not None and not page.short:
        _figures(page, perfect, hardening)
    if not page.short:
        _verdict(page, perfect, hardening)


CASE = Case(
    name="bend-candidates",
    title="Which thickness strain? The candidates",
    problem=f"""
A section in pure plastic bending: straight director of free length, 60 points through the thickness, plane strain, no
axial force, 100 increments of curvature. Besides the stretches of mid-line and director it has one of: E_33 with
Legendre polynomials up to an order in t (the elements); E_33 free at each point (constant S_33); the same polynomials
in the logarithm of the thickness stretch; order 1 or 2 with the logarithm of the volume change projected on polynomials
in t; order 4 with a stabilisation c mu. J2, kappa = 175000, mu = 80770, y0 = 160, perfect or H = {HARDENING:g} MPa.
Parameters: of E_33 + of the pressure.

![A sheet in pure bending, from the page of the moment](images/bend-moment-shape.png)
""",
    reference="""
Perfect plasticity: Hill, The Mathematical Theory of Plasticity (1950), exact for a rigid-plastic sheet; an elastic one
of 16 layers is 1.3 % below at 0.2 ([moment](bend-moment.md)). Hardening: a stack of 32 layers, 0.4 % from one of 16
(same page).
""",
    own="with hardening, 32 layers, umform itself; Hill's closed form without",
    run=run,
    cost=15.0,
)

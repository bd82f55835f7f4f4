"""Pure plastic bending of one element in plane strain: its moment with directors held and free."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import factorial

import numpy as np
from numpy.typing import NDArray

from umform.results.shape import Shape
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.page import Page
from umform_book.sharp_bends.arc_bending import ArcBending
from umform_book.sharp_bends.candidates import BEND8, BEND18, KAPPA, YIELD_STRESS, of_order, stack

Floats = NDArray[np.float64]

HARDENING = 500.0
STRAINS = (0.05, 0.1, 0.2, 0.3, 0.4, 0.5)
HELD_STRAINS = (0.01, 0.05, 0.1, 0.15, 0.2)
ORDERS = (1, 2, 3, 4)
#: Rules in the held bend: name -> points, rule.
RULES = {"8 Gauss": (8, "gauss"), "12 split": (12, "split"), "15 Gauss": (15, "gauss")}
#: Where formula (2.29), a leading term, is compared: a small surface strain at which the excess is yet large enough.
FORMULA_STRAINS = {1: 0.05, 2: 0.15, 3: 0.3}
#: Elastic core at 0.05; the next term of the series, of relative size x^2 times a small number.
FORMULA_WITHIN = {1: 0.1, 2: 0.1, 3: 0.3}


#: Where order 4 ends.
ORDER_4 = "beyond a surface strain of 0.4 order 4 has a false moment too, formula (2.29)"


def excess(order: int, surface_strain: float) -> float:
    """False moment over the plastic one. eqs. (2.27), (2.29)"""
    m = order + 1
    beta = 0.5 * (m + 1) * 2.0**m * factorial(m) ** 2 / factorial(2 * m)
    return float(np.sqrt(3.0) * m * beta**2 / (2 * m + 1) * KAPPA / YIELD_STRESS * surface_strain ** (2 * m - 1))


def radius_of_excess(order: int, part: float = 0.03) -> float:
    """Radius of the mid-surface over the thickness at which the false moment is so large a part."""
    m = order + 1
    return float(0.5 * (excess(order, 1.0) / part) ** (1.0 / (2 * m - 1)))


def free_shell(surface_strain: float) -> float:
    """Moment over Hill's of a rigid, perfectly plastic shell with straight directors of free length. eq. (2.32)"""
    return 1.0 + 0.25 * surface_strain**2


# Directors held ---------------------------------------------------------------------------------------------------


def _held(page: Page) -> None:
    page.heading("Directors held at the length h, perfect plasticity")
    strains = tuple(sorted({*HELD_STRAINS, *FORMULA_STRAINS.values()}))
    columns = ("element", "points", *(f"{x:g}" for x in HELD_STRAINS))
    rows: list[tuple[str | float | None, ...]] = []
    found: dict[tuple[str, int], dict[float, float]] = {}
    for name in page.pick(("ANS3DEAS", "MI9K3DEAS"), ("ANS3DEAS",)):
        for order in page.each(ORDERS, "{}, held".format):
            for rule, (points, kind) in RULES.items():
                candidate = replace(of_order(name, order), points=points, rule=kind)
                ratios = ArcBending(candidate, length=0.25, held=True).moments(strains)
                at = dict(zip(strains, (float(ratio) for ratio in ratios), strict=True))
                rows.append((candidate.label, rule, *(at[x] for x in HELD_STRAINS)))
                if rule == "15 Gauss":
                    found[name, order] = at
                if rule == "12 split" and order > 2:
                    _near_hill(page, f"{candidate.label}, {rule}, held", [at[x] for x in HELD_STRAINS], HELD_STRAINS)
    page.table("Moment over that of Hill, by surface strain", columns, rows)
    _formula(page, found)


def _near_hill(page: Page, label: str, ratios: Sequence[float], strains: Sequence[float]) -> None:
    worst = max(ratios, key=lambda ratio: abs(ratio - 1.0))
    page.check(f"{label}: worst moment over Hill's to a surface strain of {strains[-1]:g}", worst, 1.0, 0.04)


def _formula(page: Page, found: Mapping[tuple[str, int], Mapping[float, float]]) -> None:
    """The excess over order 4, which has none there, against the formula."""
    rows = []
    for (name, order), at in found.items():
        if order == 4:
            continue
        x = FORMULA_STRAINS[order]
        measured, formula = at[x] - found[name, 4][x], excess(order, x) - excess(4, x)
        rows.append((of_order(name, order).label, x, measured, formula))
        what = f"{rows[-1][0]}: excess at {x:g} against formula (2.29)"
        page.check(what, measured, formula, FORMULA_WITHIN[order])
    page.table(
        "False moment over Hill's: measured (order p minus order 4, 15 Gauss points) and formula (2.29)",
        ("element", "surface strain", "measured", "formula"),
        rows,
    )
    page.text(
        "The formula contains neither length nor nodes of an element, and the results do not depend on them. The rest "
        "at order 4 with 8 Gauss points is quadrature: with held directors the neutral line moves twice as far as in a "
        "sheet, so a rule has no single factor (1.0115 of 8 points holds for a neutral line at the mid-surface)."
    )


# Thickness free ---------------------------------------------------------------------------------------------------


def _free(page: Page) -> dict[str, Floats]:
    page.heading("Thickness free")
    chosen = [of_order("ANS3DEAS", p) for p in (1, 2, 3)] + [BEND8]
    chosen += [of_order("MI9K3DEAS", p) for p in page.pick((1, 2, 3), ())] + [BEND18]
    finest = page.pick((8, 16, 32), (16,))
    stacks = {n: ArcBending(stack("ANS3DEAS", n, 2), HARDENING).moments(STRAINS) for n in page.each(finest)}
    reference = stacks[finest[-1]]
    found = {c.label: ArcBending(c, HARDENING).moments(STRAINS) for c in page.each(chosen, lambda c: c.label)}
    rows: list[tuple[str | float | None, ...]] = [
        ("R/h", *(f"{0.5 / x:.3g}" for x in STRAINS)),
        *((f"stack of {n}: moment over Hill's", *moments.tolist()) for n, moments in stacks.items()),
        *((f"{label}: over that of the stack", *(m / reference).tolist()) for label, m in found.items()),
    ]
    columns = ("surface strain", *(f"{x:g}" for x in STRAINS))
    page.table(f"Moment with H = {HARDENING:g} MPa", columns, rows)
    if len(stacks) > 1:
        what = "stacks of 16 and 32 layers: largest difference of the moment"
        page.at_most(what, float(np.abs(stacks[16] / reference - 1.0).max()), 0.01)
    for label in ("BEND8", "BEND18"):
        for x, ratio in zip(STRAINS, found[label] / reference, strict=True):
            sharpest = {"known": 0.04, "cause": ORDER_4} if x > 0.3 else {}
            what = f"{label}: moment over that of the stack at R/h = {0.5 / x:.2g}"
            page.check(what, float(ratio), 1.0, 0.03, **sharpest)  # type: ignore[arg-type]
    return {label: moments / reference for label, moments in found.items()}


def _free_hill(page: Page) -> None:
    """Perfect plasticity, where Hill's moment is exact for a rigid-plastic sheet."""
    strains = (0.05, 0.1, 0.15, 0.2)
    rows: list[tuple[str | float | None, ...]] = [
        ("shell with straight directors, (2.32)", *map(free_shell, strains), None)
    ]
    sheet = stack("ANS3DEAS", 16, 3)
    order_3 = of_order("ANS3DEAS", 3), of_order("MI9K3DEAS", 3)
    for candidate in page.pick((BEND8, BEND18, *order_3, sheet), (BEND8, sheet)):
        bending = ArcBending(candidate)
        ratios = [float(ratio) for ratio in bending.moments(strains)]
        rows.append((candidate.label, *ratios, bending.thickness_now))
        if candidate is not sheet:
            _near_hill(page, f"{candidate.label}, 12 split, thickness free", ratios, strains)
    columns = ("element", *(f"strain {x:g}" for x in strains), f"thickness at {strains[-1]:g}")
    page.table("Perfect plasticity: moment over that of Hill, and thickness over h", columns, rows)
    page.text(
        f"Hill's sheet is rigid-plastic. An elastic-plastic one has a smaller moment ({100 * (ratios[-1] - 1):+.1f} % "
        f"at {strains[-1]:g}, last row): it thins to {bending.thickness_now:.3f} of h, and the material unloads where "
        "the neutral fibre passes."
    )


# Pictures ---------------------------------------------------------------------------------------------------------


def _figures(page: Page, ratios: Mapping[str, Floats]) -> None:
    curves = [Curve(k, STRAINS, values, "o--" if "18" in k else "o-") for k, values in ratios.items()]
    figure = plot(curves, "surface strain k h / 2", "moment over that of the stack", log="y", level=1.0)
    page.figure("free", figure, f"Thickness free, H = {HARDENING:g} MPa: moment over that of a stack of 32 layers")
    x = np.geomspace(0.02, 0.5, 60)
    curves = [Curve(f"order {p}", x, 100 * np.array([excess(p, float(s)) for s in x])) for p in ORDERS]
    figure = plot(curves, "surface strain k h / 2", "false moment, %", log="y", level=3.0, limits=(0.1, 1e3))
    page.figure("formula", figure, "Formula (2.29): the false moment of each order; the line is at 3 %")


def _shape(page: Page) -> None:
    bending = ArcBending(BEND8, HARDENING, length=0.5)
    bending.moments(STRAINS[-1:])
    u = bending.model.u.reshape(-1, 3)
    page.shape("shape", Shape.displaced(bending.model.mesh, u), "BEND8 bent to R/h = 1", view=(-90.0, 0.0))


def run(page: Page) -> None:
    """Fill the page."""
    _held(page)
    ratios = _free(page)
    _free_hill(page)
    if page.images is not None:
        _figures(page, ratios)
        _shape(page)
    middle, names = STRAINS.index(0.2), [name for name in ratios if "18 nodes" not in name]
    page.text(
        f"The moment is wrong by {_errors(ratios, names, middle)} at R/h = 2.5, and by {_errors(ratios, names, -1)} at "
        "R/h = 1."
    )


def _errors(ratios: Mapping[str, Floats], names: Sequence[str], at: int) -> str:
    return ", ".join(f"{100 * (float(ratios[name][at]) - 1):.3g} % ({name})" for name in names)


CASE = Case(
    name="bend-moment",
    title="Moment of a sharp plastic bend",
    problem=f"""
One element in plane strain (h = 1, length 0.25 and 0.1, width 1) between two sections of an arc, bent from flat by 100
increments of curvature; all nodes on circles, no axial force. J2 plasticity, kappa = {KAPPA:g}, mu = 80770, y0 =
{YIELD_STRESS:g}; perfect, or H = {HARDENING:g} MPa. Above order 1 E_33 is tied; 12 points of the split rule unless
stated. Surface strain k h / 2 = h / (2 R).

* Held: directors keep the length h; the stretch of the mid-line is unknown.
* Free: the radii of all layers of nodes are unknown, as in a sheet in pure bending.
""",
    reference="""
Perfect plasticity: (2 / sqrt 3) y0 h^2 / 4 per width, Hill, The Mathematical Theory of Plasticity (1950), exact for a
rigid-plastic sheet in plane strain; straight directors alone are 1 % above it at a surface strain of 0.2, eq. (2.32),
elastic strains subtract 1 %. With hardening: a stack of 32 layers; convergence from 8 and 16. False moment: closed form
(2.29), the leading term.
""",
    own="with hardening, 32 layers, umform itself; Hill's closed form without",
    run=run,
    cost=8.0,
)

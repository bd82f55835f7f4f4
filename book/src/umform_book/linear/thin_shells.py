"""Locking with thickness: the pinched hemisphere from R/h = 100 to 10000, where round-off ends it."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from umform.errors import SingularMatrix
from umform.materials import SVK
from umform.model import Model
from umform.plotting import COLOURS, house_style
from umform.results.shape import Shape
from umform_book.case import Case
from umform_book.linear_algebra import linear_solution
from umform_book.page import Page
from umform_book.shells import hemisphere, pinched_hemisphere
from umform_book.variants import GOOD, Variant, with_tying

RADIUS, E = 10.0, 6.825e7
SLENDERNESS = (100.0, 300.0, 1000.0, 3000.0, 10000.0)
TIED = tuple(variant for variant in GOOD if variant.options)
_ROUND_OFF = "round-off: the stiffness through the thickness is about (R/h)^4 times that of bending, here 1e16"
_CONDITIONING = "Gee, Ramm & Wall, Comput. Meth. Appl. Mech. Engng. 194 (2005) 2513-2533"

#: found[variant, divisions][slenderness]: flexibility and what round-off does to it.
Found = dict[tuple[Variant, int], dict[float, tuple[float, float]]]


def flexibility(variant: Variant, divisions: int, slenderness: float) -> tuple[float, float]:
    """Mean displacement under the forces times E h^3 / (F R^2), and the difference of outward and inward over it.

    Both displacements are equal by symmetry, so that their difference is round-off; NaN if the matrix is singular.
    """
    h = RADIUS / slenderness
    shell = hemisphere(variant.cells(divisions), variant.cell, radius=RADIUS, thickness=h)
    model = Model(shell, variant.element, material=SVK(E=E, nu=0.3))
    model.symmetry("y0", "y")
    model.symmetry("y1", "x")
    at_B, at_A = (np.intersect1d(shell.nodes("x1"), shell.nodes(side)) for side in ("y0", "y1"))
    model.fix(at_B[:1], "z")
    loads = model.force(at_B, (-0.25, 0, 0), "B").vector + model.force(at_A, (0, 0.25, 0), "A").vector
    try:
        u = linear_solution(model, loads)
    except SingularMatrix:
        return float("nan"), float("nan")
    outward, inward = u[at_A, 1].mean(), -u[at_B, 0].mean()
    mean = 0.5 * (outward + inward)
    return float(mean * E * h**3 / RADIUS**2), float(abs(outward - inward) / mean)


def run(page: Page) -> None:
    """Fill the page."""
    divisions = page.pick((8, 16, 32), (8, 16))
    slender = page.pick(SLENDERNESS, (100.0, 1000.0))
    pairs = [(variant, n) for variant in page.pick(GOOD, TIED) for n in divisions]
    found: Found = {
        pair: {ratio: flexibility(*pair, ratio) for ratio in slender}
        for pair in page.each(pairs, lambda pair: f"{pair[0].label}, {pair[1]}")
    }
    columns = ("element, intervals", *(f"R/h = {ratio:g}" for ratio in slender))
    for place, title in enumerate(("Flexibility v E h^3 / (F R^2)", "Outward minus inward displacement, relative")):
        page.table(
            title,
            columns,
            [(f"{v.label}, {n}", *[value[place] for value in row.values()]) for (v, n), row in found.items()],
        )
    _check(page, found, divisions, slender)
    page.figure("slenderness", _plot(found, divisions), "Flexibility against slenderness; dashed: with E_33 tied")
    model, loads, *_ = pinched_hemisphere(with_tying("MI9K3DEAS"), 16)
    u = linear_solution(model, 2.0 * sum(load.vector for load in loads))
    page.shape("shape", Shape.displaced(model.mesh, 20.0 * u), "R/h = 250, F = 2, displacements 20 times enlarged")


def _check(page: Page, found: Found, divisions: Sequence[int], slender: Sequence[float]) -> None:
    fine, middle = divisions[-1], divisions[-2]
    exact = {ratio: found[with_tying("MI9K3DEAS"), fine][ratio][0] for ratio in slender if ratio < 1e4}
    for variant in TIED:
        for ratio, reference in exact.items():
            what = f"R/h = {ratio:g}: {variant.label}, {middle} intervals"
            page.check(what, found[variant, middle][ratio][0], reference, within=0.05 if middle >= 16 else 0.1)
            if variant.name != "MI9K3DEAS":
                what = f"R/h = {ratio:g}: {variant.label}, {fine} intervals"
                page.check(what, found[variant, fine][ratio][0], reference, within=0.01 if fine >= 32 else 0.03)
    if 1e4 in slender:
        for ratio in (1e3, 3e3):
            errors = [found[variant, fine][ratio][1] for variant in TIED if variant.cell == "hex8"]
            what = f"R/h = {ratio:g}: outward minus inward displacement, 4-node faces, {fine} intervals"
            page.at_most(what, max(errors), 1e-3)
        refused = sum(math.isnan(row[1e4][0]) for row in found.values())
        what = "R/h = 10000: matrices refused as singular"
        page.at_most(what, refused, 0, known=len(found), cause=_ROUND_OFF, theory=_CONDITIONING)
    page.text(
        "The flexibility tends to that of pure bending, as transverse shear and the boundary layers of width sqrt(R h) "
        "fade. An element that locks tends to zero, as coarse meshes without tying of E_33 do. Beyond R/h of some "
        "thousand round-off is the limit, before any element locks. A dash: the matrix is singular in double precision."
    )


def _plot(found: Found, divisions: Sequence[int]) -> Figure:
    names = list(dict.fromkeys(variant.name for variant, _ in found))
    with house_style():
        figure = Figure(figsize=(7.0, 3.2), layout="constrained")
        all_axes = figure.subplots(1, len(divisions), sharey=True)
        for axes, number in zip(all_axes, divisions, strict=True):
            for variant, n in found:
                if n == number:
                    row = found[variant, n]
                    style = "--" if variant.options else "-"
                    values = [value for value, _ in row.values()]
                    axes.semilogx(
                        list(row), values, style, color=COLOURS[names.index(variant.name)], label=variant.label
                    )
            axes.set_title(f"{number} intervals")
            axes.set_xlabel("R/h")
        all_axes[0].set_ylabel("v E h^3 / (F R^2)")
        all_axes[-1].legend(fontsize=6, loc="lower left")
    return figure


CASE = Case(
    name="thin-shells",
    title="Pinched hemisphere, ever thinner",
    problem=f"""
The pinched hemisphere with a hole (R = {RADIUS:g}, nu = 0.3, E = 6.825e7) with R/h from 100 to 10000, linear.
Measured: mean of the outward and inward displacement under the forces, times E h^3 / (F R^2), a constant in pure
bending. Elements that do not lock, without and with tying of E_33.
""",
    reference="""
Our own solution: the finest mesh of MI9K3DEAS with E_33 tied, one for each thickness. Its uncertainty is about 1 %,
from three elements on the finest mesh and from the coarser meshes.
""",
    own="the finest mesh of MI9K3DEAS with E_33 tied, umform itself",
    run=run,
    cost=8.0,
)

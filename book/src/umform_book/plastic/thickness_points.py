"""Points through the thickness: effect of their number and rule on plastic moment and springback."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.elements import thickness_rule
from umform_book.case import Case
from umform_book.page import Page
from umform_book.plastic.bent_sheet import THICKNESS, bend
from umform_book.plastic.curves import Lines, lines_figure
from umform_book.plastic.plane_strain import BendingPath, bending_path
from umform_book.plastic.plate_bending import LAWS
from umform_book.variants import Variant

Floats = NDArray[np.float64]

CURVATURE = 0.02
ELEMENT = Variant("ANS3DEAS")
RULES = ("gauss", "lobatto", "split")
#: What all springback errors of a number of points stay below, if it is to be advised.
TOLERANCE = 0.02


def plastic_moment(points: int, rule: str, shift: float = 0.0) -> float:
    """Fully plastic moment of a rule, over the exact one. eqs. (2.21), (2.22)

    Stress +-1 with its jump at t = shift, times t, summed over the rule; the integral is 1 - shift^2.
    """
    t, w = thickness_rule(points, rule)
    return float(w @ (t * np.sign(t - shift))) / (1.0 - shift**2)


def worst_shifted(points: int, rule: str, reach: float = 0.2) -> float:
    """Largest error of the plastic moment where tension shifts the neutral line by up to ``reach`` half thicknesses."""
    return max(abs(plastic_moment(points, rule, shift) - 1.0) for shift in np.linspace(0.0, reach, 401))


def numbers(rule: str) -> range:
    """Numbers of points that a rule has."""
    return range(2, 16, 2) if rule == "split" else range(2, 16)


Errors = dict[tuple[str, int], tuple[float, float]]


def run(page: Page) -> None:
    """Fill the page."""
    _plastic_moments(page)
    for name in LAWS:
        exact = bending_path(LAWS[name], THICKNESS, CURVATURE)
        errors = _errors(page, name, exact)
        _show(page, name, errors)
        _judge(page, name, errors)
    if page.images is not None:
        _curves(page)


def _plastic_moments(page: Page) -> None:
    rows = [
        (
            str(n),
            *(plastic_moment(n, rule) if n in numbers(rule) else None for rule in RULES),
            *(worst_shifted(n, rule) if n in numbers(rule) else None for rule in RULES),
        )
        for n in range(2, 16)
    ]
    columns = ("points", *RULES, *(f"worst of shifted, {rule}" for rule in RULES))
    page.table("Fully plastic moment of a rule over the exact one, and its worst error with tension", columns, rows)
    page.check("2 Gauss points: 2/sqrt 3", plastic_moment(2, "gauss"), 2.0 / np.sqrt(3.0), within=1e-13)
    page.check("3 Gauss points: 10/9 sqrt 0.6", plastic_moment(3, "gauss"), 10.0 / 9.0 * np.sqrt(0.6), within=1e-13)
    for n in numbers("split"):
        page.check(f"{n} points, split: exact", plastic_moment(n, "split"), 1.0, within=1e-13)
    ten = {rule: worst_shifted(10, rule) for rule in RULES}
    page.text(
        "In a fully plastic section the stress jumps at the neutral line, and no rule integrates a jump inside an "
        "interval. The split rule has a border at the mid-surface, where the jump lies in pure bending. If tension "
        "shifts the neutral line by up to a tenth of the thickness, this advantage is lost: with 10 points the worst "
        "errors are " + ", ".join(f"{100 * e:.1f} % ({rule})" for rule, e in ten.items()) + "."
    )


def _errors(page: Page, name: str, exact: BendingPath) -> Errors:
    """Errors of moment and springback of an element with each rule; the curvature has the outer strain of 1 %."""
    errors: Errors = {}
    pairs = [(rule, n) for rule in RULES for n in page.pick(numbers(rule), (4, 6, 10))]
    for rule, n in page.each(pairs, lambda pair: f"{name}, {pair[0]}, {pair[1]} points"):
        found = bend(page, f"{name}, {rule}, {n} points", ELEMENT, 4, LAWS[name], exact, points=n, rule=rule)
        springback = (CURVATURE - found.residual_curvature) / (CURVATURE - exact.residual_curvature)
        errors[rule, n] = float(found.moment[-1] / exact.moment[-1] - 1.0), springback - 1.0
        own = bending_path(LAWS[name], THICKNESS, CURVATURE, steps=40, rule=thickness_rule(n, rule))
        what = f"moment, {name}, {rule}, {n} points: element against the same rule point by point"
        if n > 2:  # two Lobatto points are the faces: their section has another elastic stiffness
            page.check(what, float(found.moment[-1]), float(own.moment[-1]), within=0.01)
    return errors


def _show(page: Page, name: str, errors: Errors) -> None:
    title = f"Errors in % of moment and springback at an outer strain of 1 %, {ELEMENT.label}, {name}"
    cells: dict[tuple[str, int], tuple[float, float]] = {k: (100 * m, 100 * s) for k, (m, s) in errors.items()}
    page.table(
        title,
        ("points", *(f"{what}, {rule}" for what in ("moment", "springback") for rule in RULES)),
        [
            (str(n), *(cells[r, n][part] if (r, n) in cells else None for part in (0, 1) for r in RULES))
            for n in sorted({n for _, n in errors})
        ],
    )
    panels: dict[str, Lines] = {
        f"error of {what} in %": {
            rule: (
                np.array([n for r, n in errors if r == rule], dtype=float),
                np.array([abs(cells[r, n][part]) for r, n in errors if r == rule]),
            )
            for rule in RULES
        }
        for part, what in enumerate(("moment", "springback"))
    }
    figure = lines_figure("points through the thickness", panels, logarithmic=True)
    page.figure(f"errors-{name}", figure, f"{title}, absolute values")


def _judge(page: Page, name: str, errors: Errors) -> None:
    for n in (n for rule, n in errors if rule == "split" and n >= 6):
        page.at_most(f"error of the springback, {name}, split, {n} points", abs(errors["split", n][1]), TOLERANCE)
    if page.short:
        return
    first = {
        rule: next(
            n for n in numbers(rule) if all(abs(errors[rule, m][1]) < TOLERANCE for m in numbers(rule) if m >= n)
        )
        for rule in RULES
    }
    page.text(
        f"{name.capitalize()}: to keep the error of the springback below {100 * TOLERANCE:g} %, take "
        + ", ".join(f"{n} points or more with {rule}" for rule, n in first.items())
        + "."
    )


def _curves(page: Page) -> None:
    """The moment oscillates over the curvature as one point after the other begins to flow."""
    law = LAWS["perfect"]
    exact = bending_path(law, THICKNESS, CURVATURE)
    y = "moment over the exact one"
    rules = (("gauss", 5), ("gauss", 9), ("lobatto", 9), ("split", 6), ("split", 10))
    lines: dict[str, tuple[Floats, Floats]] = {}
    for rule, n in rules:
        path = bending_path(law, THICKNESS, CURVATURE, rule=thickness_rule(n, rule))
        lines[f"{n} points, {rule}"] = path.curvature[1:], path.moment[1:] / exact.moment[1:]
    page.figure("curvature", lines_figure("curvature", {y: lines}), "Perfect plasticity, rules point by point")


CASE = Case(
    name="plastic-thickness-points",
    title="Points through the thickness",
    problem=f"""
The sheet of the [case of plastic bending](plastic-plate-bending.md), bent to the curvature {CURVATURE:g} (1 % strain in
the outer fibres) and back: four elements of {ELEMENT.label}, 2 to 15 points through the thickness (Gauss; Lobatto;
split, Gauss in each half). Perfect plasticity is the worst case: the stress jumps at the neutral line.

![The sheet, from the page of pure bending](images/plastic-plate-bending-shape-hardening.png)
""",
    reference="""
The same law with 1000 fibres. To separate element and rule, also the law point by point with the rule of the element,
which the element must meet to 1 % (pressure of the bent sheet, thickness order 1). The fully plastic moment of a rule
is a closed sum, eqs. (2.21), (2.22).
""",
    run=run,
    cost=6.0,
)

"""Bars in tension without imperfection: the largest force, and the elongation where it is reached."""

from __future__ import annotations

import numpy as np

from umform.analysis.steps import Move
from umform.materials import J2, Swift, Voce
from umform.results.shape import Shape
from umform_book.case import Case
from umform_book.convergence import show, study
from umform_book.page import Page
from umform_book.plastic.bars import (
    LENGTH,
    THICKNESS,
    WIDTH,
    bar,
    maximum_force,
    maximum_force_plane_strain,
    peak,
)
from umform_book.plastic.curves import Lines, lines_figure
from umform_book.variants import Variant

CONSTANTS = {"E": 210000.0, "nu": 0.3}
LAWS = {
    "Swift": J2(**CONSTANTS, hardening=Swift(500.0, 0.01, 0.2)),
    "Voce": J2(**CONSTANTS, hardening=Voce(160.0, 400.0, 8.0)),
}
WIDTHS = {"width free": False, "width held": True}
ELONGATION = 0.3
STEPS = 40
MEMBRANE_SETTINGS = (
    Variant("ANS3DEAS"),
    *(Variant("EAS3DEAS", {"membrane_modes": modes}, f"{modes} modes") for modes in (4, 5, 7)),
    Variant("MI9K3DEAS"),
)


def run(page: Page) -> None:
    """Fill the page."""
    for law_name, law in LAWS.items():
        panels: dict[str, Lines] = {}
        for width, held in WIDTHS.items():
            force, strain = maximum_force_plane_strain(law) if held else maximum_force(law)
            page.text(
                f"{law_name}, {width}: the largest force per reference area is {force:.4g}, at the logarithmic strain "
                f"{strain:.4f}."
            )
            _one_bar(page, f"{law_name}, {width}", law, held, force, strain, panels)
        figure = lines_figure("elongation", panels)
        page.figure(f"curves-{law_name.lower()}", figure, f"Force over elongation of the finest mesh, {law_name}")


def _one_bar(page: Page, name: str, law: J2, held: bool, force: float, strain: float, panels: dict[str, Lines]) -> None:
    lines: dict[str, tuple[np.ndarray, np.ndarray]] = {}
    strains: dict[tuple[Variant, int], float] = {}
    elongations = np.linspace(0.0, ELONGATION, STEPS + 1)

    def largest(variant: Variant, divisions: int) -> float:
        cells = variant.cells(divisions)
        model, end = bar(variant.element, law, (2 * cells, cells), held=held)
        label = f"{name}, {variant.label}, {divisions} intervals"
        result = page.solve(label, model, Move(end, ELONGATION * LENGTH, steps=STEPS))
        forces = result["end_force"] / (WIDTH * THICKNESS)
        top, at = peak(np.log1p(elongations), forces)
        strains[variant, divisions] = at
        lines[variant.label] = elongations, forces
        if held and law is LAWS["Swift"] and variant.name == "ANS3DEAS" and divisions == 4:
            page.shape(
                "shape",
                Shape.displaced(model.mesh, model.u.reshape(-1, 3)),
                f"Bar after {ELONGATION:g} of elongation, {label}",
            )
        return top / force

    some = (MEMBRANE_SETTINGS[0], MEMBRANE_SETTINGS[3], MEMBRANE_SETTINGS[4])
    variants = page.pick(MEMBRANE_SETTINGS if law is LAWS["Swift"] else some, some)
    found = study(page, variants, page.pick((2, 4, 8), (2,)), largest)
    key = name.lower().replace(", ", "-").replace(" ", "-")
    show(page, key, f"largest force over that of Considere, {name}", found, mesh="intervals along the width")
    panels[f"force per area, {name}"] = dict(list(lines.items())[:6])
    finest = max(found[variants[0]])
    for variant in variants:
        what = f"{name}, {variant.label}, {finest} intervals"
        page.check(f"largest force, {what}", found[variant][finest], 1.0, within=1e-4)
        page.check(f"logarithmic strain at it, {what}", strains[variant, finest], strain, within=0.01)


CASE = Case(
    name="plastic-tension",
    title="The largest force in tension",
    problem=f"""
An eighth of a bar, {LENGTH:g} x {WIDTH:g} x {THICKNESS:g} (N, mm), pulled by {ELONGATION:g} of its length in {STEPS}
increments; the width is free, or held (plane strain). E = 210000, nu = 0.3; Swift's hardening 500 (0.01 + e)^0.2, or
Voce's 400 - 240 exp(-8 e). The state is homogeneous, and stable beyond the largest force since the end is prescribed.
""",
    reference="""
Considère: the force tau exp(-eps) per reference area is largest where d tau/d eps = tau. Width free: tau is the yield
stress, eps = tau/E + e, in closed form. Width held: the law is integrated in numpy in 4000 steps. The maximum is that
of a parabola through the three highest points: 1e-5 of the force, 1 % of the strain with increments of 0.75 %.
""",
    run=run,
    picture="curves-swift",
    cost=18.0,
)

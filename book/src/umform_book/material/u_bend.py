"""NUMISHEET 93, the U-bend, with each kind of hardening: the wall that curls is bent and straightened."""

from __future__ import annotations

from dataclasses import fields

from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.friction.u_bend import HOLDER, MU, STROKE, THICKNESS, Measured, Setup, draw, punch_force, u_bend
from umform_book.metals import HARDENING
from umform_book.page import Page

INTERVALS = 100
#: Laws of a short run: those that differ most.
SHORT = ("isotropic", "Yoshida-Uemori, falling modulus")


def compare_forces(page: Page, forces: list[float]) -> None:
    """Check that the laws agree in the force."""
    page.at_most("force of the punch: largest over least, minus one", max(forces) / min(forces) - 1.0, 0.15)


def run_short(page: Page) -> None:
    """Two laws over the first part of the stroke, without springback."""
    setups = [Setup(intervals=INTERVALS, stroke=15.0, material=HARDENING[name]) for name in SHORT]
    compare_forces(page, [punch_force(draw(page, setup, name)[1]) for setup, name in zip(setups, SHORT, strict=True)])


def run(page: Page) -> None:
    """Fill the page."""
    if page.short:
        run_short(page)
        return
    found: dict[str, Measured] = {}
    lines = []
    for name in page.each(list(HARDENING)):
        found[name], line, _ = u_bend(page, Setup(intervals=INTERVALS, material=HARDENING[name]), name)
        lines.append(Curve(name, line[:, 0], line[:, 1]))
    names = [part.name for part in fields(Measured)]
    columns = ("hardening", "force, N/mm", "draw-in, mm", "theta1", "theta2", "radius of the wall, mm")
    rows = [(label, *(getattr(value, name) for name in names)) for label, value in found.items()]
    page.table("Quantities of the benchmark", columns, rows)
    page.figure("part", plot(lines, "x, mm", "z, mm"), "Mid-surface of the part after the release")
    forces = [value.force for value in found.values()]
    compare_forces(page, forces)
    radius = {name: value.radius for name, value in found.items()}
    constant, falling = radius["Yoshida-Uemori"], radius["Yoshida-Uemori, falling modulus"]
    page.at_most("radius of the wall with a falling modulus over that with a constant one", falling / constant, 1.0)
    page.text(
        f"The laws describe one steel: their forces differ by {100 * (max(forces) / min(forces) - 1):.0f} %. Over the "
        "die radius the wall is bent and straightened again: "
        f"the radius to which it curls is {radius['isotropic']:.0f} mm with isotropic hardening, "
        f"{radius['Chaboche']:.0f} mm with Chaboche, {constant:.0f} mm with Yoshida-Uemori, and {falling:.0f} mm if "
        "the modulus falls. The effect of the law is many times that of the mesh "
        "([budget](friction-u-bend.md))."
    )


CASE = Case(
    name="material-u-bend",
    title="NUMISHEET 93: U-bend with each kind of hardening",
    problem=f"""
The [U-bend](friction-u-bend.md) with the steel SPCC of the [page of bending](material-bending.md): sheet of
{THICKNESS:g} mm, holder {HOLDER:g} N per mm of width on each half, mu = {MU:g}, stroke {STROKE:g}; {INTERVALS} elements
of BEND8 along half of the blank. Isotropic hardening, Chaboche, Yoshida-Uemori, and the last with a modulus that falls
from 206 to 152 GPa.
""",
    reference="""
No measured angles or radii can be quoted, and the steels of the benchmark have no published constants
of these laws: the table compares laws. Checks: the forces agree, and a falling modulus increases the curl of the wall.
Each law is checked against integration through the thickness in [bending](material-bending.md).
""",
    own="all of it: the laws are compared with each other",
    run=run,
    cost=150.0,
)

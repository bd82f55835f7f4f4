"""Air bend of two sheets on each other, in the elastic part."""

from __future__ import annotations

import numpy as np

import umform as uf
from umform.analysis.steps import Move
from umform.surfaces import Cylinder
from umform_book.case import Case
from umform_book.contact.hertz_line import EIGHT
from umform_book.page import Page

E, LENGTH, WIDTH, THICKNESS = 210e3, 30.0, 5.0, 1.0
#: Distance of the support from the punch, its radius, stroke.
ARM, RADIUS, STROKE = 20.0, 5.0, 0.05
FIRST = 30


def beam(layers: int) -> float:
    """Force of the punch on half of the sheet: one of two thicknesses, or two that slide on each other."""
    height = 2.0 * THICKNESS / layers
    bending = ARM**3 / (3.0 * E * layers * WIDTH * height**3 / 12.0)
    shear = ARM / (5.0 / 6.0 * 0.5 * E * 2.0 * THICKNESS * WIDTH)
    return STROKE / (bending + shear)


def bend(page: Page, second: int, rule: dict[str, int]) -> float:
    """Force of the punch; one sheet of two layers of elements if there is no second one."""
    lift = np.array([0.0, 0.0, 0.5 * THICKNESS])
    if second == 0:
        mesh = uf.mesh.strip(LENGTH, WIDTH, 2.0 * THICKNESS, (FIRST, 1), layers=2).moved(2.0 * lift)
        sheets, below, above = [""], "lower", "x0_upper"
    else:
        lower = uf.mesh.strip(LENGTH, WIDTH, THICKNESS, (FIRST, 1)).moved(lift)
        upper = uf.mesh.strip(LENGTH, WIDTH, THICKNESS, (second, 1)).moved(3.0 * lift)
        mesh = uf.mesh.together(a=lower, b=upper)
        sheets, below, above = [" of a", " of b"], "lower of a", "x0_upper of b"
    model = uf.Model(mesh, EIGHT.element, material=uf.SVK(E=E, nu=0.0))
    for sheet in sheets:
        model.symmetry(f"x0{sheet}", "x")
        model.symmetry(f"y0{sheet}", "y")
    if second:
        model.sheet_contact("upper of a", "lower of b", name="sheets", **rule)
    model.contact(below, Cylinder((ARM, 0.0, -RADIUS), "y", RADIUS), name="support", points=4)
    punch = model.prescribe(above, "z", "punch")
    result = page.solve(f"{FIRST} and {second} elements, {rule}", model, Move(punch, -STROKE, steps=4))
    return -float(result["punch_force"][-1])


def run(page: Page) -> None:
    """One sheet of 2, two of 1, with meshes that match and do not."""
    single = bend(page, 0, {})
    page.check("one sheet: force", single, beam(1), 0.01)
    rows: list[tuple[str, str, float, float]] = [("one sheet", "-", single / beam(1), 1.0)]
    for second in (FIRST, 50):
        for rule in ({"points": 2}, {"cells": 3}):
            what, count = next(iter(rule.items()))
            force = bend(page, second, rule)
            label = f"two sheets, {FIRST} on {second} elements"
            rows.append((label, f"{count} {what}", force / beam(2), force / single))
            page.check(f"{label}, {count} {what}: force", force, beam(2), 0.01)
            page.check(f"{label}, {count} {what}: over one sheet", force / single, beam(2) / beam(1), 0.005)
    page.table("Force of the punch", ("sheets", "rule", "over the beam", "over one sheet"), rows)


CASE = Case(
    name="touch-air-bend",
    title="Air bend of two sheets",
    problem="Half of a strip, 30 x 5, lies on a round support of radius 5 at a distance of 20 from the punch, "
    "which goes down by 0.05: one sheet of the thickness 2, and two of 1 without friction. E = 210000, no "
    "lateral contraction. Contact with the tool and between the sheets in one run.",
    reference="Timoshenko's beam on two supports. The contact moves on the round support by 0.02, which "
    "shortens the arm by 0.1 % and adds 0.3 % to the force.",
    run=run,
)

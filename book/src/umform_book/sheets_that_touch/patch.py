"""A uniform pressure between two plates whose meshes do not match, in tilted axes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import umform as uf
from umform.analysis.steps import Move
from umform_book.case import Case
from umform_book.contact.hertz_line import EIGHT, EIGHTEEN
from umform_book.page import Page
from umform_book.variants import Variant

Floats = NDArray[np.float64]

E, PRESSURE = 210e3, 100.0
#: Rotations about y and x, in radians.
ANGLES = (0.35, 0.25)
FIRST, SECOND = (6, 3), (10, 5)


@dataclass(frozen=True)
class Found:
    """Largest deviations from the uniform state, relative: contact pressure, displacement of the faces, exchange."""

    pressure: float
    way: float


def rotation() -> Floats:
    """The axes of the plates, in rows."""
    (a, b), (c, d) = np.cos(ANGLES), np.sin(ANGLES)
    about_y, about_x = np.array([[a, 0, c], [0, 1, 0], [-c, 0, a]]), np.array([[1, 0, 0], [0, b, -d], [0, d, b]])
    axes: Floats = (about_y @ about_x).T
    return axes


def plates(
    page: Page, variant: Variant, second: tuple[int, int], rule: dict[str, int], *, turned: bool = False
) -> tuple[uf.Model, Found]:
    """Press the plates onto each other by a traction."""
    element, axes = variant.element, rotation()
    lower = uf.mesh.strip(6.0, 3.0, 1.0, FIRST, cell=element.cell)
    upper = uf.mesh.strip(6.0, 3.0, 1.0, second, cell=element.cell).moved((0.0, 0.0, 1.0))
    mesh = uf.mesh.together(a=lower, b=upper).transformed(lambda X: X @ axes)
    model = uf.Model(mesh, element, material=uf.SVK(E=E, nu=0.0))
    sides = ("lower of b", "upper of a") if turned else ("upper of a", "lower of b")
    contact = model.sheet_contact(*sides, name="plates", **rule)
    model.fix("lower of a", normals=axes[2])
    for sheet in "ab":
        model.fix(f"x0 of {sheet}", normals=axes[0])
        model.fix(f"y0 of {sheet}", normals=axes[1])
    load = model.traction("upper of b", tuple(-PRESSURE * axes[2]), "load")
    name = ", ".join(f"{value} {what}" for what, value in rule.items())
    page.solve(f"{variant.label}, {FIRST} on {second}, {name}", model, Move(load, 1.0, steps=1))
    pressure = np.concatenate([side.pressure for side in contact.found.sides])
    along = model.u.reshape(-1, 3) @ axes[2]
    faces = [along[mesh.nodes(face)] for face in ("upper of a", "lower of b")]
    way = max(float(np.abs(face / face.mean() - 1.0).max()) for face in faces)
    return model, Found(float(np.abs(pressure / PRESSURE - 1.0).max()), way)


def run(page: Page) -> None:
    """Matching and other meshes, points and cells, both elements; the sides exchanged."""
    rows = []
    for variant, rule in ((EIGHT, {"points": 2}), (EIGHT, {"cells": 3}), (EIGHTEEN, {"points": 3})):
        found = plates(page, variant, FIRST, rule)[1]
        what, count = next(iter(rule.items()))
        page.at_most(f"{variant.label}, meshes that match, {count} {what}: pressure", found.pressure, 1e-10)
    for variant, rules in (
        (EIGHT, ({"points": 2}, {"points": 4}, {"cells": 3}, {"cells": 6}, {"cells": 14})),
        (EIGHTEEN, ({"points": 4}, {"cells": 6}, {"cells": 14})),
    ):
        for rule in page.pick(rules, rules[:-1]):
            what, count = next(iter(rule.items()))
            found = plates(page, variant, SECOND, rule)[1]
            rows.append((variant.label, f"{count} x {count} {what}", found.pressure, found.way))
            if what == "cells":
                page.at_most(f"{variant.label}, {count} cells: pressure", found.pressure, 1e-3)
    page.table(
        f"Meshes {FIRST[0]} x {FIRST[1]} on {SECOND[0]} x {SECOND[1]}: largest deviations, relative",
        ("element", "rule", "pressure at a point", "displacement of a node of the faces"),
        rows,
    )
    one, other = (plates(page, EIGHT, SECOND, {"cells": 3}, turned=turned)[0].u for turned in (False, True))
    page.at_most("sides exchanged: displacement", float(np.abs(one - other).max() / np.abs(one).max()), 1e-10)
    page.text(
        "Each plate integrates its own half of the pressure exactly. The other half acts at the feet of the "
        "points of the other plate: a quadrature that does not see the edges of the facets. Only that part "
        "is wrong, and more points or cells reduce it. Gauss points of too low order leave a residual of "
        "some per cent."
    )


CASE = Case(
    name="touch-patch",
    title="Pressure between plates whose meshes do not match",
    problem="Two plates of 6 x 3 x 1 lie on each other, tilted about two axes. A traction of 100 presses them "
    "onto a flat support. E = 210000, no lateral contraction, no friction; default penalty.",
    reference="Equilibrium: the contact pressure is 100 everywhere. It must be met to 1e-10 on meshes that match, "
    "and to 1e-3 by cells on meshes of 1 : 1.7. The sides may be exchanged to 1e-10.",
    run=run,
)

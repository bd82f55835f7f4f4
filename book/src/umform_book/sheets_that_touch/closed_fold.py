"""A fold that is pressed flat between two plates until its flanges lie on each other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import umform as uf
from umform.analysis.steps import Move
from umform.mesh import Mesh
from umform.surfaces import Plane
from umform_book.case import Case
from umform_book.contact.hertz_line import EIGHT
from umform_book.page import Page

Floats = NDArray[np.float64]

FLANGE, SHORTER, RADIUS, THICKNESS = 8.0, 3.0, 1.3, 1.0
#: Distance of the plates at the end, in thicknesses.
CLOSED = 2.05


@dataclass(frozen=True)
class Folded:
    """Largest penetration, outermost point, forces of plate and base, points in contact, energy left over."""

    penetration: float
    outermost: float
    plate: float
    base: float
    touching: int
    drift: float


def fold(elements: int, layers: int) -> Mesh:
    """A strip that is bent by half a turn, with its upper face inside and one flange shorter than the other."""
    length = 2.0 * FLANGE - SHORTER + np.pi * RADIUS

    def bent(X: Floats) -> Floats:
        s, y, z = X.T
        angle, beyond = np.clip((s - FLANGE) / RADIUS, 0.0, np.pi), s - FLANGE - np.pi * RADIUS
        around = FLANGE + (RADIUS - z) * np.sin(angle)
        x = np.where(s < FLANGE, s, np.where(beyond > 0.0, FLANGE - beyond, around))
        above = np.where(beyond > 0.0, 2.0 * RADIUS - z, RADIUS - (RADIUS - z) * np.cos(angle))
        return np.column_stack([x, y, np.where(s < FLANGE, z, above)])

    return uf.mesh.strip(length, 1.0, THICKNESS, (elements, 1), layers=layers).transformed(bent)


def close(page: Page, elements: int, layers: int, rule: dict[str, int], *, picture: bool = False) -> Folded:
    """Press the fold flat."""
    mesh = fold(elements, layers)
    steel = uf.J2(E=210e3, nu=0.3, hardening=uf.Swift(560.0, 0.005, 0.22))
    model = uf.Model(mesh, EIGHT.name, material=steel, plane_strain=True)
    model.fix("x0", "x")
    model.fix(np.arange(len(mesh.points)), "y")
    model.contact("lower", Plane((0.0, 0.0, -0.5 * THICKNESS), (0.0, 0.0, 1.0)), name="base")
    top = 2.0 * RADIUS + 0.5 * THICKNESS
    plate = model.contact("lower", Plane((0.0, 0.0, top), (0.0, 0.0, -1.0)), name="plate")
    inside = model.self_contact("upper", name="inside", **rule)
    down = model.drive(plate, "-z", name="down")
    label = f"{elements} elements, {layers} layers, {rule}"
    way = top + 0.5 * THICKNESS - CLOSED * THICKNESS
    result = page.solve(label, model, Move(down, way, steps=40), frames=2 if picture else 0)
    if picture:
        page.shape("closed", result, "The closed fold", values="plastic_strain_mean", view=(-90.0, 0.0))
    return Folded(
        float(result["inside_penetration"].max()),
        float(mesh.displaced(model.u)[:, 0].max()),
        float(result["plate_fz"][-1]),
        float(result["base_fz"][-1]),
        int(inside.found.active.sum()),
        abs(float(result.balance().drift[-1])),
    )


def run(page: Page) -> None:
    """Points and cells, one and two layers, two meshes."""
    rows = []
    tried = [(60, 1, {"points": 2}), (60, 1, {"cells": 3}), (60, 2, {"cells": 3}), (120, 2, {"cells": 3})]
    for elements, layers, rule in page.pick(tried, tried[1:2]):
        what, count = next(iter(rule.items()))
        found = close(page, elements, layers, rule, picture=(elements, layers) == (60, 2))
        label = f"{elements} elements, {layers} layers, {count} {what}"
        rows.append((label, found.touching, found.penetration, found.outermost, found.plate, found.drift))
        page.at_most(f"{label}: penetration in thicknesses", found.penetration / THICKNESS, 0.005)
        page.check(f"{label}: force of the base over that of the plate", -found.base / found.plate, 1.0, 1e-6)
        page.at_most(f"{label}: work and energies, relative", found.drift, 0.01)
    columns = ("mesh, rule", "points that touch", "penetration", "outermost point", "force of the plate", "drift")
    page.table("Closed fold", columns, rows)
    page.text(
        "The outermost point, and with it the roll-in of a hem, has not converged on these meshes: it moves by "
        "0.06 from 60 to 120 elements. The loop that stays at the fold has an inside radius of about a quarter of the "
        "thickness: elements of 0.28 are longer than it."
    )


CASE = Case(
    name="touch-closed-fold",
    title="A fold pressed flat",
    problem="A strip of thickness 1, bent by half a turn about a mean radius of 1.3, is pressed flat between two "
    "plates to a height of 2.05, in plane strain. Steel, hardening of Swift. The inner face touches itself; the "
    "outer face touches the plates.",
    reference="Bounds: no penetration above 0.5 % of the thickness, equal forces on both plates, and energies that "
    "balance to 1 %. There is no reference for the shape.",
    run=run,
    cost=20.0,
    picture="closed",
)

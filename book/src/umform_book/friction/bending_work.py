"""Strip drawn over a radius: work of friction, bending and unbending; Swift's sum and the balance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from umform import mesh
from umform.analysis.run import Result
from umform.analysis.steps import Move
from umform.materials import J2, Linear
from umform.model import Model
from umform.surfaces import Cylinder
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.page import Page
from umform_book.variants import Variant

YIELD, HARDENING, E, NU = 200.0, 100.0, 2e5, 0.3
THICKNESS, RADIUS, TENSION = 0.8, 8.0, 50.0
#: The strip in front of the edge and behind it; how far it is drawn, and the last part, which is measured.
BEFORE, BEHIND, TRAVEL, MEASURED = 10.0, 44.0, 20.0, 6.0
ELEMENT = Variant("BEND8")


@dataclass(frozen=True)
class Drawn:
    """Numbers of the last part of the path, forces per width.

    Attributes
    ----------
    force : float
        Mean of the force that draws.
    weight : float
        Work against the weight over the way of the drawn end; the strip gets longer as it is bent under tension.
    friction, plastic : float
        Work of friction and of plastic flow, the same.
    missing : float
        Work of the force minus the work against the weight and all energies, over the first.
    swing : float
        Largest minus smallest force over the mean.
    """

    force: float
    weight: float
    friction: float
    plastic: float
    missing: float
    swing: float


def draw(page: Page, mu: float, divisions: int, increments: int) -> Result:
    """Apply the tension at one end, draw the other away from the edge."""
    length = BEFORE + BEHIND
    strip = mesh.strip(length, 1.0, THICKNESS, (divisions, 1), cell=ELEMENT.cell)
    strip = strip.transformed(lambda X: X - np.array([BEFORE, 0.0, 0.0]))
    model = Model(strip, ELEMENT.element, material=J2(E=E, nu=NU, hardening=Linear(YIELD, HARDENING)))
    model.fix(np.arange(len(strip.points)), "y")
    model.prescribe("x0", "z", "level")
    pull = model.prescribe("x0", "x", "pull")
    edge = Cylinder((0.0, 0.0, 0.01 - RADIUS - 0.5 * THICKNESS), "y", RADIUS)
    model.contact("lower", edge, points=3, friction=mu or None, name="edge")
    load = model.traction("x1", (0.0, 0.0, -1.0 / THICKNESS), "tension")
    steps = [Move(load, lambda f: TENSION * f**2, steps=40), Move(pull, -TRAVEL, steps=increments)]
    return page.solve(f"mu = {mu:g}, {divisions} intervals, {increments} increments", model, steps)


def measure(result: Result) -> Drawn:
    """Work per length of the last part."""
    last = np.flatnonzero((result["step"] > 1) & (-result["pull"] > TRAVEL - MEASURED - 1e-9))
    way = -result["pull"][last]
    force = -result["pull_force"][last]
    span = way[-1] - way[0]

    def gain(column: str) -> float:
        values = result[column][last]
        return float(values[-1] - values[0])

    done = float(np.trapezoid(force, way))
    stored = sum(gain(name) for name in ("elastic_energy", "plastic_work", "contact_energy", "friction_work"))
    lifted = done - gain("external_work")  # against the weight and the support of the level
    return Drawn(
        force=float(done / span),
        weight=float(lifted / span),
        friction=float(gain("friction_work") / span),
        plastic=float(gain("plastic_work") / span),
        missing=(done - lifted - stored) / done,
        swing=float(np.ptp(force) * span / done),
    )


def swift_sum(mu: float) -> float:
    """F2 = exp(mu theta) (F1 + M/r) + M/r for a rigid-plastic strip; M under its tension, in plane strain."""
    plane, r = 2.0 / np.sqrt(3.0) * YIELD, RADIUS + 0.5 * THICKNESS
    tension = TENSION
    bending = plane * THICKNESS**2 / 4.0 * (1.0 - (tension / (plane * THICKNESS)) ** 2) / r
    pulled = np.exp(mu * 0.5 * np.pi * RADIUS / r) * (tension + bending)
    return float(pulled + plane * THICKNESS**2 / 4.0 * (1.0 - (pulled / (plane * THICKNESS)) ** 2) / r)


def run(page: Page) -> None:
    """Fill the page."""
    whole = ((0.0, 54, 100), (0.1, 36, 100), (0.1, 54, 100), (0.1, 72, 100), (0.1, 54, 200), (0.2, 54, 100))
    rows: list[tuple[str | float | int, ...]] = []
    curves = []
    for mu, divisions, increments in page.each(page.pick(whole, whole[1:2]), str):
        result = draw(page, mu, divisions, increments)
        found, exact = measure(result), swift_sum(mu)
        label = f"mu = {mu:g}, {divisions} intervals, {increments} increments"
        parts = found.friction + found.plastic
        rows.append(
            (label, found.force, found.force / exact, found.weight, found.friction, found.plastic, 100 * found.swing)
        )
        drawn = result["step"] > 1
        curves.append(Curve(label, -result["pull"][drawn], -result["pull_force"][drawn]))
        page.check(f"{label}: force over the sum of Swift", found.force, exact, 0.02)
        page.check(f"{label}: force minus weight, against friction and flow", found.force - found.weight, parts, 0.01)
        page.at_most(f"{label}: error of the balance over the work of the force", abs(found.missing), 1e-3)
    columns = ("", "force", "over the sum", "weight", "friction", "flow", "swing %")
    page.table("Mean force over the last part of the path, and the work per length that it does", columns, rows)
    page.figure("force", plot(curves, "way", "force", level=swift_sum(0.1)), "Force; level: the sum for mu = 0.1")


CASE = Case(
    name="friction-bending-work",
    title="Strip drawn over a radius: friction, bending and unbending",
    problem=f"""
A strip of h = {THICKNESS:g}, width 1, E = {E:g}, nu = {NU:g}, yield stress {YIELD:g}, hardening {HARDENING:g}, u_y = 0,
lies on a cylinder of R = {RADIUS:g}. A weight of {TENSION:g} at one end wraps it by 90 degrees; the other end is drawn
away by {TRAVEL:g}, in 100 or 200 increments. {ELEMENT.name}, 3 x 3 contact points, default penetration and elastic
slip. Measured on the last {MEASURED:g}, a whole number of elements.
""",
    reference="""
After Swift: F2 = exp(mu theta) (F1 + M/r) + M/r for a rigid-plastic strip that is bent as it runs onto the radius and
straightened as it leaves; M = (2/sqrt 3) Y h^2/4 (1 - (sigma/(2/sqrt 3) Y)^2) under the tension there, friction at R, r
= R + h/2. Elastic strains lower the bending work by 1 to 2 %, hardening raises it by 1 %; bending is a seventh of the
force, so the uncertainty is below 1 %. By energy, averaged over an element: the force minus the work against the
weight, per length, equals the work of friction and flow within 1 %.
""",
    run=run,
    cost=60.0,
)

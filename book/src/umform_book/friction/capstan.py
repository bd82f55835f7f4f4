"""Strip around a cylinder that turns: T2/T1 = exp(mu theta), in the thin limit and for thick strips."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform import mesh
from umform.analysis.run import Result
from umform.analysis.steps import Move
from umform.materials import SVK
from umform.mesh import Mesh
from umform.model import Model
from umform.surfaces import Cylinder
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot, rule_name
from umform_book.contact.hertz_line import EIGHT, EIGHTEEN, least_rule
from umform_book.friction.drawn import by_weight
from umform_book.page import Page
from umform_book.variants import Variant

Floats = NDArray[np.float64]

RADIUS, WIDTH, E = 10.0, 1.0, 1e5
#: Thicknesses of the strips, and that of the membrane.
THIN, THICK = 0.02, (0.1, 0.2, 0.5)
TENSION, PENALTY, TURN = 1.0, 100.0, 0.02


@dataclass(frozen=True)
class Strip:
    """A strip wrapped over an angle.

    Attributes
    ----------
    thickness : float
        Its thickness.
    angle : float
        Of the wrap.
    mu : float
        Coefficient of friction.
    against : float
        1 where the cylinder turns against the dead tension, -1 where it turns with it.
    """

    thickness: float
    angle: float
    mu: float
    against: float = 1.0

    @property
    def middle(self) -> float:
        """Radius of the mid-surface."""
        return RADIUS + 0.5 * self.thickness

    @property
    def ratio(self) -> float:
        """T2 / T1 with both tensions at the mid-surface and friction at the lower face."""
        return float(np.exp(self.against * self.mu * self.angle * RADIUS / self.middle))


def wrapped(strip: Strip, divisions: int, variant: Variant) -> Mesh:
    """The strip on the cylinder, unstressed; from the top, where it is held."""

    def around(X: Floats) -> Floats:
        angle, r = strip.angle * X[:, 0], strip.middle + X[:, 2]
        return np.column_stack([r * np.sin(angle), X[:, 1], r * np.cos(angle)])

    flat = mesh.strip(1.0, WIDTH, strip.thickness, (variant.cells(divisions), 1), cell=variant.cell)
    return flat.transformed(around)


def turn(page: Page, strip: Strip, variant: Variant, divisions: int, points: int | str) -> Result:
    """Apply the tension at one end, hold the other, turn the cylinder until all points slip."""
    model = Model(wrapped(strip, divisions, variant), variant.element, material=SVK(E=E, nu=0.0))
    model.fix(np.arange(len(model.mesh.points)), "y")
    model.prescribe("x0", "x", "hold")
    cylinder = model.tool("cylinder", Cylinder((0, 0, 0), "y", RADIUS))
    model.contact("lower", cylinder, penalty=PENALTY, points=points, friction=strip.mu, slip=1e-4, name="tool")
    along = np.array([np.cos(strip.angle), 0.0, -np.sin(strip.angle)])
    load = model.traction("x1", along / (WIDTH * strip.thickness), "tension")
    spin = model.turn(cylinder, "y", name="spin")  # towards the dead tension
    label = f"h = {strip.thickness:g}, {np.degrees(strip.angle):.0f} degrees, mu = {strip.mu:g}, {variant.label}, "
    label += f"{divisions} intervals, {rule_name(points)}" + ("" if strip.against > 0 else ", turned with the tension")
    return page.solve(label, model, [Move(load, TENSION, steps=1), Move(spin, strip.against * TURN, steps=10)])


@dataclass(frozen=True)
class Found:
    """Ratio of the tensions, deviation of the moment on the cylinder from mu R N, the part of the points that slips."""

    ratio: float
    moment: float
    slipping: float


def measure(strip: Strip, result: Result) -> Found:
    """The last state."""
    contact = result.model.contacts[0]
    at = contact.at_points()
    arm = float((at.pressure * at.area) @ (RADIUS + at.gap))
    moment = float(result["cylinder_my"][-1])
    return Found(
        ratio=abs(float(result["hold_force"][-1])) / TENSION,
        moment=abs(abs(moment) / (strip.mu * arm) - 1.0),
        slipping=float(result["tool_slipping"][-1] / result["tool_active"][-1]),
    )


def thin(page: Page) -> None:
    """The membrane: angles, coefficients, elements, meshes."""
    strips = [Strip(THIN, np.pi / 2, 0.1), Strip(THIN, np.pi, 0.3), Strip(THIN, np.pi, 0.3, -1.0)]
    rows: list[tuple[str | float | int, ...]] = []
    curves = []
    for strip in page.pick(strips, strips[1:2]):
        for variant in (EIGHT, EIGHTEEN):
            rules: tuple[int | str, ...] = ("nodes", least_rule(variant))
            for points in page.pick(rules, rules[1:]):
                errors = []
                for divisions in page.pick((32, 64, 128), (64,)):
                    found = measure(strip, turn(page, strip, variant, divisions, points))
                    errors.append(abs(found.ratio / strip.ratio - 1.0))
                    name = f"{np.degrees(strip.angle):.0f} degrees, mu = {strip.against * strip.mu:g}"
                    label = f"{name}, {variant.label}, {rule_name(points)}"
                    plain = float(np.exp(strip.against * strip.mu * strip.angle))
                    over = found.ratio / strip.ratio
                    rows.append((label, divisions, found.ratio, found.ratio / plain, over, found.slipping))
                page.check(f"{label}, {divisions} intervals: T2/T1", found.ratio, strip.ratio, 0.001)
                if strip.against > 0 and strip.mu == 0.3:
                    curves.append(
                        Curve(f"{variant.name}, {rule_name(points)}", (32, 64, 128)[-len(errors) :], errors, "o-")
                    )
    columns = ("", "intervals", "T2/T1", "over exp(mu theta)", "over exp(mu theta R/(R + h/2))", "part that slips")
    page.table(f"Thin strip, h/R = {THIN / RADIUS:g}", columns, rows)
    axes = ("intervals over the half ring", "error of T2/T1")
    page.figure(
        "mesh", plot(curves, *axes, log="xy"), "Ratio of the tensions, half ring, mu = 0.3: error over the mesh"
    )


def thick(page: Page) -> None:
    """Thick strips: friction acts at the lower face, the tension at the mid-surface."""
    rows: list[tuple[str | float | int, ...]] = []
    for h in page.pick(THICK, THICK[1:2]):
        strip = Strip(h, np.pi, 0.3)
        for divisions in page.pick((32, 64, 128), (64,)):
            found = measure(strip, turn(page, strip, EIGHTEEN, divisions, 3))
            over = found.ratio / strip.ratio
            rows.append((f"h/R = {h / RADIUS:g}", divisions, found.ratio, found.ratio / np.exp(0.3 * np.pi), over))
        # The friction at the lower face needs the shear force mu p h / 2, which free ends do not have.
        within = max(0.001, strip.mu**2 * h / (2.0 * RADIUS))
        page.check(f"h/R = {h / RADIUS:g}, {divisions} intervals: T2/T1", found.ratio, strip.ratio, within)
        page.at_most(f"h/R = {h / RADIUS:g}: moment on the cylinder over mu R N, less 1", found.moment, 1e-9)
    columns = ("", "intervals", "T2/T1", "over exp(mu theta)", "over exp(mu theta R/(R + h/2))")
    page.table(f"Thick strips that have been made round: half ring, mu = 0.3, {EIGHTEEN.label}, 3 x 3", columns, rows)


def run(page: Page) -> None:
    """Fill the page."""
    thin(page)
    thick(page)
    page.heading("What bending adds")
    page.text(
        "Elastic bending of a flat strip dissipates nothing. But the strip leaves the edge earlier, by "
        "arccos(1 - EI/2Fr^2) at each side, has a line force there, and friction acts h/2 below its mid-surface. With "
        "all three in the closed form, the force is slightly below exp(mu theta) times the weight."
    )
    by_weight(page)


CASE = Case(
    name="friction-capstan",
    title="Capstan: strip around a cylinder",
    problem=f"""
* Round strips: unstressed on a rigid cylinder, R = {RADIUS:g}, {WIDTH:g} wide, E = {E:g}, nu = 0, u_y = 0; one end is
  held, a dead tension of {TENSION:g} acts at the other; the cylinder turns by {TURN:g} until all points slip. Penalty
  {PENALTY:g}, allowed elastic slip 1e-4. T2/T1: force at the held end over the tension.
* Flat strips: [drawn over an edge](contact-rolling-edge.md) with friction: h = 0.1, a weight at one end, the other
  drawn by 4; measured on the last 2, a whole number of elements.
""",
    reference="""
Thin: Euler, T2/T1 = exp(mu theta), within 0.1 %. Thick: tension at R + h/2, friction at R: exp(mu theta R/(R + h/2)),
0.09 % less for the thin strip; at free ends the shear force mu p h/2 is missing, mu^2 h/2R of the ratio. Flat: closed
form without stretching and shear, with friction on the arc, line forces with friction at its ends, and elasticas
beyond; checked by the identity F2 - F1 = friction times R/r.
""",
    run=run,
    cost=60.0,
)

"""Cattaneo and Mindlin: a cylinder pressed on a block and pushed along it; stick in the middle, slip at the rims."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform import mesh
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.steps import Move
from umform.materials import SVK
from umform.model import Model
from umform.surfaces import Cylinder
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.contact.half_space import growing
from umform_book.contact.hertz_line import EIGHT, least_rule
from umform_book.friction.tractions import pushed
from umform_book.page import Page
from umform_book.variants import Variant

Floats = NDArray[np.float64]

E, MU, RADIUS, DEPTH, END, GROWTH = 1000.0, 0.2, 200.0, 0.0115, 40.0, 1.35
#: The closed form needs a body of nu = 1/2 against a rigid tool; the other value shows the effect of coupling.
NEARLY_HALF, USUAL = 0.49, 0.3
#: Elastic slip that is allowed, a five-hundredth of the way of the tool.
WAY, SLIP = 0.0035, 5e-6
#: Part of the bound between which the stick zone is compared; below, the slip at each rim is narrower than half an
#: element of the coarsest mesh.
FROM, TO = 0.25, 0.95
#: Errors expected by intervals over the half-width.
EXPECTED = {4: 0.1, 8: 0.04, 16: 0.02}


@dataclass(frozen=True)
class Found:
    """One increment of the push.

    Attributes
    ----------
    part : float
        Q / (mu P).
    width : float
        Half-width a from the second moment of the pressure, over that of Hertz.
    stick : float
        Half-width c of the stick zone from the second moment of the traction, over a.
    x, q : ndarray
        Places and tangential tractions over mu p0.
    """

    part: float
    width: float
    stick: float
    x: Floats
    q: Floats


def push(page: Page, variant: Variant, divisions: int, nu: float) -> list[Found]:
    """Press the cylinder in, push it along the block, and measure in every increment."""
    size = 1.0 / variant.cells(divisions)
    half = growing(size, 1.5 if size < 0.5 else 2.0, END, GROWTH)
    across, depth = np.concatenate([-half[:0:-1], half]), -growing(size, 1.0, END, GROWTH)[::-1]
    body = mesh.grid(across, [0.0, 1.0], depth, variant.cell)
    model = Model(body, variant.element, material=SVK(E=E, nu=nu))
    model.fix(np.arange(len(body.points)), "y")
    model.fix("lower", "xz")
    tool = model.tool("tool", Cylinder((0.0, 0.0, RADIUS), "y", RADIUS))
    stiff = 100.0 * E / (1.0 - nu**2)
    points = least_rule(variant)
    contact = model.contact("upper", tool, penalty=stiff, points=points, friction=MU, slip=SLIP, name="foot")
    press, along = model.drive(tool, "-z", "press"), model.drive(tool, "x", "along")
    options = NewtonOptions(residual=1e-7)  # round-off of positions on a tool of this radius times a stiff penalty
    label = f"nu = {nu:g}, {variant.label}, {divisions} intervals"
    page.solve(f"{label}: pressed", model, Move(press, lambda f: DEPTH * f**2, steps=7), options=options)
    states = []
    for at in pushed(model, contact, along, np.linspace(0.0, WAY, page.pick((15,), (8,))[0])[1:], 1, options):
        hertz = np.sqrt(4.0 * at.normal_force * RADIUS * (1.0 - nu**2) / (np.pi * E))
        a = np.sqrt(4.0 * at.spread(at.p))
        stick = np.sqrt(max(4.0 * at.spread(at.q) - a * a, 0.0)) / a
        over = np.abs(at.q) / (MU * 2.0 * at.normal_force / (np.pi * a))
        states.append(Found(at.part(MU), a / hertz, stick, at.x[:, 0] / a, over))
    return states


def run(page: Page) -> None:
    """Fill the page."""
    rows: list[tuple[str | float | int, ...]] = []
    curves, parts = [], np.linspace(0.0, 1.0, 101)
    for nu, meshes in ((NEARLY_HALF, page.pick((4, 8, 16), (4,))), (USUAL, page.pick((8,), ()))):
        for divisions in page.each(meshes, lambda n: f"{n} intervals"):
            states = push(page, EIGHT, divisions, nu)
            label = f"nu = {nu:g}, {divisions} intervals"
            compared = [state for state in states if FROM < state.part < TO]
            worst = max(abs(state.stick / np.sqrt(1.0 - state.part) - 1.0) for state in compared)
            middle = min(states, key=lambda state: abs(state.part - 0.5))
            rows.append((label, middle.width, middle.part, middle.stick, float(np.sqrt(1.0 - middle.part)), worst))
            curves.append(Curve(label, [s.part for s in states], [s.stick for s in states], "o" if nu > 0.4 else "x"))
            if nu == NEARLY_HALF:
                page.check(f"{label}: half-width of the contact over Hertz", middle.width, 1.0, EXPECTED[divisions])
                what = f"{label}: stick zone over closed form - 1, {FROM:g} < Q/(mu P) < {TO:g}"
                page.at_most(what, worst, EXPECTED[divisions])
                last = middle
    columns = ("", "a over Hertz", "Q/(mu P)", "c/a", "closed form", "largest error of c on the way")
    page.table("Half-widths of the contact and of the stick zone, near Q/(mu P) = 1/2", columns, rows)
    curves.append(Curve("sqrt(1 - Q/(mu P))", parts, np.sqrt(1.0 - parts), "k-"))
    page.figure("stick", plot(curves, "Q over mu P", "half-width of the stick zone over a"), "Stick zone while Q grows")
    x = np.linspace(-1.0, 1.0, 401)
    c = np.sqrt(1.0 - last.part)
    exact = np.sqrt(1.0 - x**2) - c * np.sqrt(np.maximum(1.0 - (x / c) ** 2, 0.0))
    order = np.argsort(last.x)
    tractions = [Curve("found", last.x[order], last.q[order], "."), Curve("closed form", x, exact, "k-")]
    caption = f"Tangential traction at Q/(mu P) = {last.part:.2f}, nu = {NEARLY_HALF:g}, the finest mesh"
    page.figure("traction", plot(tractions, "x over a", "traction over mu p0"), caption)
    page.text(
        "With nu = 0.3 pressure and traction are coupled: friction holds the surface, which the pressure would move "
        "inwards, and uses a part of the bound before the push. The closed form holds only for nu near 1/2."
    )


CASE = Case(
    name="friction-partial-slip",
    title="Cattaneo and Mindlin: partial slip under a cylinder",
    problem=f"""
A block, 80 wide and 40 deep, plane strain (width 1), E = {E:g}, base held. A rigid cylinder of R = {RADIUS:g}, mu =
{MU:g}, is pressed in by {DEPTH:g} (half-width a of the contact about 1) and then pushed along x by {WAY:g}. ANS3DEAS
stacked through the depth, 4, 8 or 16 intervals over the half-width, growing by {GROWTH:g} away from the contact, 2 x 2
points, penalty 100 E*/a. nu = {NEARLY_HALF:g}; on one mesh also {USUAL:g}. The half-width c of the stick zone follows
from the second moment of the traction, c^2 = 4 M/Q - a^2; a from that of the pressure, a^2 = 4 M/P.
""",
    reference="""
Cattaneo (1938), Mindlin (1949), after Johnson (1985): q = mu p0 [sqrt(1 - x^2/a^2) - (c/a) sqrt(1 - x^2/c^2)], c/a =
sqrt(1 - Q/(mu P)). It needs pressure and traction to be uncoupled: nu = 1/2 against a rigid tool, or two equal bodies.
Uncertainty: coupling (1 - 2 nu)/(2 - 2 nu) = 2 % at nu = 0.49; the penalty, about 1 %; the finite block, below 0.5 %.
""",
    run=run,
    cost=25.0,
)

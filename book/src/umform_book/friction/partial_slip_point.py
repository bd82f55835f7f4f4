"""Cattaneo and Mindlin: a sphere pressed on a block and pushed along it; a disc that sticks, a ring that slips."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from umform import mesh
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.steps import Move
from umform.materials import SVK
from umform.model import Model
from umform.surfaces import Sphere
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.contact.half_space import growing
from umform_book.contact.hertz_line import EIGHT, least_rule
from umform_book.friction.tractions import pushed
from umform_book.page import Page

Floats = NDArray[np.float64]

E, NU, MU, RADIUS, DEPTH, END, GROWTH = 1000.0, 0.49, 0.2, 100.0, 0.0105, 12.0, 1.6
#: Way of the tool along the block, and the elastic slip that is allowed, a six-hundredth of it.
WAY, SLIP = 0.0018, 3e-6
#: Part of the bound between which the stick zone is compared, as under a cylinder.
FROM, TO = 0.25, 0.95
#: Errors expected by intervals over the radius: twice those under a cylinder, for two directions.
EXPECTED = {2: 0.2, 3: 0.14, 4: 0.1}


@dataclass(frozen=True)
class Found:
    """One increment of the push.

    Attributes
    ----------
    part : float
        Q / (mu P).
    radius : float
        Radius a from the second moment of the pressure, over that of Hertz.
    stick : float
        Radius c of the stick zone from the second moment of the traction, over a.
    r, q : ndarray
        Distances from the centre over a, and tractions over mu p0.
    """

    part: float
    radius: float
    stick: float
    r: Floats
    q: Floats


def stick_of(moment: float) -> float:
    """c/a from the second moment of the traction over 2 a^2/5 Q, (1 - k^5)/(1 - k^3), which grows from 1 to 5/3."""
    if not 1.0 < moment < 5.0 / 3.0:
        return float(moment > 1.0)
    return float(brentq(lambda k: (1.0 - k**5) / (1.0 - k**3) - moment, 0.0, 1.0 - 1e-9))


def push(page: Page, divisions: int) -> list[Found]:
    """Press the sphere in, push it along the block, and measure in every increment."""
    size = 1.0 / divisions
    half = growing(size, 1.5 if size < 0.5 else 2.0, END, GROWTH)
    body = mesh.grid(np.concatenate([-half[:0:-1], half]), half, -growing(size, 1.0, END, GROWTH)[::-1], EIGHT.cell)
    model = Model(body, EIGHT.element, material=SVK(E=E, nu=NU))
    model.symmetry("y0", "y")
    model.fix("lower", "xyz")
    tool = model.tool("tool", Sphere((0.0, 0.0, RADIUS), RADIUS))
    stiff = 100.0 * E / (1.0 - NU**2)
    points = least_rule(EIGHT)
    contact = model.contact("upper", tool, penalty=stiff, points=points, friction=MU, slip=SLIP, name="foot")
    press, along = model.drive(tool, "-z", "press"), model.drive(tool, "x", "along")
    options = NewtonOptions(residual=1e-7)
    page.solve(f"{divisions} intervals: pressed", model, Move(press, lambda f: DEPTH * f**2, steps=4), options=options)
    states = []
    for at in pushed(model, contact, along, np.linspace(0.0, WAY, page.pick((11,), (6,))[0])[1:], 2, options):
        whole = 2.0 * at.normal_force  # half of the sphere is computed
        hertz = float(np.cbrt(0.75 * whole * RADIUS * (1.0 - NU**2) / E))
        a = float(np.sqrt(2.5 * at.spread(at.p)))
        stick = stick_of(at.spread(at.q) / at.spread(at.p))
        over = np.abs(at.q) / (MU * 1.5 * whole / (np.pi * a * a))
        states.append(Found(at.part(MU), a / hertz, stick, np.hypot(*at.x.T) / a, over))
    return states


def run(page: Page) -> None:
    """Fill the page."""
    rows: list[tuple[str | float | int, ...]] = []
    curves, parts = [], np.linspace(0.0, 1.0, 101)
    for divisions in page.each(page.pick((2, 3, 4), (2,)), lambda n: f"{n} intervals"):
        states = push(page, divisions)
        compared = [state for state in states if FROM < state.part < TO]
        worst = max(abs(state.stick / np.cbrt(1.0 - state.part) - 1.0) for state in compared)
        last = min(states, key=lambda state: abs(state.part - 0.5))
        rows.append((divisions, last.radius, last.part, last.stick, float(np.cbrt(1.0 - last.part)), worst))
        curves.append(Curve(f"{divisions} intervals", [s.part for s in states], [s.stick for s in states], "o"))
        page.check(f"{divisions} intervals: radius of the contact over Hertz", last.radius, 1.0, EXPECTED[divisions])
        what = f"{divisions} intervals: stick zone over closed form - 1, {FROM:g} < Q/(mu P) < {TO:g}"
        page.at_most(what, worst, EXPECTED[divisions])
    columns = ("intervals", "a over Hertz", "Q/(mu P)", "c/a", "closed form", "largest error of c on the way")
    page.table("Radii of the contact and of the stick zone, near Q/(mu P) = 1/2", columns, rows)
    curves.append(Curve("(1 - Q/(mu P))^(1/3)", parts, np.cbrt(1.0 - parts), "k-"))
    page.figure("stick", plot(curves, "Q over mu P", "radius of the stick zone over a"), "Stick zone while Q grows")
    r = np.linspace(0.0, 1.0, 201)
    c = float(np.cbrt(1.0 - last.part))
    exact = np.sqrt(1.0 - r**2) - c * np.sqrt(np.maximum(1.0 - (r / c) ** 2, 0.0))
    tractions = [Curve("found", last.r, last.q, "."), Curve("closed form", r, exact, "k-")]
    caption = f"Tangential traction over the distance from the centre at Q/(mu P) = {last.part:.2f}, the finest mesh"
    page.figure("traction", plot(tractions, "r over a", "traction over mu p0"), caption)


CASE = Case(
    name="friction-partial-slip-point",
    title="Cattaneo and Mindlin: partial slip under a sphere",
    problem=f"""
Half of a block, {2 * END:g} x {END:g} wide and {END:g} deep, y = 0 a symmetry plane, E = {E:g}, nu = {NU:g}, base held.
A rigid sphere of R = {RADIUS:g}, mu = {MU:g}, is pressed in by {DEPTH:g} (radius a of the contact about 1) and then
pushed along x by {WAY:g}. ANS3DEAS stacked through the depth, 2, 3 or 4 intervals over the radius, growing by
{GROWTH:g} away from the contact, 2 x 2 points, penalty 100 E*/a. The radius c of the stick zone follows from the second
moments of traction and pressure: ratio (1 - k^5)/(1 - k^3), k = c/a.
""",
    reference="""
Cattaneo (1938), Mindlin (1949), after Johnson (1985): q = mu p0 [sqrt(1 - r^2/a^2) - (c/a) sqrt(1 - r^2/c^2)], c/a = (1
- Q/(mu P))^(1/3), nu = 1/2 against a rigid tool. It neglects slip across the push, of the order nu/(4 - 2 nu) of that
along it, a sixth here, which changes the tractions by a few per cent. Uncertainty: coupling of 2 % at nu = 0.49; the
penalty, about 1 %; the finite block.
""",
    run=run,
    cost=40.0,
)

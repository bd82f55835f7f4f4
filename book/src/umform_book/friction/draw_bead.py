"""Draw bead of real geometry, compared with the sum of bending and friction and with the equivalent bead."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from umform import mesh
from umform.analysis.steps import Move
from umform.materials import J2, Linear
from umform.model import Model
from umform.processes.draw_bead import DrawBead
from umform.processes.draw_bead.case import build
from umform.processes.draw_bead.equivalent import width
from umform.processes.draw_bead.extrapolation import of_two
from umform.processes.draw_bead.measures import Drawn
from umform.processes.solution import drawing_options
from umform.surfaces import Plane
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.page import Page

YIELD, HARDENING = 200.0, 20.0
STEEL = J2(E=2e5, nu=0.3, hardening=Linear(YIELD, HARDENING))
THICKNESS, RADIUS, HEIGHT, EDGE = 0.8, 4.0, 4.0, 3.0
ROUNDER = (
    "the reference bends the strip to all three radii at full angles; the limit of the meshes is uncertain by some per "
    "cent, for an error of the last mesh is twice that error of the limit"
)


def bead(elements: float, friction: float) -> DrawBead:
    """The bead of the page."""
    return DrawBead(
        thickness=THICKNESS,
        material=STEEL,
        radius=RADIUS,
        height=HEIGHT,
        groove_radius=EDGE,
        friction=friction,
        elements=elements,
        newton=replace(drawing_options(), residual=1e-7, increment=1e-4),
    )


def wrapped_angle(case: DrawBead) -> float:
    """Angle that the mid-line turns on an edge of the groove; on the bead it turns by twice as much.

    The straight part touches both circles of the mid-line: reach sin t + rise cos t = r_bead + r_edge.
    """
    half = 0.5 * case.thickness
    rise = case.thickness - case.closing + case.radius + case.groove_radius
    radii = case.radius + case.groove_radius + 2.0 * half
    return float(
        brentq(lambda t: case.reach * math.sin(t) + rise * math.cos(t) - radii, 0.0, math.atan2(case.reach, rise))
    )


def sum_of_arcs(case: DrawBead) -> float:
    """Restraining force by F -> exp(mu theta R/r) (F + B) + B over the three arcs; B bends and unbends at the arc."""
    plane, force = 2.0 / math.sqrt(3.0) * YIELD, 0.0
    angle = wrapped_angle(case)
    for radius, turn in ((case.groove_radius, angle), (case.radius, 2.0 * angle), (case.groove_radius, angle)):
        r = radius + 0.5 * case.thickness

        def bent(tension: float, r: float = r) -> float:
            return plane * case.thickness**2 / (4.0 * r) * (1.0 - (tension / (plane * case.thickness)) ** 2)

        pulled = math.exp(case.friction * turn * radius / r) * (force + bent(force))
        force = pulled + bent(pulled)
    return force


def real(page: Page, elements: float, friction: float) -> Drawn:
    """Draw a strip through the bead."""
    case = bead(elements, friction)
    model, steps = build(case)
    return Drawn.of(
        case, page.solve(f"{elements:g} elements, friction {friction:g}", model, steps, options=case.newton)
    )


def equivalent(page: Page, drawn: Drawn) -> tuple[np.ndarray, np.ndarray]:
    """Draw the same strip over a flat with the equivalent bead: path and force."""
    case = drawn.case
    left, right = case.ends
    cells = round((right - left) / THICKNESS)
    strip = mesh.strip(right - left, 1.0, case.thickness, (cells, 1)).transformed(
        lambda x: x + np.array([left, 0.0, 0.5 * case.thickness])
    )
    model = Model(strip, "BEND8", material=STEEL)
    model.fix(np.arange(len(strip.points)), "y")
    pull = model.prescribe("x1", "x", "pull")
    die = model.contact("lower", Plane(), name="die")
    model.contact("upper", Plane((0.0, 0.0, 1.05 * case.thickness), (0.0, 0.0, -1.0)), name="holder")
    line = [(0.0, -20.0, 0.0), (0.0, 21.0, 0.0)]
    model.bead("lower", die, curve=line, restraint=drawn.restraint, uplift=drawn.uplift, width=width(drawn))
    result = page.solve(f"equivalent, friction {case.friction:g}", model, Move(pull, case.way, steps=20))
    return result["pull"], result["pull_force"]


def run(page: Page) -> None:
    """Fill the page."""
    meshes = page.pick((7.0, 10.0, 14.0), (4.0,))
    rows: list[tuple[str | float, ...]] = []
    drawn = [real(page, elements, 0.1) for elements in meshes]
    for one in drawn:
        rows.append(
            (f"{one.case.elements:g}", one.restraint, one.uplift, one.thinning, one.friction_share, one.balance)
        )
    columns = ("elements on a quarter turn", "restraint", "uplift", "thinning %", "friction %", "balance %")
    page.table("Bead of real geometry", columns, rows)
    exact = sum_of_arcs(drawn[-1].case)
    found = drawn[-1].restraint
    if len(drawn) > 1:
        limits = of_two(drawn[-2], drawn[-1])
        limit, lift = limits["restraint"], limits["uplift"]
        page.table(
            "Elements of no length, from the last two",
            ("", "limit", "last mesh over the limit, %"),
            [("restraint", limit.value, 100.0 * limit.off), ("uplift", lift.value, 100.0 * lift.off)],
        )
        found = limit.value
    if not page.short:
        page.check("restraint against the sum of three arcs", found, exact, 0.1, known=0.13, cause=ROUNDER)
    way, force = equivalent(page, drawn[-1])
    steady = way >= drawn[-1].case.through
    page.check("equivalent bead: force on the steady part", float(force[steady].mean()), drawn[-1].restraint, 0.02)
    page.figure(
        "force",
        plot(
            [Curve("real", drawn[-1].way, drawn[-1].restraint_curve), Curve("equivalent", way, force)],
            "way",
            "force",
            level=exact,
        ),
        "Force over the path; level: the sum of three arcs",
    )


CASE = Case(
    name="friction-draw-bead",
    title="Draw bead: real geometry, equivalent bead, sum of three arcs",
    problem=f"""
A strip of h = {THICKNESS:g}, width 1, plane strain, E = 200000, nu = 0.3, yield stress {YIELD:g}, hardening
{HARDENING:g}, is closed between a bead of R = {RADIUS:g}, {HEIGHT:g} high, and a groove with edges of R = {EDGE:g}, as
in `umform bead`, and drawn through; friction 0.1 on both tools. BEND8, 7, 10 and 14 elements on a quarter turn of the
sharper radius. Then the same strip is drawn over a flat with the equivalent bead.
""",
    reference="""
After Swift, as in [bending and unbending](friction-bending-work.md), for each of three arcs: F -> exp(mu theta) (F + B)
+ B with B = M/r, M the plastic moment in plane strain under the tension there; theta of the edges from the common
tangent of the circles of the mid-line, 2 theta on the bead. The usual estimate of draw beads (Stoughton 1988, after the
tests of Nine 1978, whose numbers were not available). Uncertainty 10 %: the strip is not bent to the radius at once;
elastic strains lower the force, hardening raises it.
""",
    run=run,
    cost=150.0,
)

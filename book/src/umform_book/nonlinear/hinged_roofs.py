"""Hinged cylindrical roofs under a load at their centre: snap-through of the thick one, snap-back of the thin one."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from umform.materials import J2, SVK, Material, Perfect
from umform.model import Model
from umform_book.case import Case
from umform_book.nonlinear.course import TIED, Problem, enter_shape, run_course
from umform_book.nonlinear.cylinders import corner, sector
from umform_book.nonlinear.tracing import LOAD, Curve, Probe, Setup, trace_arc
from umform_book.page import Page
from umform_book.references import table
from umform_book.variants import Variant

Floats = NDArray[np.float64]

RADIUS, LENGTH, ANGLE, FORCE = 2540.0, 508.0, 0.1, 3000.0
E, NU = 3102.75, 0.3
LAW = SVK(E=E, nu=NU)
#: Elastic in logarithmic strains: the J2 law with a yield stress that is never reached.
HENCKY = J2(kappa=E / (3 - 6 * NU), mu=E / (2 + 2 * NU), hardening=Perfect(1e3 * E))


def build(variant: Variant, divisions: int, *, thickness: float, law: Material = LAW) -> Setup:
    """A quarter: a quarter of the force, half of it on the lower and half on the upper node; hinged on the mid-line."""
    shell = sector(
        variant,
        (divisions, divisions),
        radius=RADIUS,
        length=LENGTH / 2,
        thickness=thickness,
        angles=(0.0, ANGLE),
    )
    model = Model(shell, variant.element, material=law, thickness_points=2)
    model.symmetry("x0", "x")
    model.symmetry("y0", "y")
    model.hinge("x1", "xz")
    model.hinge(np.setdiff1d(shell.nodes("x1"), shell.nodes("y0")), "y")
    at_C = corner(shell, "x0", "y0")
    load = model.force(at_C, (0, 0, -0.125), "load")
    return Setup(model, {load: FORCE}, {"minus_w_C": Probe(at_C, (0, 0, -1))})


def limit_load(curve: Curve) -> float:
    """First maximum of the force, that of a parabola over the path through the three points around it."""
    loads, w = FORCE * curve[LOAD], curve["minus_w_C"]
    falling = np.flatnonzero(np.diff(loads) < 0.0)
    if len(falling) == 0:
        return float("nan")
    top = int(falling[0])
    near = slice(top - 1, top + 2)
    way = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(loads[near]) / FORCE, np.diff(w[near]) / np.abs(w).max()))])
    a, b, c = np.polyfit(way, loads[near], 2)
    return float(c - 0.25 * b * b / a)


def _problem(thickness: float) -> Problem:
    return Problem(
        build=partial(build, thickness=thickness),
        reference=table(f"sze_hinged_roof_{thickness:g}.csv"),
        names={"minus_w_C": "-w_C"},
        measures={"Limit load, N": limit_load},
        meshes=(4, 8, 16),
        short=8,
        follow=trace_arc,
    )


def run(page: Page, *, thickness: float) -> None:
    """Fill the page."""
    problem = _problem(thickness)
    found = run_course(page, problem)
    if page.short:
        return
    variant, mesh = TIED[-1], found.finest
    label = f"{variant.label}, {mesh}, logarithmic strains"
    hencky = build(variant, mesh, thickness=thickness, law=HENCKY)
    reference = limit_load(problem.reference)
    logarithmic = limit_load(trace_arc(hencky, problem.reference[LOAD], partial(page.solve, label)))
    page.check(f"Limit load, N, {label}", logarithmic, reference, 0.005)
    plain, other = (100 * (load / reference - 1) for load in (found.read(limit_load)[variant][mesh], logarithmic))
    page.text(
        "In compression a law linear in Green-Lagrange strains is softer than one linear in logarithmic strains (in "
        f"the force by 1.5 times the strain). Their limit loads are {plain:+.2f} % and {other:+.2f} % off the table."
    )
    enter_shape(page, found, TIED[0], mirrors=(0, 1), view=(-60.0, 12.0))


def _case(thickness: float, title: str, reference: str) -> Case:
    return Case(
        name=f"nonlinear-roof-{thickness:g}".replace(".", "-"),
        title=title,
        problem=f"""
Cylindrical roof of radius 2540 mm, length 508 mm, half angle 0.1 rad, {thickness:g} mm thick; E = 3102.75 MPa, nu =
0.3. The straight edges are hinged on the mid-line of the sheet, the curved edges free; a dead force of up to 3000 N
pushes the centre down. One quarter, N x N intervals, arc length. Measured: force over the deflection -w_C of the centre
(mean of the lower and upper node), and the limit load, the first maximum of the force.
""",
        reference=reference,
        run=partial(run, thickness=thickness),
        cost=18.0,
    )


THICK = _case(
    12.7,
    "Hinged cylindrical roof, 12.7 mm: snap-through",
    """
Table of Sze, Liu & Lo, Finite Elem. Anal. Des. 40 (2004) 1551-1569 (Abaqus S4R): the largest force of the table is
2226 N at 11.3 mm. It does not say in which strains its elastic law is linear: this changes the limit load by 0.6 %
(see below).
""",
)
THIN = _case(
    6.35,
    "Hinged cylindrical roof, 6.35 mm: snap-back",
    """
Table of Sze, Liu & Lo, Finite Elem. Anal. Des. 40 (2004) 1551-1569 (Abaqus S4R): the largest force of the table
before the snap is 586 N at 12.9 mm, the smallest -386 N at 15.8 mm. The points of the table are far apart, so limit
loads are compared with a parabola through the three highest. Uncertainty: the last digit of the table, 0.2 % of the
largest force, and the error of the parabola between its points.
""",
)

"""Pinched semi-cylindrical shell, clamped at one end: snap-like growth of the displacement, then membrane stresses."""

from __future__ import annotations

from functools import partial

import numpy as np

from umform.materials import SVK
from umform.model import Model
from umform_book.case import Case
from umform_book.nonlinear.course import TIED, Problem, enter_shape, full_load, run_course
from umform_book.nonlinear.cylinders import corner, sector
from umform_book.nonlinear.tracing import LOAD, Probe, Setup, trace_arc
from umform_book.page import Page
from umform_book.references import table
from umform_book.variants import Variant

RADIUS, LENGTH, THICKNESS, FORCE = 101.6, 304.8, 3.0, 2000.0


def build(variant: Variant, divisions: int) -> Setup:
    """Half of the shell: half of the force, half of it on the lower and half on the upper node.

    At the straight edges the director is horizontal: holding u_z of both faces holds its rotation too.
    """
    shell = sector(variant, (divisions, divisions), radius=RADIUS, length=LENGTH, thickness=THICKNESS)
    model = Model(shell, variant.element, material=SVK(E=2068.5, nu=0.3))
    model.symmetry("x0", "x")
    model.symmetry("x1", "z")
    model.fix("y1")
    at_A = corner(shell, "x0", "y0")
    load = model.force(at_A, (0, 0, -0.25), "pinch")
    return Setup(model, {load: FORCE}, {"minus_w_A": Probe(at_A, (0, 0, -1))})


_NAMES = {"minus_w_A": "-w_A"}
PROBLEM = Problem(
    build=build,
    reference=table("sze_semi_cylinder.csv"),
    names=_NAMES,
    measures=full_load(_NAMES),
    meshes=(8, 16, 32),
    short=16,
)


def run(page: Page) -> None:
    """Fill the page."""
    found = run_course(page, PROBLEM)
    if not page.short:
        page.text(_folding_text(page))
    enter_shape(page, found, TIED[0], mirrors=(0,), view=(-40.0, 25.0))


def _folding_text(page: Page) -> str:
    """The path on the coarsest mesh."""
    variant, mesh = TIED[0], min(PROBLEM.meshes)
    label = f"{variant.label}, {mesh}, arc length"
    rising = np.diff(trace_arc(build(variant, mesh), PROBLEM.reference[LOAD], partial(page.solve, label))[LOAD]) > 0.0
    maxima = int(np.count_nonzero(rising[:-1] & ~rising[1:]))
    return (
        f"With {mesh} intervals the path of {variant.label} has {maxima} maxima of the load, which the shell does not "
        "have: rows of elements snap one after the other. Under a growing load such a mesh jumps."
    )


CASE = Case(
    name="nonlinear-semi-cylinder",
    title="Pinched semi-cylindrical shell",
    problem="""
Half of a cylinder, radius 101.6, length 304.8, thickness 3; E = 2068.5, nu = 0.3. One end is clamped, the other free
and loaded at its crown by a dead force of 2000 towards the axis. The straight edges are held vertically and against
rotation about the edge (u_z of both faces), and may slide. One half with a symmetry plane, N x N intervals. Measured:
-w_A under the force at 25 load levels.
""",
    reference="""
Sze, Liu & Lo, Finite Elem. Anal. Des. 40 (2004) 1551-1569 (Abaqus S4R, 40 x 40): -w_A = 171.505 at full load. MI9K3DEAS
with E_33 tied finds 171.66 with 32 intervals, 171.92 with 64: the table is 0.25 % low, and up to 1.1 % where the curve
is flattest (0.3 to 0.35 of the load).
""",
    run=run,
    picture="curves",
    cost=62.0,
)

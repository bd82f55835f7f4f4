"""Pinched cylinder on rigid diaphragms: deep dents with short waves, the hardest of these problems for a mesh."""

from __future__ import annotations

from dataclasses import replace

from umform.materials import SVK
from umform.model import Model
from umform_book.case import Case
from umform_book.nonlinear.course import TIED, Problem, enter_shape, full_load, run_course
from umform_book.nonlinear.cylinders import corner, sector
from umform_book.nonlinear.tracing import LOAD, Probe, Setup
from umform_book.page import Page
from umform_book.references import table
from umform_book.variants import Variant

RADIUS, LENGTH, THICKNESS, FORCE = 100.0, 200.0, 1.0, 12e3


def build(variant: Variant, divisions: int) -> Setup:
    """An eighth: a quarter of the force, half of it on the lower and half on the upper node."""
    shell = sector(variant, (divisions, divisions), radius=RADIUS, length=LENGTH / 2, thickness=THICKNESS)
    model = Model(shell, variant.element, material=SVK(E=30e3, nu=0.3))
    for side, normal in (("x0", "x"), ("x1", "z"), ("y0", "y")):
        model.symmetry(side, normal)
    diaphragm = shell.nodes("y1")
    model.fix(diaphragm, "xz")
    at_A, at_B = (corner(shell, side, "y0") for side in ("x0", "x1"))
    load = model.force(at_A, (0, 0, -0.125), "pinch")
    return Setup(model, {load: FORCE}, {"minus_w_A": Probe(at_A, (0, 0, -1)), "u_B": Probe(at_B, (1, 0, 0))})


_TABLE = table("pinched_cylinder_diaphragms.csv")
_NAMES = {"minus_w_A": "-w_A", "u_B": "u_B"}
#: The edge effect of a cylinder has waves 2 pi sqrt(R h) / (3 - 3 nu²)^(1/4) = 49 long, ten intervals along the ring of
#: the finest mesh: elements of second order err there by (2 pi / 10)² / 12 = 3 % in bending, more where large
#: displacements make the waves shorter; the reference is uncertain by 1 %.
PROBLEM = Problem(
    build=build,
    reference={name: _TABLE[name] for name in (LOAD, *_NAMES)},
    names=_NAMES,
    measures=full_load(_NAMES),
    meshes=(16, 24, 32),
    short=24,
    expected=0.05,
    known=0.08,
    cause="the mesh: while the dents grow (0.15 to 0.3 of the load) their steep edges, which uniform elements resolve "
    "worst, run through it; the distance falls with the square of the intervals",
)
#: The first point of the curve only.
SHORT = replace(
    PROBLEM,
    reference={name: column[:1] for name, column in PROBLEM.reference.items()},
    measures=full_load(_NAMES, "at 0.05 of the load"),
)


def run(page: Page) -> None:
    """Fill the page."""
    found = run_course(page, SHORT if page.short else PROBLEM)
    page.table(
        "The reference and what it rests on: -w_A and u_B of MI9K3DEAS, 96 intervals; MI9K3DEAS, 64; EAS3DEAS, 64",
        ("load over full load", *("-w_A", "u_B") * 3),
        [(f"{row[0]:.2f}", *map(float, row[1:])) for row in zip(*_TABLE.values(), strict=True)],
    )
    enter_shape(page, found, TIED[0], mirrors=(0, 1), view=(-60.0, 40.0))


CASE = Case(
    name="nonlinear-pinched-cylinder",
    title="Pinched cylinder on rigid diaphragms",
    problem="""
Cylinder of radius 100, length 200 and thickness 1; E = 30e3, nu = 0.3. Rigid diaphragms hold both ends in their plane
and leave them free along the axis (x and z of both faces held, y free). Two opposite dead forces of 12e3 pinch it at
the middle of its length. One eighth with symmetry planes, N x N intervals. Measured, at 20 load levels: the
displacement -w_A under the force, inward, and u_B at the side, outward.
""",
    reference="""
Own computation: MI9K3DEAS with E_33 tied and 96 x 96 intervals finds -w_A = 80.10 and u_B = 32.86 at full load, with
64 x 64 intervals 79.81 and 32.82; EAS3DEAS with E_33 tied and 64 x 64 intervals 79.51 and 32.40. The table below has
their curves; the reference is certain to about 1 %. (The problem is that of Sze, Liu & Lo, Finite Elem. Anal. Des. 40
(2004) 1551-1569.)
""",
    run=run,
    cost=190.0,
)

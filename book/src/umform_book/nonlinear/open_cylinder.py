"""Open cylinder pulled out by two forces: first bending, then, beyond a kink of the curve, membrane stresses."""

from __future__ import annotations

from umform.materials import SVK
from umform.model import Model
from umform_book.case import Case
from umform_book.nonlinear.course import TIED, Problem, enter_shape, full_load, run_course
from umform_book.nonlinear.cylinders import corner, sector
from umform_book.nonlinear.tracing import Probe, Setup
from umform_book.page import Page
from umform_book.references import table
from umform_book.variants import Variant

RADIUS, LENGTH, THICKNESS, FORCE = 4.953, 10.35, 0.094, 40e3


def build(variant: Variant, divisions: int) -> Setup:
    """An eighth: a quarter of the force, half of it on the lower and half on the upper node."""
    shell = sector(variant, (divisions, divisions), radius=RADIUS, length=LENGTH / 2, thickness=THICKNESS)
    model = Model(shell, variant.element, material=SVK(E=10.5e6, nu=0.3125))
    for side, normal in (("x0", "x"), ("x1", "z"), ("y0", "y")):
        model.symmetry(side, normal)
    at_A, at_B, at_C = (corner(shell, *sides) for sides in (("x0", "y0"), ("x1", "y0"), ("x1", "y1")))
    load = model.force(at_A, (0, 0, 0.125), "pull")
    probes = {
        "minus_u_B": Probe(at_B, (-1, 0, 0)),
        "w_A": Probe(at_A, (0, 0, 1)),
        "minus_u_C": Probe(at_C, (-1, 0, 0)),
    }
    return Setup(model, {load: FORCE}, probes)


_NAMES = {"w_A": "w_A", "minus_u_B": "-u_B", "minus_u_C": "-u_C"}
PROBLEM = Problem(
    build=build,
    reference=table("sze_open_cylinder.csv"),
    names=_NAMES,
    measures=full_load(_NAMES),
    meshes=(8, 16, 32),
    short=16,
)


def run(page: Page) -> None:
    """Fill the page."""
    found = run_course(page, PROBLEM)
    enter_shape(page, found, TIED[0], mirrors=(0, 1, 2), view=(-55.0, 20.0))


CASE = Case(
    name="nonlinear-open-cylinder",
    title="Pull-out of an open cylinder",
    problem="""
Cylinder of radius 4.953, length 10.35, thickness 0.094 with free ends; E = 10.5e6, nu = 0.3125. Two opposite dead
forces of 40e3 pull outward at mid-length. One eighth with symmetry planes, N x N intervals. Measured at 23 load levels:
the outward displacement w_A under the force, the inward ones -u_B (side, mid-length) and -u_C (side, free end).
""",
    reference="""
Sze, Liu & Lo, Finite Elem. Anal. Des. 40 (2004) 1551-1569 (Abaqus S4R): w_A = 2.768, -u_B = 4.551, -u_C = 3.269 at full
load. MI9K3DEAS with E_33 tied finds 2.773, 4.578, 3.247 with 32 intervals and 2.781, 4.572, 3.258 with 64. The table is
uncertain by 0.5 %; between 0.5 and 0.6 of the load, where the sides snap inward, its -u_B is 1 % low.
""",
    run=run,
    picture="curves",
    cost=42.0,
)

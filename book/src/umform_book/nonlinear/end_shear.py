"""Cantilever bent by an end shear force: large rotations of a plane strip."""

from __future__ import annotations

from umform_book.case import Case
from umform_book.nonlinear.cantilever import end_shear
from umform_book.nonlinear.course import TIED, Problem, enter_shape, full_load, run_course
from umform_book.nonlinear.tracing import LOAD
from umform_book.page import Page
from umform_book.references import table

_TABLE = table("sze_end_shear.csv")
_NAMES = {"w_tip": "w", "minus_u_tip": "-u"}
PROBLEM = Problem(
    build=end_shear,
    reference={name: column[_TABLE[LOAD] > 0.0] for name, column in _TABLE.items()},
    names=_NAMES,
    measures=full_load(_NAMES),
    meshes=(8, 16, 32),
    short=16,
)


def run(page: Page) -> None:
    """Fill the page."""
    found = run_course(page, PROBLEM)
    enter_shape(page, found, TIED[0])


CASE = Case(
    name="nonlinear-end-shear",
    title="Cantilever under an end shear force",
    problem="""
Strip of length 10, width 1, thickness 0.1; E = 1.2e6, nu = 0, law of Saint-Venant and Kirchhoff (SVK). One end is
clamped; a dead force of 4, normal to the undeformed strip, is spread over the other end face. One element over the
width. Measured: deflection w of the end and its shortening -u at 20 load levels, the means of all lower and upper nodes
of the end face.
""",
    reference="""
Sze, Liu & Lo, Finite Elem. Anal. Des. 40 (2004) 1551-1569 (Abaqus S4R): w = 6.698, -u = 3.286. MI9K3DEAS with 32 and 64
intervals agree on 6.700 and 3.290: the table is uncertain by 0.03 % and 0.12 %.
""",
    run=run,
    picture="curves",
    cost=3.0,
)

"""Cantilever rolled up to a full circle by an end moment: the largest rotation there is, with a closed form."""

from __future__ import annotations

import numpy as np

from umform_book.case import Case
from umform_book.nonlinear.cantilever import THICKNESS, TURN, circle, end_moment, rotation_of_end
from umform_book.nonlinear.course import TIED, Problem, enter_shape, full_load, run_course
from umform_book.page import Page
from umform_book.variants import Variant

_NAMES = {"minus_u_tip": "-u", "w_tip": "w"}
PROBLEM = Problem(
    build=end_moment,
    reference=circle(np.arange(1, 21) / 20),
    names=_NAMES,
    measures=full_load({"minus_u_tip": "-u"}),
    meshes=(16, 32, 64),
    short=32,
)
#: The closed form neglects the square of the thickness times the curvature.
_THIN = (THICKNESS * TURN / 10.0) ** 2


def run(page: Page) -> None:
    """Fill the page."""
    found = run_course(page, PROBLEM)
    turns = {variant: rotation_of_end(model) / TURN for variant, model in found.models.items()}
    page.table(
        f"Rotation of the end over a full turn, {found.finest} intervals",
        ("element", "rotation"),
        [(variant.label, turn) for variant, turn in turns.items()],
    )
    for variant in (variant for variant in TIED if variant in turns):
        within = _THIN * (64 / found.finest) ** 2
        page.check(f"rotation of the end, {variant.label}, {found.finest} intervals", turns[variant], 1.0, within)
    page.text(
        f"The closed form holds for a thin strip: it neglects the square of thickness times curvature, {_THIN:.4f}."
    )
    coarse = found.curves.get(Variant("ANS3DEAS"), {})
    if coarse and coarse[min(coarse)] is None:
        page.text(
            f"Without tying of E_33, {min(coarse)} elements bent by {360 / min(coarse):g} degrees each have a false "
            "thinning at their middle and become too soft to carry the moment."
        )
    enter_shape(page, found, TIED[0])


CASE = Case(
    name="nonlinear-end-moment",
    title="Cantilever rolled up by an end moment",
    problem="""
Strip of length 10, width 1, thickness 0.1; E = 1.2e6, nu = 0. One end is clamped; the moment 2 pi E I / L on the other
bends a thin strip to a full circle. The moment is a couple of line loads on both edges of the end, normal to the
director of the closed form. One element over the width. Measured: path of the end at 20 load levels, and its rotation.
""",
    reference="""
Elastica: a circle of radius E I / M; end at L sin(a)/a and L (1 - cos a)/a, a = M L / (E I). It neglects the square of
thickness times curvature, 0.4 % at the full moment. Second problem of Sze, Liu & Lo, Finite Elem. Anal. Des. 40 (2004)
1551-1569.
""",
    run=run,
    picture="curves",
    cost=6.0,
)

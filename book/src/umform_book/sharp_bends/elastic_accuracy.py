"""The elements for bends on the elastic obstacle courses, beside the elements that they are made of."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial

from umform_book.case import Case
from umform_book.convergence import Study, normalised, show, study
from umform_book.linear import hemisphere, pinched_cylinder, scordelis_lo, straight_beam
from umform_book.nonlinear import end_shear
from umform_book.nonlinear import hemisphere as nonlinear_hemisphere
from umform_book.nonlinear.course import EXPECTED, Problem
from umform_book.nonlinear.tracing import LOAD, trace
from umform_book.page import Page
from umform_book.variants import Variant, with_tying

#: Element for bends and its parent with E_33 tied, which is what order 4 is added to.
PAIRS = ((Variant("BEND8"), with_tying("ANS3DEAS")), (Variant("BEND18"), with_tying("MI9K3DEAS")))
ELEMENTS = tuple(variant for pair in PAIRS for variant in pair)
#: BEND8 has no enhanced membrane strain and locks in in-plane bending, as ANS3DEAS does: no reference is met there.
LOCKS = ("in-plane shear", "twist")
#: Difference to the parent: the terms above order 1 answer to curvature and to Poisson's effect only.
NEAR = 1e-4

_SHELLS: tuple[tuple[str, Callable[[Variant, int], float], float], ...] = (
    ("Scordelis-Lo roof", scordelis_lo.both_faces, scordelis_lo.REFERENCE),
    ("pinched cylinder", pinched_cylinder.deflection, pinched_cylinder.REFERENCE),
    ("pinched hemisphere", hemisphere.displacement, hemisphere.REFERENCE),
)
_NONLINEAR = (("cantilever under end shear", end_shear.PROBLEM), ("pinched hemisphere", nonlinear_hemisphere.PROBLEM))


def _near_parent(page: Page, what: str, found: Study) -> float:
    """Check how far each element is from its parent on any mesh; the largest difference."""
    largest = 0.0
    for child, parent in PAIRS:
        differences = [
            abs(found[child][n] / found[parent][n] - 1.0) for n in found[child] if math.isfinite(found[parent][n])
        ]
        page.at_most(f"{what}: {child.label} against {parent.label}, any mesh", max(differences), NEAR)
        largest = max(largest, *differences)
    return largest


def _meets(page: Page, what: str, shares: Study, within: float) -> None:
    """Check the elements for bends on the finest mesh against the reference."""
    for child, _ in PAIRS:
        finest = max(shares[child])
        page.check(f"{what}: {child.label}, {finest} intervals", shares[child][finest], 1.0, within)


def _beams(page: Page) -> float:
    page.heading("Straight cantilever: rectangles, trapezoids, parallelograms")
    largest = 0.0
    for shape in straight_beam.SHAPES:
        for load, reference in straight_beam.REFERENCES.items():

            def tip(variant: Variant, n: int, shape: str = shape, load: str = load) -> float:
                return straight_beam.LOADS[load](straight_beam.cantilever(variant, n, shape))

            found = study(page, ELEMENTS, page.pick((6, 12, 24), (6,)), tip)
            shares = normalised(found, reference)
            name = f"{shape}-{load.replace(' ', '-')}"
            show(page, name, f"{shape}, {load}: displacement over {reference:.4g}", shares)
            largest = max(largest, _near_parent(page, f"{shape}, {load}", found))
            if load not in LOCKS:
                _meets(page, f"{shape}, {load}", shares, 0.02 if not page.short else 0.05)
    return largest


def _shells(page: Page) -> float:
    page.heading("Linear shells")
    largest = 0.0
    for what, compute, reference in _SHELLS:
        found = study(page, ELEMENTS, page.pick((4, 8, 16, 32), (4, 16)), compute)
        shares = normalised(found, reference)
        show(page, what.replace(" ", "-").lower(), f"{what}: displacement over {reference:.4g}", shares)
        largest = max(largest, _near_parent(page, what, found))
        _meets(page, what, shares, 0.03 if not page.short else 0.1)
    return largest


def _full_load(page: Page, problem: Problem, name: str, probe: str, variant: Variant, divisions: int) -> float:
    setup = problem.build(variant, divisions)
    curve = trace(setup, problem.reference[LOAD], partial(page.solve, f"{name}, {variant.label}, {divisions}"))
    return float(curve[probe][-1])


def _nonlinear(page: Page) -> float:
    page.heading("Large rotations")
    largest = 0.0
    for what, problem in _NONLINEAR:
        probe, name = next(iter(problem.names.items()))
        found = study(page, ELEMENTS, (8, 16), partial(_full_load, page, problem, what, probe))
        shares = normalised(found, float(problem.reference[probe][-1]))
        title = f"{what}: {name} at full load over the reference"
        show(page, f"nonlinear-{what.replace(' ', '-')}", title, shares)
        largest = max(largest, _near_parent(page, f"{what}, large rotations", found))
        # what the course expects of a mesh half as fine as its finest
        _meets(page, f"{what}, large rotations", shares, 4.0 * EXPECTED)
    return largest


def run(page: Page) -> None:
    """Fill the page."""
    steps: Sequence[Callable[[Page], float]] = page.pick((_beams, _shells, _nonlinear), (_beams, _shells))
    largest = max(step(page) for step in steps)
    page.text(
        f"The largest difference from the base element with E_33 tied and order 1 is {100 * largest:.2g} %: higher "
        "orders neither help nor harm in elastic problems. The limits of the base elements remain: BEND8 locks in "
        "in-plane bending (it has no enhanced membrane strain), and both need several layers for St. Venant's "
        "torsion."
    )


CASE = Case(
    name="bend-elastic-accuracy",
    title="Elastic accuracy of the elements for bends",
    problem="""
BEND8 and BEND18, beside ANS3DEAS and MI9K3DEAS with E_33 tied, in the problems of the obstacle courses: [straight
cantilever](straight-beam.md), [Scordelis-Lo roof](scordelis-lo.md), [pinched cylinder](pinched-cylinder.md), [pinched
hemisphere](linear-hemisphere.md); with large rotations [cantilever](nonlinear-end-shear.md) and
[hemisphere](nonlinear-hemisphere.md).

![One of the problems, from the page of the pinched hemisphere](images/linear-hemisphere-shape.png)
""",
    reference="""
The references of those pages, and the base element, which order 4 must not change.
""",
    own="the element that each is made of, umform itself, beside the references of the problems",
    run=run,
    picture="nonlinear-pinched-hemisphere",
    cost=20.0,
)

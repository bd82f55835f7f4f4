"""Clamped circular plate under uniform load, on distorted quadrilaterals."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.materials import SVK
from umform.mesh import Mesh
from umform.model import Model
from umform.results.shape import Shape
from umform_book.case import Case
from umform_book.convergence import normalised, show, study
from umform_book.linear.meshes import quarter_disc
from umform_book.linear.sentences import coarse_and_fine
from umform_book.linear_algebra import linear_solution
from umform_book.page import Page
from umform_book.variants import GOOD, VARIANTS, Variant, with_tying

Floats = NDArray[np.float64]

RADIUS, THICKNESS = 10.0, 0.2
MATERIAL = SVK(E=1e7, nu=0.3)
LOAD = 1.0
_D = MATERIAL.E * THICKNESS**3 / (12 * (1 - MATERIAL.nu**2))
_BENDING = LOAD * RADIUS**4 / (64 * _D)
_SHEAR = LOAD * RADIUS**2 / (4 * 5 / 6 * MATERIAL.mu * THICKNESS)
#: Deflection of the middle: bending and transverse shear.
REFERENCE = _BENDING + _SHEAR


def plate(variant: Variant, divisions: int) -> tuple[Mesh, Floats]:
    """Mesh of a quarter and its displacements."""
    mesh = quarter_disc(variant, divisions, RADIUS, THICKNESS)
    model = Model(mesh, variant.element, material=MATERIAL)
    tiny = 1e-6 * RADIUS
    model.symmetry(lambda x, y, z: x < tiny, "x")
    model.symmetry(lambda x, y, z: y < tiny, "y")
    model.fix(lambda x, y, z: np.hypot(x, y) > RADIUS - tiny)
    return mesh, linear_solution(model, model.loads.body_force((0, 0, -LOAD / THICKNESS)).vector)


def deflection(variant: Variant, divisions: int) -> float:
    """Deflection of the middle, mean of the lower and upper node."""
    mesh, u = plate(variant, divisions)
    return -float(u[np.hypot(mesh.points[:, 0], mesh.points[:, 1]) < 1e-6 * RADIUS, 2].mean())


def run(page: Page) -> None:
    """Fill the page."""
    divisions = page.pick((2, 4, 8, 16), (2, 4, 8))
    found = study(page, page.pick(VARIANTS, GOOD), divisions, deflection)
    show(
        page,
        "convergence",
        "deflection over the closed form",
        normalised(found, REFERENCE),
        mesh="intervals between nodes along an edge of each of the three blocks",
    )
    for variant in (with_tying("ANS3DEAS"), with_tying("EAS3DEAS"), with_tying("MI9K3DEAS")):
        for n in (4, divisions[-1]):
            within = 0.05 if n == 4 else 0.01
            page.check(f"{variant.label}, {n} intervals", found[variant][n], REFERENCE, within=within)
    page.text(coarse_and_fine(found, REFERENCE))
    mesh, u = plate(with_tying("ANS3DEAS"), 4)
    page.shape("shape", Shape.displaced(mesh, u / np.abs(u).max()), "Quarter of the plate, enlarged")


CASE = Case(
    name="circular-plate",
    title="Clamped circular plate",
    problem=f"""
Quarter of a plate of radius {RADIUS:g} and thickness {THICKNESS:g}; E = 1e7, nu = 0.3; load {LOAD:g} per unit area,
spread through the thickness. Both faces are clamped at the rim. The mesh has three blocks of quadrilaterals, none a
parallelogram. Measured: deflection of the middle.
""",
    reference=f"""
Closed form: q R^4 / (64 D) + q R^2 / (4 (5/6) G h) = {REFERENCE:.5g}. Transverse shear is
{100 * _SHEAR / REFERENCE:.2f} % of it; the elements have no shear factor 5/6, an error of a sixth of that part.
""",
    run=run,
    cost=4.0,
)

"""Cook's membrane: bending and shear of a tapered panel in its plane."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.materials import SVK
from umform.mesh import Mesh
from umform.model import Model
from umform.model.terms.forces import traction_forces
from umform.results.shape import Shape
from umform_book.case import Case
from umform_book.convergence import normalised, show, study
from umform_book.linear.meshes import rectangle
from umform_book.linear.sentences import coarse_and_fine
from umform_book.linear_algebra import linear_solution
from umform_book.page import Page
from umform_book.variants import GOOD, VARIANTS, Variant, with_tying

Floats = NDArray[np.float64]

#: Displacement of the middle of the free end to which our meshes converge.
REFERENCE = 23.96


def panel(variant: Variant, divisions: int) -> tuple[Mesh, Floats]:
    """Mesh and displacements under a force of 1."""

    def tapered(X: Floats) -> Floats:
        x, y, z = X.T
        return np.column_stack([48 * x, 44 * x + y * (44 - 28 * x), z + 0.5])

    mesh = rectangle(variant, (divisions, divisions), (1.0, 1.0, 1.0)).transformed(tapered)
    model = Model(mesh, variant.element, material=SVK(E=1.0, nu=1 / 3))
    model.fix("x0", "xy")
    model.fix("lower", "z")
    return mesh, linear_solution(model, traction_forces(mesh, "x1", (0, 1 / 16, 0)))


def displacement(variant: Variant, divisions: int) -> float:
    """Displacement of the middle of the free end along the force."""
    mesh, u = panel(variant, divisions)
    middle = np.abs(mesh.points[:, :2] - [48.0, 52.0]).max(axis=1) < 1e-9
    return float(u[middle, 1].mean())


def run(page: Page) -> None:
    """Fill the page."""
    divisions = page.pick((2, 4, 8, 16, 32), (2, 4, 8))
    found = study(page, page.pick(VARIANTS, GOOD), divisions, displacement)
    show(page, "convergence", f"displacement over {REFERENCE:g}", normalised(found, REFERENCE))
    fine = divisions[-1]
    for variant in (with_tying("EAS3DEAS"), with_tying("MI9K3DEAS")):
        within = 0.02 if fine < 32 else 0.005
        page.check(f"{variant.label}, 4 intervals", found[variant][4], REFERENCE, within=0.07)
        page.check(f"{variant.label}, {fine} intervals", found[variant][fine], REFERENCE, within=within)
    if not page.short:
        limit = displacement(Variant("DISP9K3DEAS"), 64)
        page.check("the reference itself: DISP9K3DEAS, 64 intervals", limit, REFERENCE, within=0.002)
    page.text(coarse_and_fine(found, REFERENCE))
    page.text("In its plane ANS3DEAS is a bilinear element. The seven membrane modes of EAS3DEAS remove the locking.")
    mesh, u = panel(with_tying("EAS3DEAS"), 8)
    page.shape("shape", Shape.displaced(mesh, 0.5 * u), "Deformed panel, displacements halved", view=(-90.0, 89.0))


CASE = Case(
    name="cook-membrane",
    title="Cook's membrane",
    problem="""
Panel with corners (0, 0), (48, 44), (48, 60), (0, 44), thickness 1, E = 1, nu = 1/3. On the side x = 0
u_x = u_y = 0; a force of 1 upward is spread along the opposite side. One linear solution, SVK at u = 0 (Hooke's law).
Plane stress: one element through the thickness, u_z = 0 on the lower nodes, upper face free. The mesh divides opposite
sides into n equal intervals between nodes. Measured: u_y of the middle of the loaded side, (48, 52).
""",
    reference="""
23.96: our own solution with biquadratic membrane strains (DISP9K3DEAS) on 64 x 64 intervals, uncertain by 0.2 %. The
value usually quoted agrees. There is no closed form.
""",
    own="64 x 64 intervals of DISP9K3DEAS, umform itself; the value usually quoted, 23.96, is the same",
    run=run,
    cost=6.0,
)

"""Pinched cylinder with end diaphragms: inextensional bending and membrane action under a point load."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.materials import SVK
from umform.mesh import Mesh
from umform.model import Model
from umform.results.shape import Shape
from umform_book.case import Case
from umform_book.convergence import normalised, show, study
from umform_book.diaphragm import rigid_diaphragm
from umform_book.linear.meshes import cylinder_panel
from umform_book.linear.sentences import coarse_and_fine
from umform_book.linear_algebra import linear_solution
from umform_book.page import Page
from umform_book.variants import GOOD, VARIANTS, Variant, with_tying

Floats = NDArray[np.float64]

#: Displacement under the force: double series of Fluegge's shell theory.
REFERENCE = 1.8248e-5


def octant(variant: Variant, divisions: int) -> tuple[Mesh, Floats, NDArray[np.int32]]:
    """Mesh, displacements under F = 1 and the nodes under the force."""
    mesh = cylinder_panel(variant, divisions, radius=300.0, thickness=3.0, angle=90.0, length=300.0)
    model = Model(mesh, variant.element, material=SVK(E=3e6, nu=0.3))
    model.symmetry("x0", "x")
    model.symmetry("x1", "z")
    model.symmetry("y0", "y")
    rigid_diaphragm(model, "y1")
    loaded = np.intersect1d(mesh.nodes("x0"), mesh.nodes("y0"))
    return mesh, linear_solution(model, model.force(loaded, (0, 0, -1 / 8)).vector), loaded


def deflection(variant: Variant, divisions: int) -> float:
    """Displacement under the force."""
    _, u, loaded = octant(variant, divisions)
    return -float(u[loaded, 2].mean())


def run(page: Page) -> None:
    """Fill the page."""
    divisions = page.pick((4, 8, 16, 32), (4, 8, 16))
    found = study(page, page.pick(VARIANTS, GOOD), divisions, deflection)
    show(page, "convergence", "displacement over 1.8248e-5", normalised(found, REFERENCE))
    for variant in (with_tying("ANS3DEAS"), with_tying("EAS3DEAS"), with_tying("MI9K3DEAS"), Variant("MI9K3DEAS")):
        for n in (16, divisions[-1])[: 1 if page.short else 2]:
            within = 0.1 if n == 16 else 0.03
            page.check(f"{variant.label}, {n} intervals", found[variant][n], REFERENCE, within=within)
    page.text(coarse_and_fine(found, REFERENCE))
    mesh, u, _ = octant(with_tying("ANS3DEAS"), 16)
    page.shape("shape", Shape.displaced(mesh, 3e6 * u), "Octant, displacements 3e6 times enlarged", view=(-60.0, 30.0))


CASE = Case(
    name="pinched-cylinder",
    title="Pinched cylinder with diaphragms",
    problem="""
Cylinder R = 300, L = 600, h = 3, E = 3e6, nu = 0.3, pinched by two opposite unit forces at mid-length. Diaphragms at
the ends hold the mid-surface in their plane and the director against rotation about the axis. One octant. Measured:
displacement under the force, mean of the lower and upper node.
""",
    reference="""
1.8248e-5, double series of shell theory without transverse shear; see Belytschko et al., Comput. Meth. Appl. Mech.
Engng. 51 (1985) 221-258. With transverse shear the displacement under a point force grows slowly without bound: meshes
as fine as the thickness lie some per cent above. That is the uncertainty for elements with shear strain.
""",
    run=run,
    cost=5.0,
)

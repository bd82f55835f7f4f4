"""Thick-walled cylinder in plane strain, nearly incompressible: volumetric locking."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.materials import SVK
from umform.mesh import Mesh
from umform.model import Model
from umform.results.shape import Shape
from umform_book.case import Case
from umform_book.convergence import normalised, show, study
from umform_book.linear.meshes import rectangle
from umform_book.linear.sentences import coarse_and_fine
from umform_book.linear_algebra import linear_solution
from umform_book.page import Page
from umform_book.variants import GOOD, VARIANTS, Variant, with_tying

Floats = NDArray[np.float64]

INNER, OUTER, E = 3.0, 9.0, 1000.0
POISSON = (0.49, 0.499, 0.4999)
#: Errors of volumetric locking: ANS3DEAS on the finest mesh, MI9K3DEAS on the coarsest.
LOCKED = {0.49: 0.03, 0.499: 0.2, 0.4999: 0.7}
COARSE = {0.49: 0.0, 0.499: 0.08, 0.4999: 0.42}
_LOCKS = "volumetric locking: plane strain holds E_33, and no enhanced membrane strain follows the linear dilatation"
_NINE_POINTS = (
    "with E_33 held, an element has nine volume constraints and eight unknowns; the error falls with refinement"
)
_THEORY = "constraint count: Hughes, The Finite Element Method (2000), 4.3"


def exact(nu: float) -> float:
    """Radial displacement of the inner face under unit pressure."""
    return (1 + nu) / E * INNER**2 / (OUTER**2 - INNER**2) * (OUTER**2 / INNER + (1 - 2 * nu) * INNER)


def inner_pressure(mesh: Mesh) -> Floats:
    """Nodal forces (3 n,) of a unit pressure on the faces r = -1 of the set x0."""
    ids = mesh.connectivity[mesh.face_set("x0")[:, 0]]
    x, w = _core.gauss(2 if mesh.cell == "hex8" else 3)
    s, t = (a.ravel() for a in np.meshgrid(x, x, indexing="ij"))
    N, dN = _core.shell_functions(ids.shape[1], np.column_stack([np.full(s.size, -1.0), s, t]))
    G = np.einsum("qia,eak->eqik", dN, mesh.points[ids])
    forces = np.zeros((len(mesh.points), 3))
    inward = np.cross(G[:, :, 1], G[:, :, 2])
    np.add.at(forces, ids, np.einsum("q,qa,eqk->eak", np.outer(w, w).ravel(), N, inward))
    return forces.ravel()


def quarter(variant: Variant, divisions: int, nu: float) -> tuple[Mesh, Floats]:
    """Mesh, graded geometrically along the radius, and displacements."""

    def bent(X: Floats) -> Floats:
        radius, angle = INNER * (OUTER / INNER) ** X[:, 0], 0.5 * np.pi * X[:, 1]
        return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), X[:, 2]])

    mesh = rectangle(variant, (divisions, 2 * divisions), (1.0, 1.0, 1.0)).transformed(bent)
    model = Model(mesh, variant.element, material=SVK(E=E, nu=nu))
    model.symmetry("y0", "y")
    model.symmetry("y1", "x")
    model.fix("lower", "z")
    model.fix("upper", "z")
    return mesh, linear_solution(model, inner_pressure(mesh))


def widening(variant: Variant, divisions: int, nu: float) -> float:
    """Radial displacement of the inner face where it meets the plane y = 0."""
    mesh, u = quarter(variant, divisions, nu)
    return float(u[np.intersect1d(mesh.nodes("x0"), mesh.nodes("y0")), 0].mean())


def run(page: Page) -> None:
    """Fill the page."""
    divisions = page.pick((4, 8, 16), (4, 8))
    fine = divisions[-1]
    for nu in page.pick(POISSON, POISSON[-1:]):
        reference = exact(nu)
        compute = lambda variant, n, nu=nu: widening(variant, n, nu)  # noqa: E731
        found = study(page, page.pick(VARIANTS, GOOD), divisions, compute)
        show(page, f"nu-{nu:g}", f"nu = {nu:g}: displacement over {reference:.4e}", normalised(found, reference))
        page.text(coarse_and_fine(found, reference))
        for variant in (with_tying("EAS3DEAS"), with_tying("MI9K3DEAS")):
            for n, within in ((4, 0.05), (fine, 0.01 if fine > 8 else 0.02)):
                what = f"nu = {nu:g}: {variant.label}, {n} intervals"
                known = COARSE[nu] if variant.name == "MI9K3DEAS" and n < 16 else 0.0
                cause, theory = (_NINE_POINTS, _THEORY if n == 4 else "") if known else ("", "")
                page.check(what, found[variant][n], reference, within=within, known=known, cause=cause, theory=theory)
        locking = with_tying("ANS3DEAS")
        what = f"nu = {nu:g}: {locking.label}, {fine} intervals"
        known, theory = LOCKED[nu] if fine > 8 else 0.95, _THEORY if nu > 0.49 else ""
        page.check(what, found[locking][fine], reference, within=0.02, known=known, cause=_LOCKS, theory=theory)
    mesh, u = quarter(with_tying("EAS3DEAS"), 8, POISSON[-1])
    page.shape("shape", Shape.displaced(mesh, 100 * u), "Quarter, displacements 100 times enlarged", view=(-90.0, 60.0))


CASE = Case(
    name="thick-cylinder",
    title="Thick-walled cylinder, nearly incompressible",
    problem="""
Quarter of a cylinder, radii 3 and 9, in plane strain, E = 1000, nu = 0.49, 0.499, 0.4999, under unit inner pressure.
The thickness of the elements is along the axis; n intervals along the radius, geometrically graded, 2 n around.
Measured: radial displacement of the inner face.
""",
    reference="""
Lamé's solution, exact: 5.0399e-3, 5.0602e-3, 5.0623e-3, as in MacNeal & Harder, Finite Elem. Anal. Des. 1 (1985) 3-20.
""",
    run=run,
    picture="nu-0.4999",
    cost=6.0,
)

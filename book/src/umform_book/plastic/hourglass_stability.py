"""One element in homogeneous plastic flow: when do its hourglass modes lose their stiffness?"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from umform import mesh
from umform.analysis.run import solve
from umform.analysis.steps import Move
from umform.model import Model, Snapshot
from umform_book.case import Case
from umform_book.linear_algebra import stiffness
from umform_book.page import Page
from umform_book.plastic.bars import maximum_force_plane_strain
from umform_book.plastic.curves import Lines, lines_figure
from umform_book.plastic.tension import LAWS, MEMBRANE_SETTINGS
from umform_book.variants import Variant

Floats = NDArray[np.float64]

LAW = LAWS["Swift"]
STEPS = 40
LARGEST = 0.4
ASPECTS = (0.5, 1.0, 2.0)
CAUSE = "enhanced membrane strains remove the stiffness of hourglass modes once the material flows"
THEORY = (
    "de Souza Neto et al., Commun. Numer. Meth. Engng. 11 (1995) 951-961; Wriggers & Reese, Comput. Meth. Appl. Mech. "
    "Engng. 135 (1996) 201-209"
)


def sheet(variant: Variant, aspect: float) -> Model:
    """One element of a sheet whose thickness does not change, of length aspect along x and width 1."""
    one = mesh.strip(aspect, 1.0, 1.0, (1, 1), cell=variant.cell)
    return Model(one, variant.element, material=LAW, thickness_points=2)


def membrane_modes(model: Model) -> Floats:
    """Orthonormal displacements, shape (m, 3 n), equal on both faces and along x and y, without the affine ones."""
    lower, upper = model.mesh.nodes("lower"), model.mesh.nodes("upper")
    x, y = model.mesh.points[lower, :2].T
    affine = np.linalg.qr(np.stack([np.ones(len(x)), x, y], axis=1))[0]
    others = np.linalg.svd(np.eye(len(x)) - affine @ affine.T)[0][:, : len(x) - 3].T
    modes = []
    for shape in others:
        for axis in (0, 1):
            u = np.zeros_like(model.mesh.points)
            u[lower, axis] = u[upper, axis] = shape / np.sqrt(2.0)
            modes.append(u.ravel())
    return np.array(modes)


def softest(variant: Variant, aspect: float, strain: float) -> tuple[Floats, Floats]:
    """Smallest stiffness of the modes over the shear modulus, along a homogeneous extension to a logarithmic strain."""
    model = sheet(variant, aspect)
    for plane, normal in (("x0", "x"), ("y0", "y"), ("lower", "z"), ("upper", "z")):
        model.symmetry(plane, normal)
    end = model.prescribe("x1", "x", "end")
    free = sheet(variant, aspect)
    free.fix("lower", "z")
    free.fix("upper", "z")
    modes = membrane_modes(free)[:, free.system.free]
    strains = np.linspace(0.0, strain, STEPS + 1)[1:]
    found = []
    for value in strains:
        before = model.system.snapshot()
        solve(model, Move(end, aspect * float(np.expm1(value)), steps=1), progress=False, frames=0)
        # The history of the state before with the displacement of this one: the tangent of a point that flows.
        free.system.restore(Snapshot(before.u, terms=before.terms))
        K = stiffness(free, free.evaluate(model.u))
        found.append(np.linalg.eigvalsh(modes @ (K @ modes.T))[0] / LAW.mu)
    return strains, np.array(found)


def first_loss(strains: Floats, stiffnesses: Floats) -> float:
    """Size of the strain at which the stiffness becomes negative; infinite if it never does."""
    negative = np.flatnonzero(stiffnesses < 0.0)
    if len(negative) == 0:
        return float("inf")
    k = int(negative[0])
    if k == 0:
        return float(abs(strains[0]))
    part = stiffnesses[k - 1] / (stiffnesses[k - 1] - stiffnesses[k])
    return float(abs(strains[k - 1] + part * (strains[k] - strains[k - 1])))


def run(page: Page) -> None:
    """Fill the page."""
    top = maximum_force_plane_strain(LAW)[1]
    variants = page.pick((Variant("DISP3D"), *MEMBRANE_SETTINGS), MEMBRANE_SETTINGS[::3])
    losses: dict[tuple[Variant, str, float], float] = {}
    panels: dict[str, Lines] = {}
    for way, strain in (("tension", LARGEST), ("compression", -LARGEST)):
        lines: dict[str, tuple[Floats, Floats]] = {}
        for variant, aspect in page.each([(v, a) for v in variants for a in ASPECTS], lambda pair: pair[0].label):
            strains, found = softest(variant, aspect, strain)
            losses[variant, way, aspect] = first_loss(strains, found)
            if aspect == 1.0 and variant.name in ("EAS3DEAS", "MI9K3DEAS"):
                lines[variant.label] = np.abs(strains), found
        panels[f"smallest stiffness over mu, {way}"] = lines
    _table(page, variants, losses)
    page.figure(
        "stiffness",
        lines_figure("logarithmic strain", panels),
        "Square element, homogeneous plane strain; ANS3DEAS and DISP3D are far above",
    )
    for variant in (v for v in variants if v.name != "DISP3D"):
        first = min(losses[variant, "tension", aspect] for aspect in ASPECTS)
        enhanced = variant.name == "EAS3DEAS"
        page.at_most(
            f"strain of the largest force minus that of the first loss in tension (0: none before), {variant.label}",
            max(top - first, 0.0),
            1e-3,
            known=0.12 if enhanced else 0.0,
            cause=CAUSE if enhanced else "",
            theory=THEORY if enhanced else "",
        )
    worst = {v.label: min(losses[v, "tension", a] for a in ASPECTS) for v in variants if v.name == "EAS3DEAS"}
    page.text(
        f"This sheet is stable in tension up to the largest force, at the logarithmic strain {top:.3f}. The enhanced "
        "membrane modes lose their stiffness before it, at the strains "
        + ", ".join(f"{strain:.3f} ({label})" for label, strain in worst.items())
        + ". Refinement does not help. In compression a loss need not be a defect, since long cells may buckle; "
        "compare the elements there."
    )


def _table(page: Page, variants: Sequence[Variant], losses: dict[tuple[Variant, str, float], float]) -> None:
    page.table(
        f"Logarithmic strain at which a mode loses its stiffness (a dash: not up to {LARGEST:g})",
        ("element", *(f"{way}, {aspect:g}" for way in ("tension", "compression") for aspect in ASPECTS)),
        [
            (
                variant.label,
                *(
                    losses[variant, way, aspect] if losses[variant, way, aspect] < np.inf else None
                    for way in ("tension", "compression")
                    for aspect in ASPECTS
                ),
            )
            for variant in variants
        ],
    )


CASE = Case(
    name="plastic-hourglass",
    title="Hourglass stiffness in plastic flow",
    problem=f"""
One element of held thickness (plane strain, the membrane of a sheet between two walls), length 0.5, 1 or 2 over its
width, in homogeneous tension or compression; E = 210000, nu = 0.3, Swift's hardening 500 (0.01 + e)^0.2. Measured every
{LARGEST / STEPS:g} of logarithmic strain: the smallest eigenvalue of the tangent over all displacements that are equal
on both faces and not affine, with condensed enhanced strains. All points flow; forces are dead.

![The instability in a bar, from the page of necking](images/plastic-necking-shape-plane-strain-eas3deas.png)
""",
    reference="""
A solid in plane strain tension cannot bifurcate before its largest force (Hill & Hutchinson, J. Mech. Phys. Solids 23
(1975) 239-264), so until then all eigenvalues are positive: closed form of the [case of tension](plastic-tension.md),
uncertain by the elastic strains, 1e-3.
""",
    run=run,
    cost=4.0,
)

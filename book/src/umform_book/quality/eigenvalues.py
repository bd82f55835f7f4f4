"""Eigenvalues of one free element: six zeros, bending that scales with h^3, volume modes that grow with kappa."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import ArrayLike, NDArray

from umform.elements import CATALOGUE, element
from umform.elements.technology import Element
from umform.materials import SVK
from umform.model import Model
from umform.plotting import COLOURS, house_style
from umform.results.shape import Shape
from umform_book.case import Case
from umform_book.linear_algebra import stiffness
from umform_book.page import Page
from umform_book.quality.patches import extruded
from umform_book.variants import SEVEN, VARIANTS, Variant

Floats = NDArray[np.float64]
Options = dict[str, int | bool]

_SQUARE = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))
_DISTORTED = ((0.0, 0.0), (1.05, 0.1), (0.85, 0.8), (-0.15, 0.7))
_WARP = np.array([0.1, -0.1, 0.1, -0.1])
#: Corners in plan and z of the mid-surface.
SHAPES: dict[str, tuple[ArrayLike, ArrayLike]] = {
    "square": (_SQUARE, 0.0),
    "distorted": (_DISTORTED, 0.0),
    "warped": (_SQUARE, _WARP),
    "distorted and warped": (_DISTORTED, _WARP),
}
THICKNESSES = (1e-1, 1e-2, 1e-3, 1e-4)
POISSON = (0.4, 0.49, 0.499, 0.4999)

#: Modes of thin bending: unknowns of the deflection and two rotations, less three rigid motions, less the tied shears.
BENDING_MODES = {"hex8": 12 - 3 - 4, "hex18": 27 - 3 - 12}
#: Part of the bending modes that shear locking removes.
LOCKED = {"hex8": 0.8, "hex18": 0.5}
_SHEAR = "transverse shear locking: the shear strain is not tied"
_BASELINE = "Hauptmann & Schweizerhof 1998; Bucalem & Bathe 1993"
_PIVOT = (
    "round-off: the condensation compares pivots with the largest one, and thickness modes are (l/h)^4 times stiffer"
)
_IN_PLANE = "volumetric locking: no enhanced membrane strain follows the dilatation that is linear in r and s"
_CONSTRAINTS = "Hughes, The Finite Element Method (2000), 4.3; Hauptmann & Schweizerhof 1998"


def single_element(technology: Element, thickness: float, nu: float, shape: str = "square") -> Model:
    """One free element with edges of length 1 and E = 1."""
    corners, z = SHAPES[shape]
    levels = (np.asarray(z) - 0.5 * thickness, np.asarray(z) + 0.5 * thickness)
    mesh = extruded(np.array(corners), [[0, 1, 2, 3]], levels, technology.cell)
    return Model(mesh, technology, material=SVK(E=1.0, nu=nu))


def eigenvalues(model: Model, director: float | None = None) -> Floats:
    """Eigenvalues of the stiffness at u = 0, ascending; NaN if the element cannot be evaluated.

    Parameters
    ----------
    model : Model
        One free element.
    director : float, optional
        Thickness h: the unknowns are then the displacement of the mid-surface and the difference of upper and lower
        displacement over h, which has the size of a rotation.
    """
    evaluation = model.evaluate(model.u)
    K = stiffness(model, evaluation).toarray()
    if evaluation.failed >= 0:
        return np.full(len(K), np.nan)
    if director is not None:
        one = np.eye(len(K) // 2)
        T = np.block([[one, -0.5 * director * one], [one, 0.5 * director * one]])
        K = T.T @ K @ T
    return np.asarray(np.linalg.eigvalsh(K))


# Zero modes -----------------------------------------------------------------------------------------------------------


def every_option(name: str) -> list[Options]:
    """All options of an element of the catalogue."""
    axes: list[list[Options]] = [[{"tie_E33": tied} for tied in (False, True)]]
    if name not in ("DISP3D", "DISP9K3D"):
        counts = (1, 4, 9) if CATALOGUE[name]().cell == "hex18" else (1, 4)
        axes += [[{"thickness_modes": count} for count in counts], [{"thickness_order": p} for p in (1, 2, 3, 4)]]
    if name == "EAS3DEAS":
        axes += [[{"membrane_modes": count} for count in (4, 5, 7)]]
    if name == "MI9K3DEAS":
        axes += [[{"compatible_E12": compatible} for compatible in (False, True)]]
    return [{key: value for part in parts for key, value in part.items()} for parts in product(*axes)]


def zero_modes(name: str, options: Options, shape: str) -> tuple[int, float]:
    """Number of eigenvalues at round-off, and the seventh over the largest."""
    found = eigenvalues(single_element(element(name, **options), 0.3, 0.3, shape))  # type: ignore[arg-type]
    return int((np.abs(found) < 1e-12 * found[-1]).sum()), float(found[6] / found[-1])


def _zeros(page: Page) -> None:
    page.heading("Modes without energy")
    rows = []
    for name in page.each(SEVEN):
        every = every_option(name)
        options = list(page.pick(every, every[:: max(1, len(every) // 4)]))
        found = [zero_modes(name, chosen, shape) for chosen in options for shape in SHAPES]
        counts = [count for count, _ in found]
        rows.append((name, len(options), min(counts), max(counts), min(gap for _, gap in found)))
        page.at_most(f"{name}: free elements with other than six zero modes", sum(n != 6 for n in counts), 0.0)
    columns = ("element", "sets of options", "least zeros", "most zeros", "least 7th eigenvalue over the largest")
    page.table(f"Each on {len(SHAPES)} shapes, h = 0.3", columns, rows)


# Thin elements --------------------------------------------------------------------------------------------------------


def bending_spectrum(variant: Variant, thickness: float) -> Floats:
    """Eigenvalues over h^3 beyond the six rigid ones, in displacements and rotations: of order 1 in bending."""
    model = single_element(variant.element, thickness, 0.3)
    return eigenvalues(model, director=thickness)[6:] / thickness**3


def _thin(page: Page) -> None:
    page.heading("Locking of thin elements")
    spectra = {v: [bending_spectrum(v, h) for h in THICKNESSES] for v in page.each(VARIANTS, lambda v: v.label)}
    counts = {v: [int((s < 10.0).sum()) for s in spectrum] for v, spectrum in spectra.items()}
    page.table(
        "Eigenvalues below 10 E h^3: in the thin element, those of bending",
        ("element", *(f"h = {h:g}" for h in THICKNESSES), "thin plate"),
        [(v.label, *row, BENDING_MODES[v.cell]) for v, row in counts.items()],
    )
    for v, row in counts.items():
        wanted = BENDING_MODES[v.cell]
        if v.name.startswith("DISP"):
            what = f"{v.label}: bending modes at h = {THICKNESSES[-2]:g}"
            page.check(what, row[-2], wanted, 0.0, known=LOCKED[v.cell], cause=_SHEAR, theory=_BASELINE)
            continue
        what = f"{v.label}: bending modes at h = {THICKNESSES[-1]:g}"
        cause = _PIVOT if v.name == "EAS3DEAS" else ""
        page.check(what, row[-1], wanted, 0.0, known=1.0 if cause else 0.0, cause=cause)
        thin, thick = spectra[v][1][:wanted], spectra[v][0][:wanted]
        what = f"{v.label}: largest change of a bending eigenvalue over h^3 from h = 0.1 to 0.01"
        page.at_most(what, float(np.abs(thin / thick - 1).max()), 0.05)
    page.text(
        "Elements with compatible transverse shear lack bending modes: they lock. The change from h = 0.1 to 0.01 is "
        "physical, of order h^2; a locked mode would grow a hundredfold. At h = 1e-4 round-off (E / h against E h^3) "
        "is as large as the bending eigenvalues."
    )
    shown = [Variant(name) for name in ("DISP3DEAS", "ANS3DEAS", "DISP9K3DEAS", "MI9K3DEAS")]
    figure = _spectra(shown, [spectra[v] for v in shown], THICKNESSES, "thickness h", "eigenvalue / E h^3")
    page.figure("thin", figure, "Eigenvalues over h^3: level lines bend, lines that rise to the left are not bending")


# Nearly incompressible elements ---------------------------------------------------------------------------------------


def growing(variant: Variant) -> int:
    """Number of eigenvalues that grow with the bulk modulus, from nu = 0.499 to 0.4999 tenfold."""
    low, high = (eigenvalues(single_element(variant.element, 1.0, nu))[6:] for nu in POISSON[-2:])
    return int((high > 5.0 * low).sum())


def _incompressible(page: Page) -> None:
    page.heading("Locking of nearly incompressible elements")
    rows = []
    for v in page.each(VARIANTS, lambda v: v.label):
        count = growing(v)
        unknowns = 6 if v.cell == "hex8" else 24
        rows.append((v.label, count, unknowns / count))
        if v.name in ("ANS3DEAS", "EAS3DEAS"):
            bound, cause, theory = (3.0, _IN_PLANE, _CONSTRAINTS) if v.name == "ANS3DEAS" else (0.0, "", "")
            page.check(f"{v.label}: modes that grow with kappa", count, 1, 0.0, known=bound, cause=cause, theory=theory)
    page.table(
        "Modes of a cube that grow with the bulk modulus",
        ("element", "modes", "unknowns of a large mesh for each (3 is that of the continuum)"),
        rows,
    )
    page.text(
        "An 8-node hexahedron should have one such mode, the change of volume. 18-node elements have four times the "
        "unknowns, so more modes do not lock."
    )
    shown = [Variant(name) for name in ("DISP3D", "ANS3DEAS", "EAS3DEAS", "MI9K3DEAS")]
    spectra = [[eigenvalues(single_element(v.element, 1.0, nu))[6:] for nu in POISSON] for v in shown]
    figure = _spectra(shown, spectra, [0.5 - nu for nu in POISSON], "1/2 - nu", "eigenvalue / E")
    page.figure("incompressible", figure, "Eigenvalues of a cube: lines that rise to the left change the volume")


def _spectra(
    variants: Sequence[Variant], spectra: Sequence[Sequence[Floats]], x: Sequence[float], xlabel: str, ylabel: str
) -> Figure:
    with house_style():
        figure = Figure(figsize=(7.0, 3.0), layout="constrained")
        all_axes = figure.subplots(1, len(variants), sharey=True)
        for axes, variant, spectrum in zip(all_axes, variants, spectra, strict=True):
            axes.loglog(x, np.abs(np.array(spectrum)), color=COLOURS[0], linewidth=0.8)
            axes.set_title(variant.label)
            axes.set_xlabel(xlabel)
        all_axes[0].set_ylabel(ylabel)
    return figure


def _duties(page: Page) -> None:
    """Requirements on each element, and failures that theory predicts."""
    rows = []
    for name in SEVEN:
        volume = "-" if Variant(name).cell == "hex18" else "must" if name == "EAS3DEAS" else "need not"
        rows.append((name, "must", "need not" if name.startswith("DISP") else "must", volume))
    page.table(
        "Requirements", ("element", "six zero modes", "bending modes of the thin plate", "one volume mode"), rows
    )


def run(page: Page) -> None:
    """Fill the page."""
    _duties(page)
    _zeros(page)
    _thin(page)
    _incompressible(page)
    model = single_element(Variant("ANS3DEAS").element, 0.3, 0.3, "distorted and warped")
    _, modes = np.linalg.eigh(stiffness(model, model.evaluate(model.u)).toarray())
    softest = Shape.displaced(model.mesh, 0.5 * modes[:, 6].reshape(-1, 3))
    page.shape("mode", softest, "Softest mode of a distorted and warped ANS3DEAS")


CASE = Case(
    name="eigenvalues",
    title="Eigenvalues of an element",
    problem="""
One free element with edges of about 1, E = 1, linear at u = 0.

* (a) Zero modes: a square and a distorted quadrilateral, both also warped by 0.1; h = 0.3, nu = 0.3. Zero is below
  1e-12 of the largest eigenvalue.
* (b) Locking: the square, nu = 0.3, h = 1e-1 to 1e-4. The unknowns are the displacement of the mid-surface and the
  difference of both faces over h: a bending eigenvalue scales with E h^3, all others with E h.
* (c) Nearly incompressible: a cube, nu = 0.4 to 0.4999.
""",
    reference="""
Exact: six rigid motions; one change of volume for a hexahedron. Bending modes of the thin plate: unknowns of deflection
and rotations (12 and 27), minus three rigid motions, minus the tied shears (4: Bathe & Dvorkin, Int. J. Numer. Meth.
Engng. 21 (1985) 367-383; 12: Bucalem & Bathe, Int. J. Numer. Meth. Engng. 36 (1993) 3729-3754).
""",
    run=run,
    cost=3.0,
)

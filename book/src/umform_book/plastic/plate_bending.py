"""Pure bending of a wide sheet into the plastic range and back: moment over curvature, and springback."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from umform.materials import J2, Linear, Perfect
from umform.results.shape import Shape
from umform_book.case import Case
from umform_book.convergence import show, study
from umform_book.page import Page
from umform_book.plastic.bent_sheet import THICKNESS, Bent, bend
from umform_book.plastic.curves import lines_figure
from umform_book.plastic.plane_strain import (
    BendingPath,
    bending_path,
    classical_moment,
    plane_strain_modulus,
)
from umform_book.variants import SEVEN, Variant

YIELD_STRESS = 160.0
MODULUS = 2000.0
CURVATURE = 0.04
CONSTANTS = {"kappa": 175000.0, "mu": 80770.0}
LAWS = {
    "perfect": J2(**CONSTANTS, hardening=Perfect(YIELD_STRESS)),
    "hardening": J2(**CONSTANTS, hardening=Linear(YIELD_STRESS, MODULUS)),
}
SLOPES = {"perfect": 0.0, "hardening": MODULUS}

ORDER_3 = {"thickness_order": 3, "tie_E33": True}
RECOMMENDED = tuple(Variant(name, ORDER_3, "order 3, E_33 tied") for name in ("ANS3DEAS", "MI9K3DEAS"))
FIRST_ORDER = tuple(Variant(name) for name in ("ANS3DEAS", "EAS3DEAS", "MI9K3DEAS"))
POINTS = 10


def locking(strain: float) -> float:
    """Excess of the moment at thickness order 1 over the plastic one, at a strain of the outer fibre. eq. (2.29)"""
    return float(np.sqrt(3.0) * 2.0 / 5.0 * CONSTANTS["kappa"] / YIELD_STRESS * strain**3)


def run(page: Page) -> None:
    """Fill the page."""
    paths = {name: bending_path(law, THICKNESS, CURVATURE) for name, law in LAWS.items()}
    _references(page, paths)
    for name, path in paths.items():
        _one_law(page, name, path)


def _one_law(page: Page, name: str, path: BendingPath) -> None:
    bent: dict[tuple[Variant, int], Bent] = {}

    def moment(variant: Variant, divisions: int) -> float:
        cells = variant.cells(divisions)
        label = f"{name}, {variant.label}, {divisions} intervals"
        found = bend(page, label, variant, cells, LAWS[name], path, points=POINTS, rule="split", frames=1)
        bent[variant, divisions] = found
        return float(found.moment[-1] / path.moment[-1])

    variants = page.pick((*(Variant(name) for name in SEVEN), *RECOMMENDED), (*FIRST_ORDER, *RECOMMENDED))
    found = study(page, variants, page.pick((2, 4, 8), (2, 4)), moment)
    show(page, f"moment-{name}", f"moment at an outer strain of 2 % over the reference, {name}", found)
    whole = CURVATURE - path.residual_curvature
    springback = {v: {n: (CURVATURE - bent[v, n].residual_curvature) / whole for n in row} for v, row in found.items()}
    show(page, f"springback-{name}", f"springback of the curvature over the reference, {name}", springback)
    finest = max(found[variants[0]])
    _judge(page, name, path, bent, finest)
    _pictures(page, name, path, bent, finest)
    if not page.short:
        locked = found[Variant("DISP3D")][finest]
        page.text(
            "Without an enhanced thickness strain (DISP3D, DISP9K3D) plastic flow cannot keep the volume: the moment "
            f"is {locked:.0f} times the true one, and unloading does not bring it to zero. At this strain thickness "
            f"order 1 is {100 * (found[FIRST_ORDER[0]][finest] - 1):+.2f} % off ({100 * locking(0.02):.2f} % by eq. "
            f"(2.29)), order 3 {100 * (found[RECOMMENDED[0]][finest] - 1):+.2f} %."
        )


def _references(page: Page, paths: dict[str, BendingPath]) -> None:
    """The numerical reference beside the classical closed form."""
    first_yield = 4.0 / np.sqrt(3.0) * YIELD_STRESS / (plane_strain_modulus(LAWS["perfect"]) * THICKNESS)
    rows = []
    for multiple in (1.0, 1.5, 2.0, 3.0, 5.0, 10.0, CURVATURE / first_yield):
        for name, path in paths.items():
            k = multiple * first_yield
            numerical = float(np.interp(k, path.curvature, path.moment))
            closed = classical_moment(LAWS[name], SLOPES[name], THICKNESS, k)
            rows.append((f"{multiple:.3g}", name, numerical, closed, 100.0 * (closed / numerical - 1.0)))
    page.table(
        "Moment of the law integrated point by point, and of the classical theory",
        ("curvature over that of first yield", "law", "point by point", "classical", "difference in %"),
        rows,
    )
    worst = max(abs(float(row[-1])) for row in rows)
    page.text(
        "In the classical theory a fibre always flows at 2/sqrt(3) y. At first it flows at less, since sigma_22 is nu "
        f"sigma_11 and reaches half of sigma_11 only when plastic strain dominates: {worst:.1f} % of the moment at "
        "most, in the knee. Everything below is compared with the law point by point."
    )
    for name, path in paths.items():
        closed = classical_moment(LAWS[name], SLOPES[name], THICKNESS, CURVATURE)
        page.check(f"reference against the classical moment at 2 %, {name}", path.moment[-1], closed, within=0.002)
        straight = closed * 12.0 / (plane_strain_modulus(LAWS[name]) * THICKNESS**3)
        what = f"reference against the classical springback, {name}"
        page.check(what, CURVATURE - path.residual_curvature, straight, within=0.005)


def _judge(page: Page, name: str, path: BendingPath, bent: dict[tuple[Variant, int], Bent], finest: int) -> None:
    for variant in (*FIRST_ORDER, *RECOMMENDED):
        found = bent[variant, finest]
        for strain in (0.005, 0.01, 0.02):
            excess = locking(strain) if variant in FIRST_ORDER else 0.0
            k = 2.0 * strain / THICKNESS
            reference = float(np.interp(k, path.curvature, path.moment))
            moment = float(np.interp(k, found.curvature, found.moment))
            what = f"moment at an outer strain of {100 * strain:g} %, {name}, {variant.label}, {finest} intervals"
            page.check(what, moment, reference, within=0.005 + excess)
        excess = locking(0.02) if variant in FIRST_ORDER else 0.0
        what = f"springback, {name}, {variant.label}, {finest} intervals"
        springback = CURVATURE - found.residual_curvature
        page.check(what, springback, CURVATURE - path.residual_curvature, within=0.01 + excess)
    squash = max(float(np.abs(bent[v, finest].force).max()) for v in (*FIRST_ORDER, *RECOMMENDED))
    squash /= 2.0 / np.sqrt(3.0) * YIELD_STRESS * THICKNESS
    page.at_most(f"force along the sheet over its yield force, {name}", squash, 0.025)


def _pictures(page: Page, name: str, path: BendingPath, bent: dict[tuple[Variant, int], Bent], finest: int) -> None:
    first, best = bent[FIRST_ORDER[0], finest], bent[RECOMMENDED[0], finest]
    whole = (np.append(path.curvature, path.curvature_back), np.append(path.moment, path.moment_back))
    ks = np.linspace(1e-4, CURVATURE, 200)
    classical = np.array([classical_moment(LAWS[name], SLOPES[name], THICKNESS, k) for k in ks])
    y = "moment per width"
    figure = lines_figure(
        "curvature",
        {
            y: {
                "classical theory": (ks, classical),
                FIRST_ORDER[0].label: (first.curvature, first.moment),
                RECOMMENDED[0].label: (best.curvature, best.moment),
            }
        },
        references={y: {"point by point": whole}},
    )
    page.figure(f"curve-{name}", figure, f"Moment over curvature and unloading, {name}")
    shape = Shape.of(first.result)
    X = first.result.model.mesh.points
    enlarged = replace(shape, points=X + 10.0 * (shape.points - X))
    caption = f"Sheet without moment, displacements 10 times enlarged, {name}"
    page.shape(f"shape-{name}", enlarged, caption, values="plastic_strain_max", view=(-100.0, 12.0))


CASE = Case(
    name="plastic-plate-bending",
    title="Plastic bending of a wide sheet, and springback",
    problem=f"""
A wide sheet, h = {THICKNESS:g}, plane strain, bent to the curvature {CURVATURE:g} (2 % strain in the outer fibres) and
back to zero moment. kappa = {CONSTANTS["kappa"]:g}, mu = {CONSTANTS["mu"]:g}, yield stress {YIELD_STRESS:g}, without
hardening and with the linear modulus {MODULUS:g} (N, mm). A piece of length 2 between a symmetry plane and a section
whose edges move horizontally as on an arc, with a mid-line of constant length; vertical displacements are free.
{POINTS} thickness points, split rule; 40 increments up, 3 back. Measured: moment (work conjugate of the curvature), and
curvature left without moment.
""",
    reference="""
The law in logarithmic strains, integrated point by point in numpy: plane strain, sigma_33 = 0, 1000 fibres, 150
increments (40 change the moment by 1e-5), no axial force. Beside it the classical closed form (Hill 1950: elastic core
with E' = E/(1 - nu^2), flow stress 2/sqrt(3) y, elastic unloading). Both neglect the pressure through the sheet
(curvature times moment) and the square of the strain: 0.1 % here. Thickness order 1 has the excess moment of eq.
(2.29), which is part of its limit.
""",
    run=run,
    picture="curve-hardening",
    cost=6.0,
)

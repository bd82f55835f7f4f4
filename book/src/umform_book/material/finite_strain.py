"""Logarithmic space: the multiplicative J2 as a special case, simple shear, tangents, a sheet that is turned."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import umform as uf
from umform.materials import J2, Chaboche, Hardening, Metal, Perfect, Swift, Voce, YoshidaUemori
from umform.materials.material import Material
from umform_book.case import Case
from umform_book.metals import CARDS, SPCC, SPCC_YIELD, STEEL, YIELD_FUNCTIONS
from umform_book.page import Page
from umform_book.plastic.curves import lines_figure
from umform_book.variants import Variant

Floats = NDArray[np.float64]

KINDS = ("ANS3DEAS", "EAS3DEAS", "BEND8", "MI9K3DEAS", "BEND18")
#: Range of residuals from which an order is computed.
_ROUND_OFF, _NEAR = 1e-13, 0.1
VOCE, SWIFT = Voce(130.0, 300.0, 12.0), Swift(500.0, 0.004, 0.21)
_PAIRS = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)]
#: An oblique rotation.
_AXIS, _ANGLE = np.array([0.36, -0.48, 0.8]), 1.1


def run(page: Page) -> None:
    """Fill the page."""
    _without_turning(page)
    _simple_shear(page)
    _tangents(page)
    _return_maps(page)
    _turned_sheet(page)


def green_lagrange(F: Floats) -> Floats:
    """Strain of a deformation gradient, engineering shears."""
    E = 0.5 * (F.T @ F - np.eye(3))
    return np.array([E[i, j] * (1.0 if i == j else 2.0) for i, j in _PAIRS])


def rotation(axis: Floats, angle: float) -> Floats:
    """Rotation about a unit vector, after Rodrigues."""
    W = np.array([[0.0, -axis[2], axis[1]], [axis[2], 0.0, -axis[0]], [-axis[1], axis[0], 0.0]])
    return np.asarray(np.eye(3) + np.sin(angle) * W + (1.0 - np.cos(angle)) * W @ W)


def both(hardening: Hardening) -> tuple[Material, Material]:
    """The multiplicative J2, and von Mises in logarithmic space."""
    return J2(**STEEL, hardening=hardening), Metal(**STEEL, hardening=hardening)


def stresses(material: Material, gradients: list[Floats]) -> Floats:
    """Second Piola-Kirchhoff stresses along a path, shape (n, 6)."""
    law, rows = material.law(), []
    state = law.initial()[None]
    for F in gradients:
        S, _, state = law.respond(green_lagrange(F)[None], state)
        rows.append(S[0])
    return np.array(rows)


def _without_turning(page: Page) -> None:
    page.heading("Principal axes that do not turn")
    Q, rng = rotation(_AXIS, _ANGLE), np.random.default_rng(3)
    for size in (1e-3, 0.02, 0.3):
        path = [np.asarray(Q @ np.diag(np.exp(size * rng.normal(size=3))) @ Q.T) for _ in range(6)]
        one, other = (stresses(law, path) for law in both(Swift(500.0, 0.004, 0.21)))
        error = float(np.abs(other - one).max() / np.abs(one).max())
        page.at_most(f"strains of {size:g}, six increments: largest difference of the stress, over it", error, 1e-10)


def _simple_shear(page: Page) -> None:
    page.heading("Simple shear")
    shear = np.linspace(0.0, 3.0, 151)
    gradients = [np.array([[1.0, g, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]) for g in shear[1:]]
    lines: dict[str, tuple[Floats, Floats]] = {}
    curves = []
    for name, law in zip(("multiplicative J2", "logarithmic space"), both(Perfect(160.0)), strict=True):
        tau = [F @ _tensor(S) @ F.T for F, S in zip(gradients, stresses(law, gradients), strict=True)]
        curves.append(np.array([0.0, *(t[0, 1] for t in tau)]))
        lines[name] = shear, curves[-1]
    page.figure("shear", lines_figure("shear", {"Kirchhoff shear stress, MPa": lines}), "Simple shear, no hardening")
    far = [
        abs(float(np.interp(g, shear, curves[1] / np.where(curves[0] == 0, 1, curves[0]))) - 1.0)
        for g in (0.1, 1.0, 2.0)
    ]
    page.table(
        "Shear stress in logarithmic space minus that of J2, %",
        ("shear 0.1", "1", "2"),
        [tuple(f"{100 * value:.2f}" for value in far)],
    )
    page.at_most("shear of 0.1: difference of the two", far[0], 2e-3)
    page.check(
        "shear of 2: J2 stays at y / sqrt 3", float(np.interp(2.0, shear, curves[0])), 160.0 / np.sqrt(3.0), 0.01
    )
    page.text(
        "If the axes of strain turn relative to the sheet, the plastic strain of logarithmic space does not follow, "
        "that of J2 does. The difference is small up to a shear of one, far more than in sheet forming."
    )


def _tensor(v: Floats) -> Floats:
    return np.asarray(v[[[0, 3, 5], [3, 1, 4], [5, 4, 2]]])


def _tangents(page: Page) -> None:
    page.heading("Tangents by differences")
    rng = np.random.default_rng(5)
    for name, metal in CARDS.items():
        law = metal.law()
        state, E = np.tile(law.initial(), (4, 1)), np.zeros((4, 6))
        worst = 0.0
        for _ in range(3):  # a path that turns
            steps = rng.normal(size=(4, 6))
            E = E + 0.03 * steps / np.linalg.norm(steps, axis=1)[:, None]
            _, tangent, after = law.respond(E, state)
            worst = max(worst, float(np.abs(_differences(law, E, state) - tangent).max() / np.abs(tangent).max()))
            state = after
        page.at_most(f"{name}: tangent against differences of fourth order, over its largest entry", worst, 1e-7)


def _differences(law: uf._core.Material, E: Floats, state: Floats, step: float = 1e-6) -> Floats:
    columns = []
    for e in np.eye(6):
        one, two = (law.respond(E + k * step * e, state)[0] - law.respond(E - k * step * e, state)[0] for k in (1, 2))
        columns.append((8.0 * one - two) / (12.0 * step))
    return np.stack(columns, axis=2)


def _return_maps(page: Page) -> None:
    page.heading("Newton's method of the return maps")
    hardening: dict[str, tuple[Hardening, Chaboche | YoshidaUemori | None]] = {
        "Voce": (VOCE, None),
        "Swift": (SWIFT, None),
        "Voce, Prager": (VOCE, Chaboche(((2000.0, 0.0),))),
        "Voce, Chaboche(2)": (VOCE, Chaboche(((9000.0, 120.0), (800.0, 8.0)))),
        "two surfaces": (SPCC_YIELD, SPCC),
    }
    rows: list[tuple[str | float | None, ...]] = []
    short, slowest = [], 0
    for name, function in YIELD_FUNCTIONS.items():
        row: list[str | float | None] = [name]
        for curve, back in hardening.values():
            metal = Metal(**STEEL, hardening=curve, yield_function=function, back_stress=back)
            orders, iterations = _orders(metal, count=page.pick((60,), (12,))[0])
            slowest = max(slowest, iterations)
            row.append(float(np.median(orders)) if orders else None)
            if orders:
                short.append(max(0.0, 2.0 - float(np.median(orders))))
        rows.append(tuple(row))
    title = "Median order of the last steps, log(r3 / r2) / log(r2 / r1) of the residuals r"
    page.table(title, ("yield function", *hardening), rows)
    page.at_most("return maps: median order below 2, the worst combination", max(short), 0.15)
    page.text(
        f"Increments of 0.1 to 10 % after one of 2 % in another direction. The slowest took {slowest} iterations. "
        "A dash: the scalar equation is so nearly linear that no three residuals lie above round-off."
    )


def _orders(metal: Metal, count: int) -> tuple[list[float], int]:
    """Orders from the last three residuals above round-off of random increments, and the most iterations."""
    rng, law = np.random.default_rng(2), metal.small_strain_law()
    ways = rng.normal(size=(2, count, 6))
    ways /= np.linalg.norm(ways, axis=2)[:, :, None]
    before = 0.02 * ways[0]
    states = law.respond(before, np.tile(law.initial(), (count, 1)))[2]
    sizes = np.exp(rng.uniform(np.log(1e-3), np.log(0.1), size=count))
    orders, most = [], 0
    for strain, state, change in zip(before, states, sizes[:, None] * ways[1], strict=True):
        residuals = metal.residuals(strain + change, state)
        most = max(most, len(residuals) - 1)
        usable = residuals[residuals > _ROUND_OFF]
        if len(usable) >= 3 and usable[-3] < _NEAR:
            orders.append(float(np.log(usable[-1] / usable[-2]) / np.log(usable[-2] / usable[-3])))
    return orders, most


def _turned_sheet(page: Page) -> None:
    page.heading("A sheet that is turned")
    F = np.array([[1.03, 0.02, 0.01], [0.0, 0.99, 0.0], [0.01, 0.0, 0.98]])
    Q = rotation(_AXIS, _ANGLE)
    metal = CARDS["AA2090-T3 with Chaboche"]
    for kind in page.pick(KINDS, KINDS[:1]):
        forces = []
        for mesh_turn, space_turn in ((np.eye(3), np.eye(3)), (Q, np.eye(3)), (np.eye(3), Q)):
            flat = uf.mesh.strip(length=1.0, width=1.0, thickness=0.2, cells=(1, 1), cell=Variant(kind).cell)
            X = flat.points @ mesh_turn.T
            model = uf.Model(
                uf.Mesh(X, flat.cells), kind, material=metal, rolling=mesh_turn @ np.array([0.8, 0.6, 0.0])
            )
            x = (flat.points @ F.T) @ mesh_turn.T @ space_turn.T
            forces.append(model.evaluate((x - X).ravel()).residual.reshape(-1, 3) @ space_turn @ mesh_turn)
        size = np.abs(forces[0]).max()
        what = f"{kind}: forces of a plastic sheet"
        page.at_most(
            f"{what}, mesh and rolling direction turned", float(np.abs(forces[1] - forces[0]).max() / size), 1e-9
        )
        page.at_most(f"{what}, turned while it is stretched", float(np.abs(forces[2] - forces[0]).max() / size), 1e-9)


CASE = Case(
    name="material-finite-strain",
    title="Logarithmic space, tangents, objectivity",
    problem="""
* Von Mises in logarithmic space beside the multiplicative J2: paths with fixed principal axes, and simple shear.
* Tangents of all laws of this chapter on rotating paths, increments of 3 %.
* Residuals of the Newton method inside the return map, each yield function with each kind of hardening.
* One element of AA2090-T3 with Chaboche, stretched and sheared into the plastic range: original, with mesh and rolling
  direction turned, and with a superposed rotation.
""",
    reference="""
The multiplicative J2 (theory 3.4), another kernel; differences of fourth order of the stress; the forces of the sheet
that is not turned.
""",
    own="the multiplicative J2 is umform's own, checked in the chapter on plasticity",
    run=run,
    cost=5.0,
)

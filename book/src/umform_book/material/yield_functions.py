"""Yield functions at a point, and in one element that is pulled at an angle to the rolling direction."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

import umform as uf
from umform.materials import Metal, Perfect, YieldFunction, tension
from umform_book.case import Case
from umform_book.metals import AA2090, AA6111, MILD, YIELD_FUNCTIONS
from umform_book.page import Page
from umform_book.plastic.curves import lines_figure
from umform_book.references import table
from umform_book.variants import Variant

Floats = NDArray[np.float64]

ANGLES = (0, 15, 30, 45, 60, 75, 90)
KINDS = ("ANS3DEAS", "EAS3DEAS", "BEND8", "MI9K3DEAS", "BEND18")
#: Strain that a bar is pulled to, of a metal whose yield strain is a hundredth of it.
_STRAIN = 1e-4


def run(page: Page) -> None:
    """Fill the page."""
    _states(page)
    _tables(page)
    _convexity(page)
    _elements(page)


def _states(page: Page) -> None:
    page.heading("Yld2004 at four states")
    known, function = table("yld2004_point_values.csv"), AA2090.function()
    stresses = np.stack([known[f"s{c}"] for c in ("xx", "yy", "zz", "xy", "yz", "xz")], axis=1)
    for stress, equivalent in zip(stresses, known["sig_eq"], strict=True):
        page.check(f"equivalent stress at {stress.tolist()}", function(stress)[0], equivalent, 1e-12)
    gradient = np.array([known[f"g{c}"][-1] for c in ("xx", "yy", "zz", "xy", "yz", "xz")])
    error = function(stresses[-1])[1] - gradient * [1, 1, 1, 2, 2, 2]
    page.at_most("gradient at the last of them, largest error of a component", float(np.abs(error).max()), 1e-12)


def _tables(page: Page) -> None:
    page.heading("Yield stresses and r-values over the angle, at a point")
    known = table("yld2004_directional.csv")
    rows: list[tuple[str | float, ...]] = []
    for number, function in ((2090, AA2090), (6111, AA6111)):
        chosen = known["metal"] == number
        worst = 0.0
        for angle, stress, r in zip(*(known[c][chosen] for c in ("angle", "stress", "r")), strict=True):
            found = bar(function, float(angle))
            worst = max(worst, abs(found[0] - stress), abs(found[1] - r))
            rows.append((f"AA{number}", f"{angle:g}", found[0], float(stress), found[1], float(r)))
        page.at_most(f"AA{number}: largest error of a yield stress or r-value, printed to 5 digits", worst, 1.5e-5)
    columns = ("metal", "angle", "stress", "reference", "r", "reference")
    page.table("A bar that is pulled at a point", columns, rows)
    for angle, r in ((0, 1.79), (45, 1.51), (90, 2.27)):
        page.check(f"Hill48 of the mild steel: r at {angle} degrees", bar(MILD, angle)[1], r, 1e-6)


def bar(function: YieldFunction, angle: float) -> tuple[float, float]:
    """Yield stress over that of the curve and r-value of a bar at an angle to the rolling direction."""
    _, stress, plastic = tension(_metal(function), np.linspace(_STRAIN / 10, _STRAIN, 10), angle)
    return float(stress[-1]), float(plastic[-1, 1] / plastic[-1, 2])


def _metal(function: YieldFunction) -> Metal:
    return Metal(E=1e6, nu=0.3, hardening=Perfect(1.0), yield_function=function)


def _convexity(page: Page) -> None:
    page.heading("Convexity")
    rng = np.random.default_rng(4)
    pairs = rng.normal(size=(page.pick((2000,), (200,))[0], 2, 6))
    for name, described in YIELD_FUNCTIONS.items():
        function = described.function()
        above = -math.inf
        for a, b in pairs:
            (value, gradient), (other, _) = function(a), function(b)
            middle = function(0.5 * (a + b))[0]
            above = max(above, middle / (0.5 * (value + other)) - 1.0, float(gradient @ b) / other - 1.0)
        page.at_most(
            f"{name}: how far a middle, or a tangent plane, lies outside of the surface", max(above, 0.0), 1e-12
        )


def pulled(page: Page, kind: str, function: YieldFunction, angle: float) -> tuple[float, float]:
    """The same of one element between two planes, free to shear."""
    variant = Variant(kind)
    cube = uf.mesh.strip(length=1.0, width=1.0, thickness=1.0, cells=(1, 1), cell=variant.cell)
    turn = math.radians(angle)
    model = uf.Model(cube, kind, material=_metal(function), rolling=(math.cos(turn), -math.sin(turn), 0.0))
    model.symmetry("x0", "x")
    model.symmetry("lower", "z")
    model.fix(np.intersect1d(cube.nodes("x0"), cube.nodes("y0")), "y")
    pull = model.prescribe("x1", "x", "pull")
    result = page.solve(f"{kind}, {angle:g} degrees", model, uf.Move(pull, to=_STRAIN, steps=4))
    p = uf.fields.point_fields(model).history["plastic_strain"][0].mean(axis=0)
    c, s = math.cos(turn), math.sin(turn)
    across = s * s * p[0] + c * c * p[1] - s * c * p[3]
    return float(result["pull_force"][-1]), float(across / p[2])


def _elements(page: Page) -> None:
    page.heading("One element, pulled at an angle")
    lines: dict[str, dict[str, tuple[Floats, Floats]]] = {"yield stress": {}, "r-value": {}}
    rows: list[tuple[str | float, ...]] = []
    for name in page.each(page.pick(list(YIELD_FUNCTIONS), ["Yld2004, AA2090-T3"])):
        kinds = page.pick(KINDS if name == "Yld2004, AA2090-T3" else KINDS[:1], KINDS[:1])
        for kind in kinds:
            found = np.array([pulled(page, kind, YIELD_FUNCTIONS[name], angle) for angle in ANGLES])
            point = np.array([bar(YIELD_FUNCTIONS[name], angle) for angle in ANGLES])
            rows += [(f"{name}, {kind}", f"{a}", *map(float, values)) for a, values in zip(ANGLES, found, strict=True)]
            stress, r = np.abs(found / point - 1.0).max(axis=0)
            page.at_most(f"{name}, {kind}: yield stress against the point, seven angles", float(stress), 3e-4)
            page.at_most(f"{name}, {kind}: r-value against the point, seven angles", float(r), 2e-3)
        for k, what in enumerate(lines):
            lines[what][name] = np.array(ANGLES, dtype=float), found[:, k]
    page.table("From one element", ("yield function, element", "angle", "stress", "r"), rows)
    page.figure(
        "angle", lines_figure("angle to the rolling direction", lines), "Yield stress and r-value from one element"
    )


CASE = Case(
    name="material-yield-functions",
    title="Yield functions: states, directions, convexity",
    problem="""
Mises, Hill48, Hosford, Yld91 and Yld2004-18p (AA2090-T3 and AA6111-T4 of Barlat et al. 2005): given states of stress; a
point pulled at 0 to 90 degrees to the rolling direction; and one element pulled likewise, a cube between two planes,
free to shear, without hardening, yield strain a hundredth of the strain.
""",
    reference="""
Four states and a gradient of Yld2004 to 20 digits: test of the library MUSCLE (M. Pacheco-Alarcon). Directional values:
an independent program, five digits, from the coefficients of the paper. r-values of the mild steel: those that define
the function. Element: the point, up to the strain of 1e-4 that rotates it. Convexity: the middle of two states, and the
tangent plane, for 2000 random pairs.
""",
    run=run,
    cost=10.0,
)

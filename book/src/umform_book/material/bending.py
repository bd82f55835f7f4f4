"""Bending and springback of a wide sheet with each hardening law: one bend and bend-unbend-rebend, with tension too."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.analysis.steps import Move
from umform.materials import Metal
from umform_book.case import Case
from umform_book.material.fibres import Fibres, path_of
from umform_book.metals import HARDENING
from umform_book.page import Page
from umform_book.plastic.bent_sheet import LENGTH, THICKNESS, WIDTH, end_section, model_of
from umform_book.plastic.curves import lines_figure
from umform_book.plastic.plane_strain import zero_moment
from umform_book.variants import Variant

Floats = NDArray[np.float64]
Corners = Sequence[tuple[float, float]]

CURVATURE, STRETCH = 0.06, 1.01
#: Corners of stretch of the mid-line and curvature.
PATHS: dict[str, Corners] = {
    "bend": [(1.0, CURVATURE)],
    "bend, unbend, rebend": [(1.0, CURVATURE), (1.0, 0.0), (1.0, CURVATURE)],
    "bend under tension": [(STRETCH, 0.0), (STRETCH, CURVATURE)],
}
ELEMENTS = ("BEND8", "BEND18")
CELLS = {"BEND8": 4, "BEND18": 2}
INCREMENTS = 48
#: Part of the curvature that the way back takes at least, in curvatures of elastic unloading.
_BACK = 1.5


@dataclass(frozen=True)
class Bent:
    """Arrays over the increments; the last corner is the unloading.

    Attributes
    ----------
    curvature, force, moment : ndarray
        Per width.
    corners : ndarray of int
        Rows at the corners.
    """

    curvature: Floats
    force: Floats
    moment: Floats
    corners: list[int]

    def at(self, corner: int) -> float:
        """Moment at a corner."""
        return float(self.moment[self.corners[corner]])

    @property
    def released(self) -> float:
        """Curvature without moment after the last corner."""
        last = self.corners[-2]
        return zero_moment(self.curvature[last:], self.moment[last:])


def with_way_back(metal: Metal, corners: Corners, moment: float) -> Corners:
    """The corners, and one more beyond the curvature without moment."""
    stretch, curvature = corners[-1]
    modulus = metal.E / (1.0 - metal.nu**2) * (0.7 if metal.modulus is not None else 1.0)
    return [*corners, (stretch, curvature - _BACK * moment / (modulus * THICKNESS**3 / 12.0))]


def reference(metal: Metal, corners: Corners) -> tuple[Bent, Corners]:
    """Fibres along the corners and back, and all corners."""
    section = Fibres(metal, THICKNESS)
    k, N, M = path_of(section, corners, INCREMENTS)
    whole = with_way_back(metal, corners, float(M[-1]))
    section = Fibres(metal, THICKNESS)
    k, N, M = path_of(section, whole, INCREMENTS)
    return Bent(k, N, M, [INCREMENTS * (n + 1) for n in range(len(whole))]), whole


def bend_element(page: Page, label: str, name: str, metal: Metal, corners: Corners) -> Bent:
    """A few elements between two sections along the same corners."""
    variant = Variant(name)
    chords = CELLS[name] if variant.cell == "hex8" else 0
    points, rule = variant.element.plastic_rule
    model, edges = model_of(variant, CELLS[name], metal, points, rule)

    def side(start: tuple[float, float], end: tuple[float, float], which: int) -> Callable[[float], float]:
        return lambda part: _edges(tuple(a + part * (b - a) for a, b in zip(start, end, strict=True)), chords)[which]

    steps, last = [], (1.0, 0.0)
    for corner in corners:
        steps.append(Move(edges, [side(last, corner, which) for which in (0, 1)], steps=INCREMENTS))
        last = corner
    result = page.solve(label, model, steps)
    time = result["time"]
    ways = np.array([(1.0, 0.0), *corners])
    stretch, curvature = (np.interp(time, np.arange(len(ways)), ways[:, k]) for k in (0, 1))
    forces = np.stack([result["lower_force"], result["upper_force"]], axis=1) / WIDTH
    by_curvature = np.array([_slope(s, k, chords) for s, k in zip(stretch, curvature, strict=True)])
    rows = [int(np.flatnonzero(time <= n + 1 + 1e-9)[-1]) for n in range(len(corners))]
    return Bent(curvature, forces.sum(axis=1), np.einsum("ij,ij->i", forces, by_curvature), rows)


def _edges(corner: tuple[float, ...], chords: int) -> tuple[float, float]:
    """Displacements of the lower and the upper edge: those of the arc, of a mid-line that is stretched."""
    stretch, curvature = corner
    lower, upper = end_section(curvature / stretch, chords, LENGTH * stretch)
    return lower + LENGTH * (stretch - 1.0), upper + LENGTH * (stretch - 1.0)


def _slope(stretch: float, curvature: float, chords: int, d: float = 1e-6) -> Floats:
    up, down = (_edges((stretch, curvature + e), chords) for e in (d, -d))
    return np.subtract(up, down) / (2.0 * d * LENGTH)


def run(page: Page) -> None:
    """Fill the page."""
    names = page.pick(list(HARDENING), ["Yoshida-Uemori"])
    _own(page)
    rows: list[tuple[str | float, ...]] = []
    curves: dict[str, dict[str, tuple[Floats, Floats]]] = {}
    for name in page.each(names):
        for path, corners in page.pick(list(PATHS.items()), list(PATHS.items())[:1]):
            exact, whole = reference(HARDENING[name], corners)
            curves.setdefault(path, {})[name] = exact.curvature, exact.moment
            for element in page.pick(ELEMENTS if path == "bend" else ELEMENTS[:1], ELEMENTS[:1]):
                label = f"{name}, {path}, {element}"
                found = bend_element(page, label, element, HARDENING[name], whole)
                errors = [found.at(k) / exact.at(k) - 1.0 for k in range(len(corners)) if corners[k][1] > 0.0]
                springback = (CURVATURE - found.released) / (CURVATURE - exact.released)
                rows.append((label, exact.at(-2), 100.0 * errors[-1], exact.released, 100.0 * (springback - 1.0)))
                page.at_most(f"{label}: moment, largest error at the corners", max(map(abs, errors)), 0.01)
                page.check(f"{label}: springback of the curvature", springback, 1.0, 0.02)
    columns = ("run", "moment, N", "error, %", "curvature after release, 1/mm", "error of the springback, %")
    page.table(f"Bent to {CURVATURE:g}/mm: fibres, and errors of the elements", columns, rows)
    for path, lines in curves.items():
        figure = lines_figure("curvature, 1/mm", {"moment per width, N": lines})
        page.figure(path.replace(",", "").replace(" ", "-"), figure, f"{path.capitalize()}: fibres")


def _own(page: Page) -> None:
    """Convergence of the reference."""
    for name in page.pick(list(HARDENING), ["Yoshida-Uemori"]):
        corners = [(1.0, CURVATURE), (1.0, 0.5 * CURVATURE)]
        coarse, fine = (
            path_of(Fibres(HARDENING[name], THICKNESS, step, count), corners, INCREMENTS)[2][[INCREMENTS, -1]]
            for step, count in ((1e-4, 200), (5e-5, 300))
        )
        for what, a, b in zip(("bent", "half unbent"), coarse, fine, strict=True):
            page.check(f"fibres, {name}, {what}: moment against half the step and more fibres", a, b, 0.001)


CASE = Case(
    name="material-bending",
    title="Bending and springback with each hardening law",
    problem=f"""
A wide sheet, h = {THICKNESS:g} mm, steel SPCC, plane strain, bent to the curvature {CURVATURE:g}/mm (3 % strain in the
outer fibres): once; bent, straightened and bent again; stretched by 1 % first and bent at constant length of the
mid-line, as under tension. Then released to zero moment. Laws: isotropic hardening, Chaboche with two back stresses,
Yoshida-Uemori, the last also with a modulus that falls from 206 to 152 GPa. A piece of 2 mm between two sections,
default points and orders.
""",
    reference="""
200 fibres of the same law: rate equations in principal logarithmic strains with sigma_33 = 0, explicit midpoint rule in
steps of 1e-4 of strain (numpy), without a return map. It neglects the pressure through the sheet, some 0.1 % here.
""",
    run=run,
    cost=40.0,
)

"""Stretching over a hemispherical punch, without and with friction, compared with a membrane."""

from __future__ import annotations

from typing import Any

import numpy as np

from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.drawing.hemisphere import (
    CLAMP,
    PUNCH,
    SHOULDER,
    STROKES,
    THICKNESS,
    WITHIN,
    Dome,
    Floats,
    Setup,
    made,
    reference,
)
from umform_book.drawing.membrane import Stretched
from umform_book.page import Page

FRICTION = (0.0, 0.3)
MESHES = {
    "BEND18, 8 mm": Setup(4, 8.0),
    "BEND18, 6 mm": Setup(6, 6.0),
    "BEND18, 4 mm": Setup(8, 4.0),
    "ANS3DEAS, 4 mm": Setup(6, 4.0, "ANS3DEAS"),
    "ANS3DEAS, 3 mm": Setup(8, 3.0, "ANS3DEAS"),
    "ANS3DEAS, 2 mm": Setup(12, 2.0, "ANS3DEAS"),
}
_FINEST = {"BEND18": "BEND18, 4 mm", "ANS3DEAS": "ANS3DEAS, 2 mm"}
#: Variants of a mesh.
_BUDGET = {
    ("BEND18, 6 mm", "penalty 4e4"): Setup(6, 6.0, penalty=4e4),
    ("BEND18, 6 mm", "8 increments in each 6 mm"): Setup(6, 6.0, increments=8),
    ("ANS3DEAS, 3 mm", "contact at the nodes"): Setup(8, 3.0, "ANS3DEAS", points="nodes"),
    ("ANS3DEAS, 3 mm", "slip 2e-5 mm"): Setup(8, 3.0, "ANS3DEAS", slip=2e-5),
}
#: Known misses of strains with 8-node elements: without friction, and with.
_KNOWN = {0.0: 0.03, 0.3: 0.06}
_CAUSE = (
    "flat elements: the error falls with their size, and curved elements do not have it with a third of the number; "
    "contact points and slip have no effect (budget). Near the largest tension that the metal can carry, a small "
    "change of tension is a large change of strain"
)


def deviation(dome: Dome, exact: Stretched, row: int = -1) -> Floats:
    """Thickness strain minus that of the membrane, of the cells over the punch and between the tools."""
    inside = dome.place < WITHIN
    off: Floats = dome.thickness[row][inside] - np.interp(dome.place[inside], exact.place, exact.thickness[row])
    return off


def run(page: Page) -> None:
    """Fill the page."""
    if page.short:
        _short(page)
        return
    exact = {mu: reference(mu) for mu in FRICTION}
    _reference_alone(page, exact)
    found: dict[tuple[float, str], Dome] = {}
    for mu in FRICTION:
        for label in page.each(MESHES):
            found[mu, label] = made(page, f"mu = {mu:g}, {label}", MESHES[label], mu)
        _table(page, mu, exact[mu], {label: found[mu, label] for label in MESHES})
    _budget(page, {label: found[0.3, label] for label in MESHES})
    _figures(page, exact, found)
    for mu in FRICTION:
        for element, label in _FINEST.items():
            known = _KNOWN[mu] if element == "ANS3DEAS" else 0.0
            _check(page, f"mu = {mu:g}, {label}", found[mu, label], exact[mu], known)


def _check(page: Page, what: str, dome: Dome, exact: Stretched, known: float) -> None:
    """Force and strains at the end of the stroke."""
    page.check(f"{what}: force at {STROKES[-1]:g} mm, N", dome.force[-1], exact.force[-1], 0.02)
    most, reference_most = float(dome.thickness[-1].min()), float(exact.thickness[-1].min())
    excuse: dict[str, Any] = {"known": known, "cause": _CAUSE} if known else {}
    thinnest = f"{what}: thickness strain where the sheet is thinnest"
    page.check(thinnest, most, reference_most, 0.01, relative=False, **excuse)
    page.at_most(
        f"{what}: thickness strain, largest deviation within {WITHIN:g} mm",
        float(np.abs(deviation(dome, exact)).max()),
        0.015,
        **excuse,
    )


def _reference_alone(page: Page, exact: dict[float, Stretched]) -> None:
    """Convergence of the reference with friction, the worst case."""
    mu, worst = FRICTION[-1], 0.0
    for other in (reference(mu, elements=120), reference(mu, step=0.2)):
        strain = np.interp(exact[mu].place, other.place, other.thickness[-1])
        worst = max(worst, float(np.abs(strain - exact[mu].thickness[-1]).max()))
    page.at_most("membrane of 120 for 240 elements, or increments of 0.2 for 0.1 mm: thickness strain", worst, 0.002)


def _table(page: Page, mu: float, exact: Stretched, domes: dict[str, Dome]) -> None:
    """Forces and strains of all meshes."""
    columns = (
        "",
        "elements",
        *(f"force at {way:g} mm, kN" for way in STROKES),
        "thickness strain at the pole",
        "thinnest",
        "deviation, root of the mean square",
    )
    rows: list[tuple[str | float | int | None, ...]] = [
        ("membrane", len(exact.place), *(exact.force / 1e3), *_ends(exact), None)
    ]
    for label, dome in domes.items():
        rms = float(np.sqrt((deviation(dome, exact) ** 2).mean()))
        rows.append((label, len(dome.place), *(dome.force / 1e3), *_ends(dome), rms))
    page.table(f"mu = {mu:g}; strains at {STROKES[-1]:g} mm", columns, rows)


def _ends(found: Dome | Stretched) -> tuple[float, float]:
    """Thickness strain nearest to the pole, and the least."""
    strain = found.thickness[-1]
    return float(strain[np.argmin(found.place)]), float(strain.min())


def _budget(page: Page, domes: dict[str, Dome]) -> None:
    """Effect of contact and increments."""
    rows = []
    for (mesh, change), setup in _BUDGET.items():
        dome, base = made(page, f"{mesh}, {change}", setup, 0.3), domes[mesh]
        strain = float(np.abs(dome.thickness[-1] - base.thickness[-1]).max())
        rows.append((f"{mesh}: {change}", 100.0 * float(dome.force[-1] / base.force[-1] - 1.0), strain))
    columns = ("", "force, %", "thickness strain, at most")
    page.table("Budget: effect of each change with mu = 0.3 at the end of the stroke", columns, rows)


def _figures(page: Page, exact: dict[float, Stretched], found: dict[tuple[float, str], Dome]) -> None:
    """Thickness strain over the radius, and force over the stroke."""
    curves, forces = [], []
    for mu in FRICTION:
        curves.append(Curve(f"membrane, mu = {mu:g}", exact[mu].place, exact[mu].thickness[-1]))
        forces.append(Curve(f"membrane, mu = {mu:g}", STROKES, exact[mu].force / 1e3, "o"))
        for label in _FINEST.values():
            dome = found[mu, label]
            curves.append(Curve(f"{label}, mu = {mu:g}", dome.place, dome.thickness[-1], "."))
            forces.append(Curve(f"{label}, mu = {mu:g}", STROKES, dome.force / 1e3))
    caption = f"Thickness strain over the radius before, at a stroke of {STROKES[-1]:g} mm"
    page.figure("thickness", plot(curves, "radius before, mm", "logarithmic thickness strain"), caption)
    page.figure("force", plot(forces, "stroke, mm", "force of the punch, kN"), "Force of the punch")


def _short(page: Page) -> None:
    """Half of the stroke, one coarse mesh, no friction."""
    strokes = STROKES[:2]
    exact = reference(0.0, elements=120, strokes=strokes)
    dome = made(page, "12 mm", Setup(6, 6.0), 0.0, strokes)
    page.check("12 mm: force, N", dome.force[-1], exact.force[-1], 0.05)
    page.at_most("12 mm: thickness strain, largest deviation", float(np.abs(deviation(dome, exact)).max()), 0.02)


CASE = Case(
    name="drawing-hemispherical-stretch",
    title="Stretching over a hemispherical punch",
    problem=f"""
A disc, {THICKNESS:g} mm thick, is clamped at a radius of {CLAMP:g} mm, where the shoulder of the die (radius
{SHOULDER:g} mm) begins. A spherical punch of radius {PUNCH:g} mm stretches it over {STROKES[-1]:g} mm. The tools are
those of the tests of Ghosh and Hecker (1975), which Wang and Budiansky (1978) computed. Mild steel, isotropic: E = 206
GPa, nu = 0.3, 565.32 (0.007117 + p)^0.2589 MPa. Without friction, and with mu = 0.3 on both tools. A quarter of the
disc, one layer. The element size is that along the radius, half of it over the shoulder; penalty 2e4 MPa/mm.
""",
    reference="""
Geometry: "Stretching of a thin sheet with a hemispherical punch" in the Example Problems of Abaqus. The reference is a
membrane, computed separately in numpy: conical elements along the meridian, logarithmic strains, J2 in plane stress by
backward Euler, contact and friction at the nodes of the middle surface, half of the current thickness from the tools.
The membrane has no bending stiffness. Over the shoulder of the die, and while the strains are small (force at 6 mm), a
sheet carries more. Strains are compared within 50 mm.
""",
    run=run,
    cost=80.0,
)

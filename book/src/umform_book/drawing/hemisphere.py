"""A clamped disc stretched over a hemispherical punch, compared with a membrane that is computed separately."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.analysis.steps import Move
from umform.elements import element
from umform.mesh import Mesh, disc
from umform.model import Model
from umform.results.forming import sheet_strains
from umform.surfaces import Profile, Revolved, Sphere
from umform_book.drawing.cups import NEWTON
from umform_book.drawing.membrane import Round, Sheet, Stretched, stretch
from umform_book.friction.u_bend import STEEL
from umform_book.page import Page

Floats = NDArray[np.float64]

#: Tools and blank of the tests of Ghosh and Hecker.
PUNCH, CLAMP, SHOULDER, THICKNESS = 50.8, 59.18, 6.35, 0.85
#: Half of the side of the core of the mesh over the radius.
CORE = 0.2
#: Strokes at which the strains are read, mm.
STROKES = np.array([6.0, 12.0, 18.0, 24.0])
#: Radius before within which strains are compared, mm: beyond, the sheet is bent over the shoulder of the die.
WITHIN = 50.0


@dataclass(frozen=True)
class Setup:
    """How it is computed.

    Attributes
    ----------
    around : int
        Elements on a quarter of the rim.
    size : float
        Of an element along the radius, mm; over the shoulder of the die the half of it.
    element : str
        Name in the catalogue.
    penalty : float
        Pressure per penetration, MPa/mm.
    slip : float
        Allowed elastic slip, mm.
    increments : int, optional
        Of each quarter of the stroke; default the pace that umform chooses.
    points : int or "nodes", optional
        Contact points per direction and facet; default 2 of four nodes, 3 of nine.
    """

    around: int = 8
    size: float = 3.0
    element: str = "BEND18"
    penalty: float = 2e4
    slip: float = 1e-4
    increments: int | None = None
    points: int | str | None = None


@dataclass(frozen=True)
class Dome:
    """The sheet at each of the strokes.

    Attributes
    ----------
    force : ndarray, shape (strokes,)
        Of the punch on the whole sheet, N.
    place : ndarray, shape (cells,)
        Radius of the middle of each cell before.
    thickness, major : ndarray, shape (strokes, cells)
        Logarithmic strains.
    """

    force: Floats
    place: Floats
    thickness: Floats
    major: Floats


def blank(setup: Setup) -> Mesh:
    """A quarter of the disc, rings half as wide over the shoulder of the die."""
    core = CORE * CLAMP
    inner = np.linspace(core, CLAMP - SHOULDER - 2.0, max(round((CLAMP - SHOULDER - 2.0 - core) / setup.size), 1) + 1)
    outer = np.linspace(inner[-1], CLAMP, max(round((CLAMP - inner[-1]) / (0.5 * setup.size)), 1) + 1)
    cell = element(setup.element).cell
    radii = [*inner[:-1].tolist(), *outer.tolist()]
    return disc(CLAMP, THICKNESS, (setup.around // 2, 1), part="quarter", cell=cell, core=CORE, radii=radii)


def made(page: Page, label: str, setup: Setup, friction: float, strokes: Floats = STROKES) -> Dome:
    """Clamp the rim and push the punch in."""
    half = 0.5 * THICKNESS
    model = Model(blank(setup), setup.element, material=STEEL)
    model.fix("rim")
    model.symmetry("x0", "x")
    model.symmetry("y0", "y")
    section = Profile.from_corners(
        [(2.0 * CLAMP, -half), (CLAMP - SHOULDER, -half), (CLAMP - SHOULDER, -CLAMP)],
        radii=[0.0, SHOULDER, 0.0],
        closed=False,
    )
    rule: dict[str, Any] = {"points": setup.points or (3 if "18" in setup.element else 2), "penalty": setup.penalty}
    if friction:
        rule |= {"friction": friction, "slip": setup.slip}
    punch = model.tool("punch", Sphere((0.0, 0.0, PUNCH + half), PUNCH))
    model.contact("upper", punch, name="under_punch", **rule)
    model.contact("lower", model.tool("die", Revolved(section)), name="on_die", **rule)
    stroke = model.drive(punch, "-z", name="stroke")
    force, thickness, major = [], [], []
    for way in strokes:
        move = Move(stroke, to=float(way), steps=setup.increments)
        result = page.solve(f"{label}, to {way:g} mm", model, move, options=NEWTON)
        strains = sheet_strains(model.mesh, model.u)
        force.append(4.0 * abs(float(result["punch_fz"][-1])))
        thickness.append(strains.thickness)
        major.append(strains.major["middle"])
    middle = model.mesh.points[model.mesh.connectivity].mean(axis=1)
    return Dome(np.array(force), np.hypot(middle[:, 0], middle[:, 1]), np.array(thickness), np.array(major))


def reference(friction: float, elements: int = 240, strokes: Floats = STROKES, step: float = 0.1) -> Stretched:
    """The membrane."""
    half = 0.5 * THICKNESS
    tools = (
        Round((0.0, PUNCH + half), PUNCH, friction, True),
        Round((CLAMP, -SHOULDER - half), SHOULDER, friction, False),
    )
    return stretch(Sheet(STEEL, THICKNESS, CLAMP), tools, strokes, elements=elements, step=step)

"""A disc drawn by a spherical punch through a round die, between die and a holder at a fixed distance."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.analysis.run import Result
from umform.analysis.steps import Move
from umform.elements import element
from umform.materials import J2, Metal
from umform.mesh import Mesh, disc
from umform.model import Model
from umform.results.forming import draw_in
from umform.sheet_metals import get
from umform.surfaces import Plane, Profile, Revolved, Sphere
from umform_book.drawing.cups import NEWTON
from umform_book.page import Page

Floats = NDArray[np.float64]

#: Radii of the blank, the punch, the opening of the die and its edge; distance of the holder from the die; mm.
BLANK, PUNCH, DIE, DIE_EDGE, GAP = 50.0, 25.0, 27.0, 6.0, 1.24
THICKNESS, STROKE, FRICTION = 1.0, 40.0, 0.03
#: Half of the side of the core of the mesh over the radius.
CORE = 0.16


#: The card of the library, and its curve without directions.
ALUMINIUM: Metal = get("AA5182-O").law  # type: ignore[assignment]
MISES = J2(ALUMINIUM.E, ALUMINIUM.nu, hardening=ALUMINIUM.hardening)


@dataclass(frozen=True)
class Setup:
    """How it is computed.

    Attributes
    ----------
    material : J2 or Metal
        Law of the sheet.
    size : float
        Of an element along the radius, mm.
    around : int
        Elements on a quarter of the rim.
    element : str
        Name in the catalogue.
    layers : int
        Of elements.
    penalty : float
        Pressure per penetration, MPa/mm.
    """

    material: J2 | Metal
    size: float = 2.0
    around: int = 6
    element: str = "BEND18"
    layers: int = 1
    penalty: float = 2e4


@dataclass(frozen=True)
class Drawn:
    """The sheet at the end of the stroke.

    Attributes
    ----------
    place, strain : ndarray, shape (n,)
        Radius before, and logarithmic thickness strain, along the rolling direction.
    angle, rim : ndarray, shape (m,)
        Angle to the rolling direction in degrees, and draw-in of the rim, mm.
    force : float
        Largest of the punch on the whole cup, kN.
    volume : float
        Relative change of the volume.
    elements : int
        Of the quarter.
    """

    place: Floats
    strain: Floats
    angle: Floats
    rim: Floats
    force: float
    volume: float
    elements: int

    @property
    def drawn(self) -> Floats:
        """Draw-in at 0, 45 and 90 degrees, mm."""
        at: Floats = np.interp([0.0, 45.0, 90.0], self.angle, self.rim)
        return at

    @property
    def asymmetry(self) -> float:
        """Largest difference of the draw-in at theta and at 90 degrees - theta, mm."""
        return float(np.abs(self.rim - self.rim[::-1]).max())

    def row(self) -> tuple[float, ...]:
        """Its row in tables."""
        ends = float(self.strain[0]), float(self.strain.min()), float(self.strain[-1])
        return self.elements, *self.drawn.tolist(), self.force, *ends


def blank(setup: Setup) -> Mesh:
    """A quarter of the disc."""
    core = CORE * BLANK
    radii = np.linspace(core, BLANK, round((BLANK - core) / setup.size) + 1).tolist()
    cells, cell = (setup.around // 2, 1), element(setup.element).cell
    return disc(BLANK, THICKNESS, cells, part="quarter", cell=cell, layers=setup.layers, core=CORE, radii=radii)


def made(page: Page, label: str, setup: Setup, stroke: float = STROKE) -> tuple[Drawn, Result]:
    """Draw it."""
    half = 0.5 * THICKNESS
    model = Model(blank(setup), setup.element, material=setup.material, rolling=(1.0, 0.0, 0.0))
    model.symmetry("x0", "x")
    model.symmetry("y0", "y")
    corners = [(2.0 * BLANK, -half), (DIE, -half), (DIE, -2.0 * BLANK)]
    die = Revolved(Profile.from_corners(corners, radii=[0.0, DIE_EDGE, 0.0], closed=False))
    punch = model.tool("punch", Sphere((0.0, 0.0, PUNCH + half), PUNCH))
    points = 3 if "18" in setup.element else 2
    rule: dict[str, Any] = {"points": points, "penalty": setup.penalty, "friction": FRICTION}
    model.contact("lower", model.tool("die", die), name="on_die", **rule)
    holder = model.tool("holder", Plane((0.0, 0.0, GAP - half), (0.0, 0.0, -1.0)))
    model.contact("upper", holder, name="under_holder", **rule)
    model.contact("upper", punch, name="under_punch", **rule)
    result = page.solve(label, model, Move(model.drive(punch, "-z", name="stroke"), to=stroke), options=NEWTON)
    mesh, u = model.mesh, model.u
    outline = draw_in(mesh, u)
    angle = np.degrees(np.arctan2(outline.before[:, 1], outline.before[:, 0]))
    order = np.argsort(angle)
    rim = np.linalg.norm(outline.before - outline.after, axis=1)[order]
    force = 4e-3 * float(np.abs(result["punch_fz"]).max())
    change = volume(mesh.displaced(u), mesh) / volume(mesh.points, mesh) - 1.0
    return Drawn(*along_x(mesh, u), angle[order], rim, force, change, len(mesh.connectivity)), result


def along_x(mesh: Mesh, u: Floats) -> tuple[Floats, Floats]:
    """Radius before and logarithmic thickness strain of the fibres along x: distance of the skins along the normal."""
    now = mesh.displaced(u)
    lower, upper = (mesh.nodes(f"y0_{skin}") for skin in ("lower", "upper"))
    lower, upper = (ids[np.argsort(mesh.points[ids, 0])] for ids in (lower, upper))
    middle, across = 0.5 * (now[lower] + now[upper])[:, [0, 2]], (now[upper] - now[lower])[:, [0, 2]]
    place = mesh.points[lower, 0]
    tangent = np.gradient(middle, place, axis=0)
    tangent[0] = (1.0, 0.0)  # on the axis the sheet is symmetric
    height = (tangent[:, 0] * across[:, 1] - tangent[:, 1] * across[:, 0]) / np.linalg.norm(tangent, axis=1)
    return place, np.log(height / THICKNESS)


def volume(points: Floats, mesh: Mesh) -> float:
    """Volume of the elements with their nodes at these points: 3 x 3 x 2 Gauss points, which are exact."""
    (across, weight), through = _core.gauss(3), _core.gauss(2)[0]
    places = np.stack(np.meshgrid(across, across, through, indexing="ij"), axis=-1).reshape(-1, 3)
    weights = np.einsum("i,j,k->ijk", weight, weight, np.ones(2)).ravel()
    _, dN = _core.shell_functions(mesh.connectivity.shape[1], places)
    bases = np.einsum("qia,eak->eqik", dN, points[mesh.connectivity])
    return float(weights @ np.linalg.det(bases).sum(axis=0))

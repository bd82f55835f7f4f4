"""An S-shaped rail drawn between tools of triangles under a holder: the rail is symmetric, and meshes agree."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from umform.analysis.run import Result
from umform.analysis.steps import Close, Move
from umform.errors import NoConvergence
from umform.materials import J2, Swift
from umform.mesh import Bent, Mesh, bending_sizes, grid
from umform.model import Model
from umform.results.forming import forming_fields
from umform.surfaces import Extruded, Plane, Profile, Triangles, Triangulated
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.drawing.cups import NEWTON
from umform_book.page import Page

Floats = NDArray[np.float64]

#: Length of the rail and sway of its middle line y = sway cos(pi x / length); half width of the die opening; mm.
LENGTH, SWAY, HALF = 200.0, 25.0, 37.5
RADIUS, CLEARANCE, THICKNESS, BLANK = 5.0, 1.058, 0.92, 85.0
HOLDER, FRICTION, STROKE, PENALTY = 60e3, 0.11, 37.0, 2e3
#: How far the tools go beyond the section and beyond both ends of the rail; the curve has a radius of 162 mm.
BESIDE, OVER = 60.0, 0.1
STEEL = J2(E=206e3, nu=0.3, hardening=Swift(strength=567.0, offset=0.0071, exponent=0.264))


@dataclass(frozen=True)
class Setup:
    """How it is computed.

    Attributes
    ----------
    turn : float
        Angle in degrees by which an element turns over a radius.
    along : int
        Elements along the rail.
    penalty : float
        MPa/mm.
    steps : int
        Increments over 37 mm of stroke.
    """

    turn: float
    along: int
    penalty: float = PENALTY
    steps: int = 80


def middle(x: Floats) -> Floats:
    """The middle line of the rail."""
    return SWAY * np.cos(np.pi * x / LENGTH)


def swept(profile: Profile, name: str, chord: float = 0.05, along: int = 80) -> Triangulated:
    """A section swept along the middle line, as triangles with the normals of the section."""
    section = profile.points(chord, beyond=BESIDE)
    across = Extruded(profile).gap(np.insert(section, 1, 0.0, axis=1))[1][:, [0, 2]]
    t = np.linspace(-OVER, 1.0 + OVER, along + 1)
    slope = np.c_[np.full_like(t, LENGTH), -SWAY * np.pi * np.sin(np.pi * t)]
    left = np.c_[-slope[:, 1], slope[:, 0]] / np.hypot(*slope.T)[:, None]
    points, normals = (np.empty((len(t), len(section), 3)) for _ in range(2))
    points[..., :2] = np.c_[LENGTH * t, middle(LENGTH * t)][:, None] + section[:, :1] * left[:, None]
    normals[..., :2] = across[:, :1] * left[:, None]
    points[..., 2], normals[..., 2] = section[:, 1], across[:, 1]
    at = np.arange(points[..., 0].size).reshape(points.shape[:2])
    a, b, c, d = at[:-1, :-1].ravel(), at[:-1, 1:].ravel(), at[1:, 1:].ravel(), at[1:, :-1].ravel()
    triangles = np.vstack([np.c_[a, b, c], np.c_[a, c, d]])
    flat = normals.reshape(-1, 3)
    return Triangulated(Triangles(points.reshape(-1, 3), triangles), flat[triangles], open=True, name=name)


def tools() -> tuple[Triangulated, Triangulated]:
    """Die and punch."""
    inner = HALF - CLEARANCE
    shoulders = [(HALF + 20.0, 0.0), (HALF, 0.0), (HALF, -60.0), (-HALF, -60.0), (-HALF, 0.0), (-HALF - 20.0, 0.0)]
    nose = [(-inner, 60.0), (-inner, 0.0), (inner, 0.0), (inner, 60.0)]
    sections = (shoulders, [0.0, RADIUS, 3.0, 3.0, RADIUS, 0.0], "die"), (nose, [0.0, RADIUS, RADIUS, 0.0], "punch")
    die, punch = (swept(Profile.from_corners(at, radii, closed=False), name) for at, radii, name in sections)
    return die, punch


def blank(setup: Setup) -> Mesh:
    """A blank whose lines follow the rail, finer where metal passes the radii; its outer edges are straight."""
    over = Bent(HALF - 6.5, 2.0 * HALF, RADIUS + 0.5 * THICKNESS)
    ends = bending_sizes(0.0, BLANK, [over], turn=setup.turn, largest=10.0).ends
    flat = grid(np.linspace(0.0, LENGTH, setup.along + 1), np.r_[-ends[:0:-1], ends], [0.0, THICKNESS])

    def along_the_rail(x: Floats) -> Floats:
        share = np.clip((BLANK - np.abs(x[:, 1])) / 35.0, 0.0, 1.0)
        return np.column_stack([x[:, 0], x[:, 1] + share * middle(x[:, 0]), x[:, 2]])

    return flat.transformed(along_the_rail)


def model_of(setup: Setup, stroke: float = STROKE) -> tuple[Model, list[Close | Move]]:
    """The blank between its tools, and the steps that close the holder and draw."""
    die, nose = tools()
    model = Model(blank(setup), "ANS3DEAS", material=STEEL, thickness_points=5)
    touch = partial(model.contact, penalty=setup.penalty, points=2, friction=FRICTION)
    touch("lower", die, name="die")
    holder = touch("upper", Plane((0.0, 0.0, THICKNESS), (0.0, 0.0, -1.0)), name="holder")
    punch = touch("upper", nose.moved((0.0, 0.0, THICKNESS)), name="punch")
    hold, way = model.press(holder, "-z", name="hold"), model.drive(punch, "-z", name="stroke")
    return model, [Close(hold, HOLDER), Move(way, stroke, steps=max(round(setup.steps * stroke / STROKE), 1))]


@dataclass(frozen=True)
class Made:
    """A rail at the end of the stroke.

    Attributes
    ----------
    elements, increments : int
        Of the mesh and of the run.
    force : float
        Of the punch, kN.
    draw_in : ndarray, shape (3,)
        Of the edge y = 85 mm in y, at both ends and in the middle of the rail, mm.
    thinning : float
        Largest, per cent.
    uneven : float
        Largest difference of the displacements of both halves, one turned by half a turn, over the thickness.
    stroke, forces : ndarray
        Over the run.
    """

    elements: int
    increments: int
    force: float
    draw_in: Floats
    thinning: float
    uneven: float
    stroke: Floats
    forces: Floats

    def row(self) -> tuple[float, ...]:
        """Its row in tables."""
        return (self.elements, self.increments, self.force, *self.draw_in, self.thinning, self.uneven)


def unevenness(mesh: Mesh, u: Floats) -> float:
    """Largest distance between a node and its image under half a turn about the middle."""
    _, other = cKDTree(mesh.points).query(np.array([LENGTH, 0.0, 0.0]) + mesh.points * [-1.0, -1.0, 1.0])
    return float(np.linalg.norm(u[other] - u * [-1.0, -1.0, 1.0], axis=1).max())


def make(page: Page, label: str, setup: Setup, stroke: float = STROKE) -> tuple[Made, Result]:
    """Close the holder and draw."""
    model, steps = model_of(setup, stroke)
    result = page.solve(label, model, steps, options=NEWTON)
    mesh, u = model.mesh, model.u.reshape(-1, 3)
    edge = mesh.nodes("y1")
    at = [edge[np.isclose(mesh.points[edge, 0], x, atol=1e-6 * LENGTH)] for x in (0.0, 0.5 * LENGTH, LENGTH)]
    way, forces = np.asarray(result["stroke"]), 1e-3 * result["stroke_force"]
    made = Made(
        len(mesh.connectivity),
        len(result) - 1,
        float(forces[-1]),
        np.array([-u[nodes, 1].mean() for nodes in at]),
        float(forming_fields(mesh, model.u)["thinning"].max()),
        unevenness(mesh, u) / THICKNESS,
        way,
        forces,
    )
    return made, result


#: Meshes of the page.
MESHES = {"24 degrees, 20 along": Setup(24.0, 20), "24 degrees, 28 along": Setup(24.0, 28)}
COARSE, FINE = MESHES
#: Largest difference between both halves, over the thickness.
EVEN = 1e-6
#: Largest difference of force and draw-in between runs; relative, and mm.
FORCE, DRAW_IN = 0.1, 1.0


def run(page: Page) -> None:
    """Fill the page."""
    if page.short:
        rail, _ = make(page, COARSE, replace(MESHES[COARSE], turn=60.0, along=8), 1.0)
        page.at_most("both halves: largest difference over the thickness", rail.uneven, EVEN)
        return
    found: dict[str, Made] = {}
    for label, setup in MESHES.items():
        try:
            found[label], result = make(page, label, setup)
        except NoConvergence as error:
            page.text(f"{label}: the run ends before the end of the stroke. {error.where}; {error.cause}.")
            continue
        if label == FINE:
            page.shape("rail", result, f"Rail at {STROKE:g} mm")
    columns = ("", "elements", "increments", "force, kN", "at x = 0", "middle", "at x = 200", "thinning, %", "halves")
    page.table(
        f"At a stroke of {STROKE:g} mm: force of the punch, draw-in of the edge y = {BLANK:g} mm in mm, largest "
        "thinning, difference of both halves over the thickness",
        columns,
        [(label, *rail.row()) for label, rail in found.items()],
    )
    forces = [Curve(label, rail.stroke, rail.forces) for label, rail in found.items()]
    page.figure("force", plot(forces, "stroke, mm", "force of the punch, kN"), "Force of the punch")
    for label, rail in found.items():
        page.check(f"{label}: stroke, mm", float(rail.stroke[-1]), STROKE, 1e-9)
        page.at_most(f"{label}: both halves, largest difference over the thickness", rail.uneven, EVEN)
    for label in [label for label in found if label != COARSE]:
        page.check(f"{label}: force against {COARSE}, kN", found[label].force, found[COARSE].force, FORCE)
        apart = float(np.abs(found[label].draw_in - found[COARSE].draw_in).max())
        page.at_most(f"{label}: draw-in against {COARSE}, largest difference, mm", apart, DRAW_IN)


CASE = Case(
    name="drawing-s-rail",
    title="S-rail between tools of triangles",
    problem=f"""
A blank of {LENGTH:g} x {2 * BLANK:g} x {THICKNESS:g} mm is drawn by {STROKE:g} mm to a rail whose middle line is
y = {SWAY:g} cos(pi x / {LENGTH:g}) mm. Opening {2 * HALF:g} mm wide, clearance {CLEARANCE:g} mm on each side, all radii
{RADIUS:g} mm, holder {HOLDER / 1e3:g} kN, mu = {FRICTION:g}. Die and punch are sections swept along the middle line,
4320 and 2400 triangles with the normals of the section; the holder is a plane. E = 206 GPa, nu = 0.3, hardening
567 (0.0071 + p)^0.264 MPa. ANS3DEAS in one layer, 2 x 2 contact points, penalty {PENALTY:g} MPa/mm; only holder and
friction hold the blank. Degrees: largest angle that an element turns over a radius; along: elements along the rail.
""",
    reference="""
No published rail has these tools. The forces published for the S-rail of NUMISHEET 96 (239.9 and 238.8 kN by two codes
at a stroke of 40 mm: Ida et al., J. Phys.: Conf. Ser. 1063 (2018) 012100) are published without the tools. So the page
checks what must hold for any answer: every mesh reaches the end of the stroke, forces and work balance, and the rail is
symmetric, since half a turn about the middle maps blank and tools onto themselves. Two meshes compare umform with
itself.
""",
    run=run,
    cost=190.0,
)

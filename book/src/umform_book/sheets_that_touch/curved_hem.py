"""A hem of a curved edge: a flange along an arc that a plate folds onto its base."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import umform as uf
from umform.analysis.steps import Move
from umform.mesh import Mesh
from umform.surfaces import Plane
from umform_book.case import Case
from umform_book.contact.hertz_line import EIGHT
from umform_book.page import Page

Floats = NDArray[np.float64]

BASE, FLANGE, BEND, THICKNESS = 8.0, 4.0, 1.3, 1.0
#: Angle by which the flange is bent at the start, radius of the arc, length along it.
ANGLE, RADIUS, WIDTH = np.radians(135.0), 40.0, 2.0
#: Distance of the plates at the end, in thicknesses.
CLOSED = 2.1
ELEMENTS = (44, 2)
#: Side of the arc on which the base is: inside it (a convex edge), on none, outside of it (a concave edge).
EDGES = {"convex": 1, "straight": 0, "concave": -1}


@dataclass(frozen=True)
class Hem:
    """Roll-in, strain along the end of the flange, penetration, force of the plate, force left over, points, drift."""

    roll_in: float
    stretch: float
    penetration: float
    plate: float
    left: float
    touching: int
    drift: float


def profile(s: Floats, z: Floats) -> tuple[Floats, Floats]:
    """Way out of the base and height of a point at s along the section and z across it."""
    angle, beyond = np.clip((s - BASE) / BEND, 0.0, ANGLE), np.maximum(s - BASE - ANGLE * BEND, 0.0)
    out = np.minimum(s, BASE) + (BEND - z) * np.sin(angle) + beyond * np.cos(angle)
    return out, BEND - (BEND - z) * np.cos(angle) + beyond * np.sin(angle)


def hem_of(side: int, elements: tuple[int, int]) -> Mesh:
    """The flanged sheet: a sector of an arc, or a strip."""

    def bent(X: Floats) -> Floats:
        out, height = profile(X[:, 0], X[:, 2])
        if side == 0:
            return np.column_stack([out, X[:, 1], height])
        angle, rho = side * X[:, 1] / RADIUS, RADIUS + side * (out - BASE)
        return np.column_stack([rho * np.cos(angle), rho * np.sin(angle), height])

    length = BASE + ANGLE * BEND + FLANGE
    return uf.mesh.strip(length, WIDTH, THICKNESS, elements).transformed(bent)


def outermost(x: Floats, side: int) -> float:
    """Way of the outermost point out of the base."""
    if side == 0:
        return float(x[:, 0].max())
    return float((side * (np.hypot(x[:, 0], x[:, 1]) - RADIUS)).max() + BASE)


def close(page: Page, edge: str, elements: tuple[int, int], *, picture: bool = False) -> Hem:
    """Fold the flange onto its base by a flat plate."""
    side = EDGES[edge]
    mesh = hem_of(side, elements)
    steel = uf.J2(E=210e3, nu=0.3, hardening=uf.Swift(560.0, 0.005, 0.22))
    model = uf.Model(mesh, EIGHT.name, material=steel)
    turn = side * WIDTH / RADIUS
    model.fix("y0", "y")
    model.fix("y1", normals=(-np.sin(turn), np.cos(turn), 0.0))
    model.fix("x0", normals=(np.cos(0.5 * turn), np.sin(0.5 * turn), 0.0))
    model.fix("x0", "z")
    model.contact("lower", Plane((0.0, 0.0, -0.5 * THICKNESS), (0.0, 0.0, 1.0)), name="base")
    top = float(mesh.points[:, 2].max())
    plate = model.contact("lower", Plane((0.0, 0.0, top), (0.0, 0.0, -1.0)), name="plate")
    inside = model.self_contact("upper", name="inside", cells=3)
    down = model.drive(plate, "-z", name="down")
    way = top + 0.5 * THICKNESS - CLOSED * THICKNESS
    result = page.solve(
        f"{edge}, {elements[0]} x {elements[1]}", model, Move(down, way, steps=40), frames=2 if picture else 0
    )
    if picture:
        page.shape("closed", result, f"The closed hem of a {edge} edge", values="plastic_strain_mean")
    held = model.evaluate(model.u).residual.reshape(-1, 3)[mesh.sets["x0"], 2].sum()
    forces = float(result["plate_fz"][-1]), float(result["base_fz"][-1]), -float(held)
    x = mesh.displaced(model.u)
    end = mesh.sets["x1"]
    hoop = [np.hypot(p[end, 0], p[end, 1]).mean() if side else 1.0 for p in (mesh.points, x)]
    return Hem(
        outermost(mesh.points, side) - outermost(x, side),
        float(np.log(hoop[1] / hoop[0])),
        float(result["inside_penetration"].max()),
        forces[0],
        sum(forces),
        int(inside.found.active.sum()),
        abs(float(result.balance().drift[-1])),
    )


def run(page: Page) -> None:
    """Three edges on one mesh."""
    rows, found = [], {}
    for edge in page.pick(tuple(EDGES), ("convex",)):
        hem = found[edge] = close(page, edge, ELEMENTS, picture=edge == "convex")
        rows.append((edge, hem.roll_in, hem.stretch, hem.touching, hem.penetration, hem.plate, hem.drift))
        page.check(f"{edge}: closed, points that touch", float(hem.touching > 0), 1.0, 0.0)
        page.at_most(f"{edge}: penetration in thicknesses", hem.penetration / THICKNESS, 0.005)
        page.at_most(f"{edge}: forces of plate, base and support, left over", abs(hem.left / hem.plate), 1e-6)
        page.at_most(f"{edge}: work and energies, relative", hem.drift, 0.01)
    page.table(
        "Hems of three edges",
        ("edge", "roll-in", "strain along the end", "points that touch", "penetration", "force of the plate", "drift"),
        rows,
    )
    if len(found) == len(EDGES):
        straight = found["straight"].roll_in
        for edge in ("convex", "concave"):
            page.at_most(
                f"{edge}: roll-in above that of the straight edge", max(found[edge].roll_in - straight, 0.0), 0.0
            )
        page.at_most("convex: stretch of the end of the flange", max(found["convex"].stretch, 0.0), 0.0)
        page.at_most("concave: its compression", max(-found["concave"].stretch, 0.0), 0.0)
    page.text(
        "Along an arc the end of the flange becomes shorter (convex) or longer (concave) when it is folded. "
        "On both edges the force along the arc resists the way of the flange over its base and pushes the "
        "fold outwards: less roll-in than on a straight edge, here a roll-out. The meshes are coarse; the "
        "numbers are no reference for a real hem."
    )


CASE = Case(
    name="touch-curved-hem",
    title="Hem of a curved edge",
    problem="A sheet of thickness 1 with a flange of 4, bent by 135 degrees about a mean radius of 1.3 along an "
    "arc of radius 40, in a sector of 2 between planes of symmetry. A flat plate folds the flange onto "
    "its base to a height of 2.1. The base is inside the arc (convex edge), outside of it (concave edge),"
    " or the edge is straight. Steel, hardening of Swift, free of stress at the start; no friction; the "
    "inner edge of the base is held.",
    reference="Equilibrium: a force N along the arc of radius R acts on the flange with N / R, outwards where the "
    "flange is compressed on a convex edge, and away from the base where it is stretched on a concave "
    "one. So both roll in less than the straight edge. Bounds: no penetration above 0.5 % of the "
    "thickness, forces that balance to 1e-6, energies to 1 %. Measured roll-ins of convex, straight and "
    "concave test pieces exist (SAE 2002-01-2084); its abstract has no numbers.",
    run=run,
    cost=45.0,
    picture="closed",
)

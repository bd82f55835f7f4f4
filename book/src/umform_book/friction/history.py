"""History of friction: 1000 increments at rest, the bound at every point, a closed loop on a sphere."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import umform as uf
from umform import mesh
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import solve
from umform.analysis.steps import Move
from umform.materials import SVK
from umform.model import Model
from umform.surfaces import Sphere
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.contact.hertz_line import EIGHT
from umform_book.friction.capstan import PENALTY, TENSION, WIDTH, E, Strip, wrapped
from umform_book.page import Page
from umform_book.printed import bounded

Floats = NDArray[np.float64]

STRIP = Strip(0.1, np.pi, 0.3)
SLIP = 1e-4
#: The cylinder turns there, and less back, so that a part of the strip sticks and a part slips.
THERE, BACK = 0.01, 0.0097
#: Laws whose bound is checked at every point.
LAWS = {
    "mu = 0.3": uf.Friction(0.3),
    "cap": uf.Friction(0.3, cap=0.04),
    "table": uf.Friction([(0.05, 0.3), (0.15, 0.2)]),
    "kinetic": uf.Friction(0.3, kinetic=0.2, decay=0.02),
}
RADIUS, LOOP_SLIP = 10.0, 200.0


def around(law: uf.Friction | float, divisions: int) -> tuple[Model, list[Move]]:
    """The strip on the cylinder, and the steps: tension, turn there, turn back a little."""
    model = Model(wrapped(STRIP, divisions, EIGHT), EIGHT.element, material=SVK(E=E, nu=0.0))
    model.fix(np.arange(len(model.mesh.points)), "y")
    model.prescribe("x0", "x", "hold")
    cylinder = model.tool("cylinder", uf.Cylinder((0, 0, 0), "y", 10.0))
    model.contact("lower", cylinder, penalty=PENALTY, points="nodes", friction=law, slip=SLIP, name="tool")
    load = model.traction("x1", np.array([-1.0, 0.0, 0.0]) / (WIDTH * STRIP.thickness), "tension")
    spin = model.turn(cylinder, "y", name="spin")
    return model, [Move(load, TENSION, steps=1), Move(spin, THERE, steps=10), Move(spin, BACK, steps=5)]


def rest(page: Page) -> None:
    """1000 increments in which nothing moves."""
    rows = []
    count = page.pick((1000,), (100,))[0]
    limit = count * NewtonOptions().residual  # each increment may end with the tolerance as its residual
    for divisions in page.pick((32, 64, 128), (32,)):
        model, steps = around(STRIP.mu, divisions)
        page.solve(f"{divisions} intervals, there and back", model, steps)
        contact = model.contacts[0]
        sticks = int((contact.found.status == 1).sum())
        u, traction = model.u.copy(), contact.found.traction.copy()
        spin = steps[-1].moved()[0]
        result = page.solve(f"{divisions} intervals, {count} increments at rest", model, Move(spin, BACK, steps=count))
        moved = float(np.abs(model.u - u).max()) / SLIP
        changed = float(np.abs(contact.found.traction - traction).max() / np.abs(traction).max())
        work = float(result["friction_work"][-1] - result["friction_work"][0]) / float(result["friction_work"][-1])
        rows.append(
            (
                divisions,
                count,
                len(contact.found.status),
                sticks,
                bounded(moved, 1e-6) or moved,
                bounded(changed, limit) or changed,
                work,
            )
        )
        page.at_most(
            f"{divisions} intervals, {count} increments at rest: displacement over allowed elastic slip", moved, 1e-6
        )
        page.at_most(f"{divisions} intervals, {count} increments at rest: change of tractions", changed, limit)
    columns = ("intervals", "increments", "points", "stick", "way over allowed slip", "traction", "work of friction")
    page.table("At rest: changes at the end, the last two relative", columns, rows)


def bound(page: Page) -> None:
    """The bound of the law at every point of every increment."""
    rows = []
    for name, law in page.each(list(LAWS.items()), lambda item: item[0]):
        for divisions in page.pick((32, 64, 128), (32,)):
            model, steps = around(law, divisions)
            contact, worst, lowest, slips = model.contacts[0], 0.0, np.inf, 0
            for step in steps:
                control, count = step.moved()[0], step.steps
                assert isinstance(count, int)
                start = [control.value]
                for number in range(1, count + 1):
                    target = step.values(number / count, start)
                    solve(model, Move(control, target, steps=1), progress=False, frames=0)
                    held = contact.found.held
                    p, normal = np.asarray(held.pressure), np.asarray(held.normal)
                    t = np.asarray(held.traction) - p[:, None] * normal
                    size = np.linalg.norm(t, axis=1)
                    limit = np.array([law.bound(*pair) for pair in zip(p, np.asarray(held.slip), strict=True)])
                    slipping = contact.found.slipping[np.asarray(held.points)]
                    worst = max(worst, float((size / limit).max() - 1.0))
                    lowest = min(lowest, float((size / limit)[slipping].min(initial=np.inf)) - 1.0)
                    slips += int(slipping.sum())
            rows.append((name, divisions, slips, worst, lowest))
        page.at_most(f"{name}: traction over bound - 1 at any point and time", worst, 1e-12)
        page.at_most(f"{name}: 1 - traction over bound where it slips", -lowest, 1e-12)
    columns = (
        "law",
        "intervals",
        "points that slip, all increments",
        "largest t / bound - 1",
        "smallest where it slips",
    )
    page.table("The bound at every point of every increment", columns, rows)


@dataclass(frozen=True)
class Loop:
    """Elastic slip of a point around a circle of latitude, along and across its path."""

    found: Floats
    exact: Floats


def loops(page: Page, divisions: int, increments: int) -> list[Loop]:
    """A held patch on a sphere that turns once, with so much friction that nothing slips."""
    patch = mesh.strip(4.0, 3.0, 1.0, (divisions, divisions), cell="hex8")
    tilt = np.radians(35.0)
    turn = np.array([[np.cos(tilt), 0.0, np.sin(tilt)], [0.0, 1.0, 0.0], [-np.sin(tilt), 0.0, np.cos(tilt)]])

    def on_sphere(X: Floats) -> Floats:
        direction = np.column_stack([X[:, :2] - [2.0, 1.5], np.full(len(X), RADIUS)])
        direction /= np.linalg.norm(direction, axis=1)[:, None]
        moved: Floats = (RADIUS + 0.49 + X[:, 2])[:, None] * (direction @ turn.T)
        return moved

    body = patch.transformed(on_sphere)
    model = Model(body, EIGHT.element, material=SVK(E=E, nu=0.0))
    model.fix("lower")
    tool = model.tool("sphere", Sphere((0.0, 0.0, 0.0), RADIUS))
    contact = model.contact("lower", tool, penetration=0.01, points="nodes", friction=1.5, slip=LOOP_SLIP, name="tool")
    contact.penalty = contact.penalty  # the penetration is prescribed: it must not grow
    stiff = 1.5 * contact.penalty * 0.01 / LOOP_SLIP
    spin = model.turn(tool, "z", name="spin")
    page.solve(f"{divisions} x {divisions}, {increments} increments", model, Move(spin, 2.0 * np.pi, steps=increments))
    found = contact.found
    held = found.held
    assert not found.slipping.any()
    x, p, normal = (np.asarray(value) for value in (held.x, held.pressure, held.normal))
    slip = -(np.asarray(held.traction) - p[:, None] * normal) / stiff
    loops = []
    for place, e in zip(x, slip, strict=True):
        r = np.linalg.norm(place)
        colatitude, longitude = np.arccos(place[2] / r), np.arctan2(place[1], place[0])
        east = np.array([-np.sin(longitude), np.cos(longitude), 0.0])
        south = np.cross(east, place / r)
        turned, radius = 2.0 * np.pi * np.cos(colatitude), r * np.tan(colatitude)
        exact = radius * np.array([-np.sin(turned), 1.0 - np.cos(turned)])
        loops.append(Loop(np.array([e @ east, e @ south]), exact))
    return loops


def sphere(page: Page) -> None:
    """Meshes and increments."""
    rows, curves = [], []
    for divisions in page.pick((1, 2, 4), (2,)):
        counts, errors = page.pick((90, 180, 360, 720), (180,)), []
        for increments in counts:
            all_loops = loops(page, divisions, increments)
            size = max(float(np.linalg.norm(loop.exact)) for loop in all_loops)
            errors.append(max(float(np.linalg.norm(loop.found - loop.exact)) for loop in all_loops) / size)
            rows.append((f"{divisions} x {divisions}", len(all_loops), increments, size, errors[-1]))
            within = (2.0 * np.pi / increments) ** 2  # chords in place of arcs
            page.at_most(f"{divisions} x {divisions}, {increments} increments: elastic slip", errors[-1], within)
        curves.append(Curve(f"{divisions} x {divisions}", counts, errors, "o-"))
    columns = ("facets", "points", "increments", "largest collected slip", "largest error over the slip")
    page.table("Elastic slip collected around circles of latitude, against the closed form", columns, rows)
    figure = plot(curves, "increments", "largest error over the collected slip", log="xy")
    page.figure("loop", figure, "Closed loop on a sphere: error of the collected elastic slip")


def run(page: Page) -> None:
    """Fill the page."""
    rest(page)
    bound(page)
    sphere(page)


CASE = Case(
    name="friction-history",
    title="History of friction: rest, bound, a closed loop",
    problem=f"""
* Rest: a strip of h = {STRIP.thickness:g} around half of a cylinder of R = 10, mu = {STRIP.mu:g}, under a tension of
  {TENSION:g}; the cylinder turns by {THERE:g} and back to {BACK:g}, so that a part sticks and a part slips backwards;
  then 1000 increments without motion.
* Bound: the same with four laws: coefficient 0.3; with a cap of 0.04; falling from 0.3 to 0.2 between the pressures
  0.05 and 0.15; falling from 0.3 to 0.2 with the distance slid, over 0.02.
* Closed loop: a patch is held on a sphere of R = {RADIUS:g}, 35 degrees off its axis, while the sphere turns once; the
  allowed elastic slip is so large that nothing slips.
""",
    reference="""
Rest: nothing changes; each increment may leave a residual of 1e-9 of the forces. Bound: |t| <= bound(p, slip), equal
where it slips, to round-off. Closed loop: on a circle of latitude theta at the distance r, the elastic slip is the
chord of its development, an arc of radius r tan(theta) and angle Phi = 2 pi cos(theta): r tan(theta) (sin Phi, 1 - cos
Phi) along and across. Uncertainty: chords for arcs, below (2 pi/n)^2 for n increments.
""",
    run=run,
    cost=16.0,
)

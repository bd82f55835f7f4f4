"""Tools that turn with the sheet, which carry it without slip, and against it, where all of it slips."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import dblquad

from umform import mesh
from umform.analysis.steps import Move
from umform.materials import SVK
from umform.mesh import Mesh
from umform.model import Model
from umform.surfaces import Cylinder, Plane
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.contact.hertz_line import EIGHT, EIGHTEEN, least_rule
from umform_book.page import Page
from umform_book.variants import Variant

Floats = NDArray[np.float64]

LENGTH, WIDTH, HEIGHT, E, NU = 4.0, 2.0, 0.5, 1e5, 0.3
MU, PENALTY, SLIP = 0.2, 1e3, 1e-3
PRESSURE, RADIUS = 1.0, 10.0
#: Round-off of positions over the penetration.
EXACT = 1e-9
#: Of the elastic energy: round-off raises the pressure here and there, and stick that stiffens with it loses energy:
#: eq. (4.174); 5e-10 to 1.2e-9 in 8 to 180 increments a turn.
LOST = 1e-8


def plate(variant: Variant, divisions: int) -> Mesh:
    """A plate, its middle above the origin."""
    flat = mesh.strip(
        LENGTH, WIDTH, HEIGHT, (variant.cells(2 * divisions), variant.cells(divisions)), cell=variant.cell
    )
    return flat.transformed(lambda X: X - [0.5 * LENGTH, 0.5 * WIDTH, float(X[:, 2].min())])


def wrap(X: Floats) -> Floats:
    """From the plane to the cylinder."""
    angle, r = X[:, 0] / RADIUS, RADIUS + X[:, 2]
    return np.column_stack([r * np.sin(angle), X[:, 1], r * np.cos(angle)])


def turned(angle: float, axis: str) -> Floats:
    """Matrix of a turn about z or y."""
    c, s = np.cos(angle), np.sin(angle)
    if axis == "z":
        return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def carried(page: Page, kind: str, variant: Variant, divisions: int, steps: int) -> tuple[float, float, float]:
    """A sheet that friction alone holds to a tool that turns once, in so many increments a quarter.

    Returns
    -------
    tuple of float
        Largest deviation from the turned positions after each quarter, over the elastic slip that is allowed; work of
        friction while it turns, over the elastic energy; iterations an increment.
    """
    body, axis = plate(variant, divisions), "z" if kind == "plane" else "y"
    if kind == "cylinder":
        body = body.transformed(wrap)
    model = Model(body, variant.element, material=SVK(E=E, nu=NU))
    tool = model.tool("tool", Plane((0, 0, 0), (0, 0, 1)) if kind == "plane" else Cylinder((0, 0, 0), "y", RADIUS))
    points = least_rule(variant)
    model.contact("lower", tool, penalty=PENALTY, points=points, friction=MU, slip=SLIP, name="foot")
    press = model.pressure("upper", "press")
    spin = model.turn(tool, axis, name="spin")
    label = f"carried by a {kind}, {variant.label}, {divisions} intervals, {90.0 / steps:g} degrees"
    page.solve(f"{label}: pressed", model, Move(press, PRESSURE, steps=2))
    start = model.positions
    off, before, iterations = 0.0, float(model.contacts[0].found.friction_work), []
    for quarter in page.pick((1, 2, 3, 4), (1,)):
        result = page.solve(f"{label}: quarter {quarter}", model, Move(spin, 0.5 * np.pi * quarter, steps=steps))
        x = model.positions
        iterations += result["iterations"][-steps:].tolist()
        off = max(off, float(np.abs(x - start @ turned(spin.value, axis).T).max()))
    work = (float(result["friction_work"][-1]) - before) / float(result["elastic_energy"][-1])
    return off / SLIP, work, float(np.mean(iterations))


def with_the_sheet(page: Page) -> None:
    """Nothing slips, whatever the tool does, in increments of 2 to 45 degrees."""
    rows = []
    for kind in ("plane", "cylinder"):
        for variant in page.pick((EIGHT, EIGHTEEN), (EIGHT,)):
            cases = [(2, 9), (4, 9), (8, 9), (4, 45), (4, 2)] if variant is EIGHT else [(2, 9), (4, 9)]
            for divisions, steps in page.pick(cases, [(4, 9)]):
                off, work, iterations = carried(page, kind, variant, divisions, steps)
                rows.append((f"{kind}, {variant.label}", divisions, 90.0 / steps, off, work, iterations))
            worst = np.abs([row[3:5] for row in rows if row[0] == f"{kind}, {variant.label}"]).max(axis=0)
            page.at_most(
                f"{kind}, {variant.label}: deviation of positions over the allowed elastic slip", worst[0], EXACT
            )
            page.at_most(f"{kind}, {variant.label}: work of friction over elastic energy", worst[1], LOST)
    columns = (
        "tool, element",
        "intervals",
        "degrees an increment",
        "places off, over allowed slip",
        "work of friction over elastic energy",
        "iterations an increment",
    )
    page.table("Carried around by friction alone, one turn", columns, rows)


def held(page: Page, divisions: int, points: int | str, pivot: float) -> tuple[float, float, float]:
    """Force along y and moment about z over mu N, and N, of a held plate on a plane that turns about x = pivot."""
    body = plate(EIGHT, divisions)
    model = Model(body, EIGHT.element, material=SVK(E=E, nu=0.0))
    model.fix(np.arange(len(body.points)), "xy")
    tool = model.tool("tool", Plane((0, 0, 0), (0, 0, 1)))
    model.contact("lower", tool, penalty=PENALTY, points=points, friction=MU, slip=SLIP * 1e-3, name="foot")
    press = model.pressure("upper", "press")
    spin = model.turn(tool, "z", about=(pivot, 0.0, 0.0), name="spin")
    label = f"held, pivot {pivot:g}, {divisions} intervals, {points}"
    result = page.solve(label, model, [Move(press, PRESSURE, steps=1), Move(spin, 0.04, steps=40)])
    normal = -float(result["tool_fz"][-1])
    return float(result["tool_fy"][-1]) / (MU * normal), float(result["tool_mz"][-1]) / (MU * normal), normal


def exact(pivot: float) -> tuple[float, float]:
    """The same for a uniform pressure: means of the direction of slip and of its moment, over the plate."""
    area = LENGTH * WIDTH

    def size(y: float, x: float) -> float:
        return max(float(np.hypot(x - pivot, y)), 1e-30)

    box = (-0.5 * LENGTH, 0.5 * LENGTH, -0.5 * WIDTH, 0.5 * WIDTH)
    force = dblquad(lambda y, x: (x - pivot) / size(y, x), *box, epsabs=1e-9)[0] / area
    moment = dblquad(lambda y, x: (x * (x - pivot) + y * y) / size(y, x), *box, epsabs=1e-9)[0] / area
    return -float(force), -float(moment)


def against_the_sheet(page: Page) -> None:
    """A held plate on a plane that turns about its middle, about a point beside it, and far away."""
    rows, curves = [], []
    scale = float(np.hypot(LENGTH, WIDTH)) / 2.0
    for pivot in page.pick((0.0, 1.0, 5.0), (1.0,)):
        force, moment = exact(pivot)
        meshes, errors = page.pick((4, 8, 16), (8,)), []
        for divisions in meshes:
            found = held(page, divisions, 2, pivot)
            errors.append(max(abs(found[0] - force), abs(found[1] - moment) / scale))
            rows.append((f"x = {pivot:g}", divisions, found[0], force, found[1], moment, errors[-1]))
            within = 1.0 / (2.0 * divisions) ** 3  # the direction of slip jumps at the pivot
            what = f"turned about x = {pivot:g}, {divisions} intervals: force and moment over mu N"
            page.at_most(what, errors[-1], within)
        curves.append(Curve(f"about x = {pivot:g}", meshes, np.maximum(errors, 1e-12), "o-"))
    columns = ("pivot", "intervals", "force", "exact", "moment", "exact", "largest error")
    page.table("A held plate on a plane that turns: force along y and moment over mu N", columns, rows)
    figure = plot(curves, "intervals over the width", "error of force and moment over mu N", log="xy")
    page.figure("held", figure, "Plane that turns beneath a held plate: error over the mesh")


def run(page: Page) -> None:
    """Fill the page."""
    with_the_sheet(page)
    against_the_sheet(page)
    page.text(
        "A straight predictor would end R (angle)^2/2 beside the arc, 38 times the allowed elastic slip at 5 degrees "
        "on the cylinder: all points would slip, and nothing would hold the sheet. The predictor rotates with the "
        "tool, see eq. (4.178) of the theory."
    )


CASE = Case(
    name="friction-turning-tool",
    title="Tools that turn with the sheet and against it",
    problem=f"""
A plate of {LENGTH:g} x {WIDTH:g} x {HEIGHT:g}, E = {E:g}, under a pressure of {PRESSURE:g} on its upper face, mu =
{MU:g}, penalty {PENALTY:g}, allowed elastic slip {SLIP:g}.

* With the sheet: only friction holds the plate to a plane, or a curved one to a cylinder of R = {RADIUS:g}, nu =
  {NU:g}; the tool turns once, in 8 to 180 increments.
* Against the sheet: the plate is held and the plane turns by 0.04 about a point on the x axis; nu = 0, allowed elastic
  slip {SLIP / 1000:g}.
""",
    reference="""
With the sheet: every node follows the rotation and friction does no work, to round-off. Against: each point slips in
the direction of the rotation; force and moment over mu N are means over the plate, by numerical integration.
Uncertainty: two points per direction and facet do not resolve the jump of the direction at the pivot, an error of third
order in the length of a facet over that of the plate.
""",
    run=run,
    cost=13.0,
)

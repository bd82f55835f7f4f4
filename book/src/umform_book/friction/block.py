"""Block on a plane: stick, slip and reversal at a given displacement, creep under a force, slip around a circle."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform import mesh
from umform.analysis.run import Result
from umform.analysis.steps import Move
from umform.materials import SVK
from umform.model import Model
from umform.model.contact import Contact
from umform.model.terms.control import Control
from umform.model.tools.tool import Tool
from umform.surfaces import Plane
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot, rule_name
from umform_book.page import Page
from umform_book.variants import Variant

Floats = NDArray[np.float64]

EIGHT, EIGHTEEN = Variant("ANS3DEAS"), Variant("MI9K3DEAS")
LENGTH, WIDTH, HEIGHT, E = 4.0, 2.0, 1.0, 1e4
MU, PENETRATION, SLIP = 0.3, 2e-4, 1e-3
#: How far the upper face is pressed down; the pressure comes out as some four times what the settings expect.
PRESSED = 1e-3
#: Turning points of the way, in allowed elastic slips.
TURNS = (100.0, -150.0, 50.0)
#: Round-off of positions over the elastic slip.
EXACT = 1e-9


@dataclass(frozen=True)
class Block:
    """A block on a plane.

    Attributes
    ----------
    model, contact, plane
        What it is made of.
    press : Control
        Way of the upper face.
    push : tuple of Control
        Ways of all nodes along x and y.
    """

    model: Model
    contact: Contact
    plane: Tool
    press: Control
    push: tuple[Control, Control]


def block(variant: Variant, divisions: int, points: int | str, *, augmented: bool = False) -> Block:
    """The block on the plane; its nodes move along the plane together."""
    cells = variant.cells(divisions)
    body = mesh.strip(LENGTH, WIDTH, HEIGHT, (cells, max(cells // 2, 1)), cell=variant.cell)
    model = Model(body, variant.element, material=SVK(E=E, nu=0.0))
    all_nodes = np.arange(len(body.points))
    push = model.prescribe(all_nodes, "x", "way"), model.prescribe(all_nodes, "y", "across")
    press = model.prescribe("upper", "z", "press")
    plane = model.tool("plane", Plane((0.0, 0.0, float(body.points[:, 2].min())), (0.0, 0.0, 1.0)))
    contact = model.contact(
        "lower", plane, penetration=PENETRATION, points=points, friction=MU, slip=SLIP, augmented=augmented, name="foot"
    )
    contact.penalty = contact.penalty  # the penetration is prescribed: it must not grow
    return Block(model, contact, plane, press, push)


def stiffness(contact: Contact, pressure: float) -> float:
    """Traction per elastic slip: the bound, at the pressure of the allowed penetration or more, over the allowed slip.

    With multipliers it does not follow the pressure.
    """
    expected = contact.penalty * PENETRATION
    return MU * (expected if contact.augmented else max(pressure, expected)) / SLIP


def hysteresis(way: Floats, pressure: Floats, stiff: Floats) -> Floats:
    """Traction on the plane along a path: t = bound(t_n + stiff * change of path), exact along straight paths."""
    traction = np.zeros_like(way)
    for k in range(1, len(way)):
        bound = MU * pressure[k]
        traction[k] = np.clip(traction[k - 1] + stiff[k] * (way[k] - way[k - 1]), -bound, bound)
    return traction


def back_and_forth(page: Page, variant: Variant, divisions: int, points: int | str, augmented: bool) -> Result:
    """Press, push back and forth; press twice as hard at the end, while it slips."""
    made = block(variant, divisions, points, augmented=augmented)
    cosine, sine = 0.8, 0.6
    steps = [Move(made.press, -PRESSED, steps=2)]
    steps += [Move(made.push, [cosine * turn * SLIP, sine * turn * SLIP], steps=20) for turn in TURNS]
    last = TURNS[-1] + 50.0
    both = [made.press, *made.push]
    steps.append(Move(both, [-2 * PRESSED, cosine * last * SLIP, sine * last * SLIP], steps=10))
    label = f"{variant.label}, {divisions} intervals, {rule_name(points)}" + (", multipliers" if augmented else "")
    return page.solve(label, made.model, steps)


def deviation(result: Result) -> tuple[float, float, float]:
    """Largest deviation of the force from the closed form and across the path, over the bound; elastic slip."""
    contact, area = result.model.contacts[0], LENGTH * WIDTH
    way = 0.8 * result["way"] + 0.6 * result["across"]
    pressure = -result["plane_fz"] / area
    force = 0.8 * result["plane_fx"] + 0.6 * result["plane_fy"]
    sideways = 0.8 * result["plane_fy"] - 0.6 * result["plane_fx"]
    highest = np.maximum.accumulate(pressure)
    stiff = np.array([stiffness(contact, p) for p in highest])
    exact = rigid(way, pressure) if contact.augmented else hysteresis(way, pressure, stiff)
    bound = MU * area * pressure.max()
    return (
        float(np.abs(force - area * exact).max() / bound),
        float(np.abs(sideways).max() / bound),
        float(result["foot_elastic_slip"][1:].max()) / SLIP,
    )


def rigid(way: Floats, pressure: Floats) -> Floats:
    """Traction without any elastic slip: the bound, along the motion of the increment."""
    return MU * pressure * np.sign(np.diff(way, prepend=0.0))


def by_way(page: Page) -> None:
    """Three meshes, rules, with and without multipliers."""
    meshes = page.pick((2, 4, 8), (2,))
    rows: list[tuple[str | float | int, ...]] = []
    drawn: list[Curve] = []
    for variant in (EIGHT, EIGHTEEN):
        whole: tuple[int | str, ...] = ("nodes", 2, 5) if variant is EIGHT else ("nodes", 3)
        for points in page.pick(whole, whole[:2]):
            for augmented in (False, True):
                kind = "multipliers" if augmented else "penalty"
                label = f"{variant.label}, {rule_name(points)}, {kind}"
                found = []
                for divisions in meshes:
                    result = back_and_forth(page, variant, divisions, points, augmented)
                    found.append(deviation(result))
                    rows.append((label, divisions, *found[-1]))
                off, sideways, slip = np.max(found, axis=0)
                page.at_most(f"{label}, all meshes: deviation of the force over the bound", max(off, sideways), EXACT)
                if augmented:
                    page.at_most(f"{label}, all meshes: elastic slip over allowed", slip, 1.0)
                if variant is EIGHT and points != "nodes" and len(drawn) < 2:
                    way = (0.8 * result["way"] + 0.6 * result["across"]) / SLIP
                    force = 0.8 * result["plane_fx"] + 0.6 * result["plane_fy"]
                    drawn.append(Curve(kind, way, force / (-MU * result["plane_fz"][2]), "o-"))
    columns = (
        "element, rule",
        "intervals",
        "deviation of the force over the bound",
        "across the way",
        "elastic slip over allowed",
    )
    page.table("Pushed back and forth, then pressed twice as hard while it slips", columns, rows)
    figure = plot(drawn, "way over the allowed elastic slip", "force over mu N of the first part")
    page.figure("loop", figure, "Stick, slip, reversal; at the end the normal force doubles during the slip")


def by_force(page: Page) -> None:
    """The plane pushed by a force below the bound: it creeps by the elastic slip and no further."""
    rows: list[tuple[str | float | int, ...]] = []
    for augmented in (False, True):
        for divisions in page.pick((2, 4, 8), (2,)):
            made = block(EIGHT, divisions, 2, augmented=augmented)
            push = made.model.press(made.plane, "x", "push")
            normal = normal_force(made, augmented)
            steps = [Move(made.press, -PRESSED, steps=2), Move(push, 0.9 * MU * normal, steps=9)]
            kind = "multipliers" if augmented else "penalty"
            result = page.solve(f"force, {divisions} intervals, {kind}", made.model, steps)
            way, held = float(result["push_way"][-1]), MU * -float(result["plane_fz"][-1])
            part = float(result["push"][-1]) / held
            stiff = stiffness(made.contact, -float(result["plane_fz"].min()) / (LENGTH * WIDTH))
            exact = float(result["push"][-1]) / (stiff * LENGTH * WIDTH)
            rows.append((kind, divisions, part, way / SLIP, exact / SLIP, int(result["foot_slipping"][-1])))
            if augmented:
                page.at_most(
                    f"{kind}, {divisions} intervals: displacement under 0.9 of the bound, over allowed", way / SLIP, 1.0
                )
            else:
                page.check(f"{kind}, {divisions} intervals: displacement under 0.9 of the bound", way, exact, EXACT)
    columns = ("", "intervals", "force over bound", "way over allowed", "traction over stiffness", "points that slip")
    page.table("The plane pushed by a force below the bound", columns, rows)


def normal_force(made: Block, augmented: bool) -> float:
    """Expected normal force: block and penalty as springs in series; with multipliers the block alone."""
    soft = 0.0 if augmented else 1.0 / made.contact.penalty
    return PRESSED * LENGTH * WIDTH / (HEIGHT / E + soft)


def around(page: Page) -> None:
    """A circle: the elastic slip trails the motion at a constant angle."""
    radius = 10.0 * SLIP
    rows: list[tuple[str | float | int, ...]] = []
    for increments in page.pick((50, 100, 200, 400), (50, 100)):
        made = block(EIGHT, 2, 2)
        circle = [
            lambda fraction: radius * (math.cos(4.0 * math.pi * fraction) - 1.0),  # two turns
            lambda fraction: radius * math.sin(4.0 * math.pi * fraction),
        ]
        steps = [Move(made.press, -PRESSED, steps=2), Move(made.push, circle, steps=2 * increments)]
        result = page.solve(f"circle, {increments} increments a turn", made.model, steps)
        normal = -float(result["plane_fz"][-1])
        elastic = MU * normal / (stiffness(made.contact, normal / (LENGTH * WIDTH)) * LENGTH * WIDTH)
        work = float(result["friction_work"][-1] - result["friction_work"][-1 - increments])
        exact = MU * normal * 2.0 * np.pi * np.sqrt(radius**2 - elastic**2)
        force = np.hypot(result["plane_fx"][-1], result["plane_fy"][-1]) / (MU * normal)
        rows.append((increments, elastic / radius, work / exact, force - 1.0))
        lag = elastic / np.sqrt(radius**2 - elastic**2)  # the direction is that of the end of an increment
        within = 2.0 * np.pi / increments * (lag + np.pi / increments)
        page.check(f"{increments} increments a turn: work of a turn", work, exact, within)
        page.at_most(f"{increments} increments a turn: force over bound - 1", abs(force - 1.0), EXACT)
    columns = ("increments a turn", "elastic slip over radius", "work of a turn over exact", "force over bound - 1")
    page.table("Around a circle", columns, rows)


def run(page: Page) -> None:
    """Fill the page."""
    by_way(page)
    by_force(page)
    around(page)
    page.text(
        "Multipliers leave the allowed penetration, here a fifth of the travel of the press, and remove it in later "
        "increments while the press stands still: hence the drift of their balances."
    )


CASE = Case(
    name="friction-block",
    title="Block on a plane: stick, slip, reversal",
    problem=f"""
A block of {LENGTH:g} x {WIDTH:g} x {HEIGHT:g}, E = {E:g}, nu = 0, on a rigid plane with mu = {MU}; its upper face is
pressed down by {PRESSED:g}. Allowed penetration {PENETRATION:g}, allowed elastic slip {SLIP:g}. With the penalty alone,
and with multipliers.

* By displacement: all nodes move together in the direction (0.8, 0.6), to {", ".join(f"{turn:g}" for turn in TURNS)}
  elastic slips; then further, while the face is pressed down twice as far.
* By force: the nodes are held, 0.9 of the bound pushes the plane, and its displacement is measured.
* Around a circle of ten elastic slips.
""",
    reference="""
Closed forms. By displacement: a spring (bound at the largest pressure so far, at least that of the allowed
penetration, over the allowed elastic slip) that slips at mu p, with the pressure found; with multipliers the bound
itself, against the motion of the increment. By force: traction over that spring; with multipliers less than the
allowed slip. Circle of radius r: the elastic slip e = mu p / stiffness trails the motion at a constant angle, on a
circle of radius sqrt(r^2 - e^2), and the work of a turn is 2 pi sqrt(r^2 - e^2) mu N. Uncertainty: the traction has the
direction of the end of an increment, pi/n tan(lag) of the work for n increments a turn, sin(lag) = e/r; the checks
allow twice that and the chords, 2 (pi/n)^2.
""",
    run=run,
    cost=10.0,
)

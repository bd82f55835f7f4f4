"""Elastic strip drawn over an edge with friction: the closed form of the effect of bending, and the runs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import fsolve

from umform import mesh
from umform.analysis.run import Result
from umform.analysis.steps import Move
from umform.materials import SVK
from umform.model import Model
from umform.surfaces import Cylinder
from umform_book.contact.figures import Curve, plot, rule_name
from umform_book.contact.hertz_line import EIGHT, EIGHTEEN, least_rule
from umform_book.contact.rolling_edge import ENDS, SHARP, WIDE, Edge
from umform_book.contact.strip_on_cylinder import EI, THICKNESS, WIDTH, E
from umform_book.page import Page
from umform_book.variants import Variant

Floats = NDArray[np.float64]

MU = 0.2
#: How far the tool stands in the strip at first, so that a contact point touches it.
OVERLAP = 0.02
TRAVEL, MEASURED = 4.0, 2.0
#: Errors expected by intervals along the strip, as those of the strip that hangs over a cylinder.
EXPECTED = {60: 0.005, 120: 0.002, 240: 0.001}


@dataclass(frozen=True)
class Sliding:
    """An elastic strip that slides over an edge.

    Attributes
    ----------
    force : float
        That draws it.
    arc : float
        Angle that it lies on the edge.
    friction : float
        Sum of mu times all normal forces, at the lower face.
    """

    force: float
    arc: float
    friction: float


def sliding(weight: float, radius: float, angle: float, mu: float) -> Sliding:
    """Closed form for a strip without stretching and shear strain between two forces at an angle.

    On the arc the moment is EI/r, r = R + h/2, so the friction at the lower face needs the shear force
    Q = c q with c = mu h / 2r and q = p R; q = T - Q' and T' = mu q - Q give q ~ exp(k s), k (1 + c k) = mu R / r.
    Where the strip leaves the tool stands a line force P with its friction; beyond, M^2 / (2 EI) = F (1 - cos a).
    """
    r, half = radius + 0.5 * THICKNESS, 0.5 * THICKNESS
    c = mu * half / r
    k = (np.sqrt(1.0 + 4.0 * c * mu * radius / r) - 1.0) / (2.0 * c) if mu > 0 else 0.0

    def states(x: Floats) -> tuple[Floats, float, float]:
        before, after, first, last, force = x
        arc = angle - before - after
        q = (weight * np.cos(before) + mu * first) / (1.0 + c * k)
        end = q * np.exp(k * arc)
        free = [EI / r + half * mu * first, EI / r - half * mu * last]
        equations = [
            weight * np.sin(before) - first - c * q,
            last - force * np.sin(after) - c * end,
            force * np.cos(after) - end * (1.0 + c * k) - mu * last,
            free[0] ** 2 / (2.0 * EI) - weight * (1.0 - np.cos(before)),
            free[1] ** 2 / (2.0 * EI) - force * (1.0 - np.cos(after)),
        ]
        pressing = q * arc if k == 0.0 else (end - q) / k
        return np.array(equations), arc, mu * float(pressing + first + last)

    lift = np.arccos(1.0 - EI / (2.0 * weight * r * r))
    guess = np.array([lift, lift, weight * np.sin(lift), weight * np.sin(lift), weight * np.exp(mu * angle)])
    x = fsolve(lambda x: states(x)[0], guess, xtol=1e-13)
    _, arc, friction = states(x)
    return Sliding(float(x[4]), float(arc), friction)


def draw(page: Page, edge: Edge, variant: Variant, divisions: int, points: int | str, mu: float = MU) -> Result:
    """Apply the weight at one end of the flat strip, then draw the other one away from the edge."""
    strip = mesh.strip(ENDS[1] - ENDS[0], WIDTH, THICKNESS, (variant.cells(divisions), 1), cell=variant.cell)
    strip = strip.moved((ENDS[0], 0.0, 0.0))
    model = Model(strip, variant.element, material=SVK(E=E, nu=0.0))
    model.fix(np.arange(len(strip.points)), "y")
    tool = Cylinder((0.0, 0.0, OVERLAP - edge.radius - 0.5 * THICKNESS), "y", edge.radius)
    model.contact(
        "lower", tool, penalty=edge.penalty, points=points, friction=mu or None, slip=1e-3 if mu else None, name="tool"
    )
    load = model.traction("x1", (0.0, 0.0, -1 / (WIDTH * THICKNESS)), "force")
    model.prescribe("x0", "z", "level")
    pull = model.prescribe("x0", "x", "pull")
    hang = Move(load, lambda fraction: edge.weight * fraction**2, steps=40)
    label = f"R = {edge.radius:g}, {variant.label}, {divisions} intervals, {rule_name(points)}, mu = {mu:g}"
    return page.solve(label, model, [hang, Move(pull, -TRAVEL, steps=80)])


def over_exact(edge: Edge, result: Result) -> tuple[float, float, float]:
    """Mean force over the closed form, its swing over the mean, and the closed form over exp(mu theta) F1.

    The angle between the forces is that of the reactions: the strip is held level a little below where it would run.
    """
    way = -result["pull"]
    part = (result["step"] > 1) & (way > TRAVEL - MEASURED + 1e-9)
    along, up = -result["pull_force"][part], result["level_force"][part]
    angle = 0.5 * np.pi - float(np.arctan2(up.mean(), along.mean()))
    exact = sliding(edge.weight, edge.radius, angle, MU)
    force = np.hypot(along, up)
    plain = edge.weight * np.exp(MU * angle)
    return float(force.mean()) / exact.force, float(np.ptp(force) / force.mean()), exact.force / float(plain)


def by_weight(page: Page) -> None:
    """Two edges, elements and meshes."""
    rows: list[tuple[str | float | int, ...]] = []
    curves = []
    for edge in page.pick((WIDE, SHARP), (WIDE,)):
        exact = sliding(edge.weight, edge.radius, 0.5 * np.pi, MU)
        r = edge.radius + 0.5 * THICKNESS
        what = f"R = {edge.radius:g}: closed form, friction times R/r against the difference of the forces"
        page.check(what, exact.friction * edge.radius / r, exact.force - edge.weight, 1e-3)
        for variant in page.pick((EIGHT, EIGHTEEN), (EIGHT,)):
            for divisions in page.pick((60, 120, 240), (60,)):
                result = draw(page, edge, variant, divisions, least_rule(variant))
                ratio, swing, bending = over_exact(edge, result)
                label = f"R = {edge.radius:g}, {variant.label}"
                rows.append((label, divisions, ratio, 100 * swing, bending))
                if variant is EIGHT:
                    drawn = result["step"] > 1
                    way, force = -result["pull"][drawn], -result["pull_force"][drawn] / edge.weight
                    curves.append(Curve(f"R = {edge.radius:g}, {divisions} intervals", way, force))
                within = EXPECTED[divisions] * WIDE.radius / edge.radius
                page.check(f"{label}, {divisions} intervals: force over the closed form", ratio, 1.0, within)
    columns = ("", "intervals", "mean force over closed form", "swing %", "closed form over exp(mu theta) F1")
    page.table(f"Flat strip drawn over an edge by 90 degrees, mu = {MU}", columns, rows)
    figure = plot(curves, "way", "force over weight", level=float(np.exp(MU * np.pi / 2)))
    page.figure("drawn", figure, "Force that draws the flat strip over an edge; level: exp(mu theta)")

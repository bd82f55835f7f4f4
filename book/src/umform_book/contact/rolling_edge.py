"""Strip drawn over an edge under a hanging weight: the mean force is the weight; the mesh causes the oscillation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.analysis.run import Result
from umform.analysis.steps import Move
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot, rule_name
from umform_book.contact.hertz_line import EIGHT, EIGHTEEN
from umform_book.contact.strip_on_cylinder import EI, RADIUS, THICKNESS, WIDTH, E, flat_strip
from umform_book.page import Page
from umform_book.variants import Variant, with_tying

Floats = NDArray[np.float64]

ENDS = (-15.0, 45.0)
TRAVEL, MEASURED = 8.0, 4.0
#: Swing expected of a polygon, over (L/R)^2: a chord is shorter than its arc by L^3/(24 R^2); as a node passes an end
#: of the arc the path changes by this and back within L, like a sine: pi/12 (L/R)^2 from crest to trough, at both ends.
POLYGON = np.pi / 6


@dataclass(frozen=True)
class Edge:
    """An edge with the weight that hangs over it.

    Attributes
    ----------
    radius : float
        Of the edge.
    weight : float
        Chosen so that the strip takes the curvature of the edge.
    penalty : float
        Such that the pressure of the tension sinks it in by less than a thousandth of the radius.
    """

    radius: float
    weight: float
    penalty: float


WIDE = Edge(RADIUS, 3.0, 300.0)
SHARP = Edge(4.0, 6.0, 500.0)


@dataclass(frozen=True)
class Drawn:
    """Force over weight while the strip is drawn: path, curve, mean and range (largest minus smallest)."""

    way: Floats
    force: Floats

    @property
    def mean(self) -> float:
        """Mean over the path."""
        return float(self.force.mean())

    @property
    def swing(self) -> float:
        """Largest minus smallest."""
        return float(np.ptp(self.force))


def draw(page: Page, edge: Edge, variant: Variant, divisions: int, points: int | str, frames: int = 0) -> Result:
    """Hang the weight to the strip, then draw its other end away from the edge."""
    model, _, load = flat_strip(variant, divisions, ENDS, edge.penalty, points, radius=edge.radius)
    model.fix("x0", "z")
    pull = model.prescribe("x0", "x", "pull")
    hang = Move(load, lambda fraction: edge.weight * fraction**2, steps=40)
    label = f"R = {edge.radius:g}, {variant.label}, {divisions} intervals, {rule_name(points)}"
    return page.solve(label, model, [hang, Move(pull, -TRAVEL, steps=160)], frames=frames)


def measure(edge: Edge, result: Result) -> Drawn:
    """Force over weight on the last part of the path, a whole number of elements of every mesh."""
    way = -result["pull"]
    part = (result["step"] > 1) & (way > TRAVEL - MEASURED + 1e-9)
    return Drawn(way[part], -result["pull_force"][part] / edge.weight)


def by_edge(page: Page, edge: Edge) -> None:
    """Meshes and rules over one edge."""
    meshes = tuple(page.pick((30, 60, 120), (60,)))
    rows: list[tuple[str | float | int, ...]] = []
    swings, paths = [], []
    variants = page.pick((EIGHT, with_tying("ANS3DEAS"), EIGHTEEN), (EIGHT,))
    for variant in variants:
        whole: tuple[int | str, ...] = ("nodes", 2, 5) if variant is not EIGHTEEN else ("nodes", 3)
        rules = page.pick(whole, whole[:2])
        for points in page.each(rules, rule_name):
            label = f"{variant.label}, {rule_name(points)}"
            found = [measure(edge, draw(page, edge, variant, divisions, points)) for divisions in meshes]
            rows.append((label, *(value for drawn in found for value in (drawn.mean, 100 * drawn.swing))))
            lengths = [(ENDS[1] - ENDS[0]) / variant.cells(n) / edge.radius for n in meshes]
            swings.append(Curve(label, lengths, [100 * drawn.swing for drawn in found], "o-"))
            paths.append(Curve(label, found[0].way, found[0].force))
            for divisions, drawn in zip(meshes, found, strict=True):
                what = f"R = {edge.radius:g}, {label}, {divisions} intervals: mean of force over weight"
                page.check(what, drawn.mean, 1.0, 0.002)
                limit = POLYGON * ((ENDS[1] - ENDS[0]) / variant.cells(divisions) / edge.radius) ** 2
                what = f"R = {edge.radius:g}, {label}, {divisions} intervals: swing of force over weight"
                page.at_most(what, drawn.swing, limit)
    columns = [f"{n} intervals: {what}" for n in meshes for what in ("mean", "swing %")]
    page.table(f"R = {edge.radius:g}: force over weight", ("element, rule", *columns), rows)
    axes = ("length of an element over the radius", "largest minus smallest force, % of the weight")
    page.figure(
        f"swing-{edge.radius:g}", plot(swings, *axes, log="xy"), f"Oscillation of the force, R = {edge.radius:g}"
    )
    caption = f"Force while the strip is drawn, R = {edge.radius:g}, {meshes[0]} intervals"
    page.figure(f"force-{edge.radius:g}", plot(paths, "way", "force over weight", level=1.0), caption)


def run(page: Page) -> None:
    """Fill the page."""
    edges = page.pick((WIDE, SHARP), (WIDE,))
    for edge in edges:
        page.heading(f"Edge of R = {edge.radius:g}")
        by_edge(page, edge)
    page.text(
        "The mean is the weight for every rule and mesh: an elastic strip on a frictionless edge loses no work. The "
        "oscillation is that of the discretisation, as the strip makes a polygon of the arc. The arc of contact is "
        "long against an element here, so nodes and Gauss points hardly differ."
    )
    if page.images is not None:
        result = draw(page, WIDE, EIGHT, 60, 2, frames=1)
        page.shape("shape", result, "The strip at the end of its path", values="contact_pressure", view=(-80.0, 15.0))


CASE = Case(
    name="contact-rolling-edge",
    title="Strip drawn over an edge",
    problem=f"""
A flat strip, x from {ENDS[0]:g} to {ENDS[1]:g}, {WIDTH:g} wide, {THICKNESS:g} thick, E = {E:g}, nu = 0, u_y = 0, lies
on a rigid frictionless cylinder at x = 0. A weight T at its end x1 wraps it around the edge by nearly 90 degrees; then
its other end, held in z, is drawn away by {TRAVEL:g}. Measured over the last {MEASURED:g}, a whole number of elements:
mean and swing (largest minus smallest) of force over weight.

* Wide edge: R = {WIDE.radius:g}, T = {WIDE.weight:g}, T R^2/EI = {WIDE.weight * WIDE.radius**2 / EI:.0f}, penalty
  {WIDE.penalty:g}.
* Sharp edge: R = {SHARP.radius:g}, T = {SHARP.weight:g}, T R^2/EI = {SHARP.weight * SHARP.radius**2 / EI:.0f}, penalty
  {SHARP.penalty:g}.
""",
    reference="""
Closed form by energy: the elastic energy of the wrapped strip is constant, so the force is the weight; in a mesh, on
the average over each element that passes. Uncertainty: the weight hangs 1e-4 off the vertical.
""",
    run=run,
    cost=45.0,
)

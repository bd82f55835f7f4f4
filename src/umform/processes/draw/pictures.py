"""Pictures of a drawn part: forces, shape, thinning, forming limits, ears, outline, sections."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from umform.plotting import COLOURS, INK, Picture, draw_shape, house_style
from umform.processes.draw.cup import Cup
from umform.processes.draw.drawn import Drawn
from umform.processes.draw.u_bend import UBend
from umform.processes.draw.words import angles_text
from umform.processes.sizes_picture import sizes_figure
from umform.report.forming import limit_diagram
from umform.results.forming import lay_by_best_fit, lay_on_three_points
from umform.results.forming.u_bend import crossing
from umform.results.shape import Shape, outer_quads
from umform.surfaces import tool_sizes

Floats = NDArray[np.float64]

_SIZE = (6.6, 4.2)
#: Fields with their own picture, and the label of the colour bar.
FIELDS: Mapping[str, str] = {
    "thinning": "thinning in %",
    "major_middle": "major strain, logarithmic",
    "limit_margin": "margin to the forming limit",
    "wrinkling": "thickening, logarithmic",
    "punch_distance": "distance of the upper face from the punch in mm",
}


def pictures(drawn: Drawn) -> dict[str, Figure]:
    """All pictures by name, in the order of the report."""
    made = {"blank": blank(drawn.case), "curve": curve(drawn)}
    shape = part(drawn)
    made |= {name: coloured(shape, name, label) for name, label in FIELDS.items()}
    if drawn.released is not None:
        made["gauge"] = in_gauge(drawn, shape)
    made |= {"limits": limit_diagram(drawn.fields, drawn.limit), "outline": outline(drawn), "section": sections(drawn)}
    if isinstance(drawn.case, Cup):
        made["ears"] = ears(drawn)
    return made


def blank(case: Cup | UBend) -> Figure:
    """The mesh of the blank over the sizes that the radii of the tools ask for, eq. (5.69)."""
    model, _ = case.build()
    surfaces = {tool.name: tool.surface for tool in model.tools}
    X = model.mesh.points[:, :2]
    box = X.min(axis=0), X.max(axis=0)
    largest = float(np.diff(case.sizes.ends).max())
    sizes = tool_sizes(
        [surfaces["die"]], [surfaces["punch"]], box, thickness=case.thickness, turn=case.turn, largest=largest
    )
    mesh = model.mesh
    if not isinstance(case, Cup):  # the strip of unit width stands for the whole width
        stretch = np.array([1.0, 0.5 * case.width, 1.0])
        sizes = replace(sizes, y=sizes.y * stretch[1])
        mesh = mesh.transformed(lambda x: x * stretch)
    return sizes_figure(sizes, mesh)


def curve(drawn: Drawn) -> Figure:
    """Forces of the tools over the stroke."""
    with house_style():
        figure, axes = _axes("stroke in mm", "force in kN")
        for name, force in drawn.forces.items():
            axes.plot(drawn.stroke, force / 1000.0, label=name)
        axes.set_ylim(0.0, None)
        axes.legend()
    return figure


def part(drawn: Drawn) -> Shape:
    """The released part, with the fields of forming on its faces."""
    mesh = drawn.result.model.mesh
    quads, owners = outer_quads(mesh.connectivity.astype(np.int64))
    values = {name: drawn.fields[name][owners] for name in FIELDS if name in drawn.fields}
    values["punch_distance"] = drawn.punch_distance[quads].mean(axis=1)
    return _whole(drawn, Shape(mesh.points + drawn.u_free.reshape(-1, 3), quads, values))


def _whole(drawn: Drawn, shape: Shape) -> Shape:
    """The whole part from the computed half or quarter."""
    if not isinstance(drawn.case, Cup):
        stretched = shape.points * np.array([1.0, 0.5 * drawn.case.width, 1.0])
        shape = replace(shape, points=stretched)
    for axis in drawn.case.mirrored:
        shape = shape.mirrored(axis)
    return shape


def in_gauge(drawn: Drawn, free: Shape) -> Figure:
    """The whole part in a gauge of the shape at the end of the stroke: best fit, and on three points."""
    gauge = _whole(drawn, Shape.displaced(drawn.result.model.mesh, drawn.u.reshape(-1, 3)))
    part, places = free.points, gauge.points
    laid = {
        "best fit": lay_by_best_fit(part, places),
        "on three points": lay_on_three_points(part, places, _far_apart(places)),
    }
    with house_style():
        figure = Picture(figsize=(8.6, 3.8), layout="compressed")
        limits = (0.0, max(one.largest for one in laid.values()))
        for axes, (name, one) in zip(figure.subplots(1, 2), laid.items(), strict=True):
            values = {"distance": one.distance[free.quads].mean(axis=1)}
            shown = draw_shape(axes, Shape(one.points, free.quads, values), "distance", (-70.0, -25.0), limits)
            axes.set_title(f"{name}: up to {one.largest:.3g} mm")
        bar = figure.colorbar(shown, ax=figure.axes, shrink=0.75, aspect=25, pad=0.02)
        bar.set_label("distance from the gauge in mm")
        bar.outline.set_visible(False)
    return figure


def _far_apart(points: Floats) -> list[int]:
    """Three points of a large triangle: the farthest from the middle, then from that point, then from their line."""
    first = int(np.linalg.norm(points - points.mean(axis=0), axis=1).argmax())
    second = int(np.linalg.norm(points - points[first], axis=1).argmax())
    areas = np.linalg.norm(np.cross(points - points[first], points[second] - points[first]), axis=1)
    return [first, second, int(areas.argmax())]


def coloured(shape: Shape, name: str, label: str) -> Figure:
    """The part, coloured by a field."""
    with house_style():
        figure = Picture(figsize=_SIZE, layout="compressed")
        drawn = draw_shape(figure.add_subplot(), shape, name, (-70.0, -25.0))
        bar = figure.colorbar(drawn, ax=figure.axes, shrink=0.75, aspect=25, pad=0.02)
        bar.set_label(label)
        bar.outline.set_visible(False)
    return figure


def outline(drawn: Drawn) -> Figure:
    """Edge of the blank before drawing and at the end of the stroke."""
    edge = drawn.outline
    with house_style():
        figure, axes = _axes("x in mm", "y in mm")
        for label, points, line in (("blank", edge.before, "--"), ("end of the stroke", edge.after, "-")):
            axes.plot(*points.T, line, marker=".", markersize=3, label=label)
        if isinstance(drawn.case, Cup):
            axes.set_aspect("equal")
        axes.legend()
    return figure


def sections(drawn: Drawn) -> Figure:
    """Section of the part at the end of the stroke and, if it was released, after release."""
    cuts = {name: cut for name, cut in drawn.sections.items() if name == "drawn" or drawn.released is not None}
    with house_style():
        figure, axes = _axes("x in mm", "z in mm")
        for (name, cut), colour, line in zip(cuts.items(), COLOURS, ("--", "-"), strict=False):
            axes.plot(*cut.lower[:, [0, 2]].T, line, color=colour, label=name)
            axes.plot(*cut.upper[:, [0, 2]].T, line, color=colour)
        if drawn.angles is not None and drawn.wall_heights is not None:
            middle = drawn.sections["released"].middle[:, [0, 2]]
            wall = np.array([crossing(middle, height) for height in drawn.wall_heights])
            axes.plot(*wall.T, "o", color=INK, markersize=4, label="points of the wall")
            axes.set_title(angles_text(drawn))
        axes.set_aspect("equal")
        axes.legend()
    return figure


def ears(drawn: Drawn) -> Figure:
    """Height of the cup over the angle to the rolling direction."""
    whole = drawn.ears.whole()
    with house_style():
        figure, axes = _axes("angle to the rolling direction in degrees", "height of the cup in mm")
        axes.plot(np.append(whole.angle, whole.angle[0] + 360.0), np.append(whole.height, whole.height[0]))
        axes.axhline(drawn.ears.mean, color=INK, linewidth=0.8, linestyle=":", label=f"mean {drawn.ears.mean:.2f}")
        axes.legend()
        axes.set_xticks(np.arange(0, 361, 45))
    return figure


def _axes(x: str, y: str) -> tuple[Figure, Axes]:
    figure = Picture(figsize=_SIZE, layout="constrained")
    axes = figure.add_subplot()
    axes.set(xlabel=x, ylabel=y)
    return figure, axes

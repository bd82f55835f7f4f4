"""Pictures of a drawn part: forces, shape, thinning, forming limits, ears, outline, sections."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

from umform.processes.draw.cup import Cup
from umform.processes.draw.drawn import DRAW_IN, FORCE, HOLDER, Drawn
from umform.processes.draw.u_bend import UBend
from umform.processes.draw.words import angles_text
from umform.processes.sizes_picture import sizes_figure
from umform.report.forming import limit_diagram
from umform.report.part_pictures import (
    coloured,
    ears_picture,
    forces_picture,
    gauge_picture,
    outline_picture,
    section_picture,
    thinning_picture,
)
from umform.results.forming import BY_PATHS, MARGIN, THINNING, lay_by_best_fit, lay_on_three_points
from umform.results.forming.gauge import far_apart
from umform.results.forming.u_bend import crossing
from umform.results.shape import Shape, outer_quads
from umform.surfaces import tool_sizes

#: Fields with their own picture, and the label of the colour bar.
FIELDS: Mapping[str, str] = {
    "thinning": "thinning in %",
    "major_middle": "major strain, logarithmic",
    "limit_margin": "margin to the forming limit",
    "wrinkling": "thickening, logarithmic",
    "punch_distance": "distance of the upper face from the punch in mm",
}


def pictures(drawn: Drawn, before: Figure | None = None) -> dict[str, Figure]:
    """All pictures by name, in the order of the report; ``before``: that of the blank, if it has been drawn."""
    made = {"blank": before or blank(drawn.case), "curve": curve(drawn)}
    shape = part(drawn)
    made |= {name: coloured(shape, name, label) for name, label in FIELDS.items()}
    if drawn.released is not None:
        made["gauge"] = in_gauge(drawn, shape)
    made |= {"limits": limits(drawn), "outline": outline(drawn), "section": sections(drawn)}
    made["thinning_section"] = thinning(drawn)
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
    forces = {name: force / 1000.0 for name, force in drawn.forces.items()}
    errors = {tool: drawn[name].relative_error for tool, name in (("punch", FORCE), ("holder", HOLDER))}
    return forces_picture(drawn.stroke, forces, "stroke in mm", "force in kN", errors)


def thinning(drawn: Drawn) -> Figure:
    """Thinning along the section of the released part, with its band."""
    return thinning_picture(drawn.sections["released"], drawn.case.thickness, drawn[THINNING].error)


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
        "on three points": lay_on_three_points(part, places, far_apart(places)),
    }
    return gauge_picture(laid, free)


def outline(drawn: Drawn) -> Figure:
    """Edge of the blank before drawing and at the end of the stroke, with the band of the draw-in."""
    return outline_picture(drawn.outline, equal=isinstance(drawn.case, Cup), error=drawn[DRAW_IN].error)


def limits(drawn: Drawn) -> Figure:
    """Forming limit diagram of strains, with the band of the margin, and that of paths with the band of its use."""
    used = 0.0 if drawn.paths is None else 0.01 * drawn[BY_PATHS].error
    return limit_diagram(drawn.fields, drawn.limit, drawn.paths, drawn[MARGIN].error, used)


def sections(drawn: Drawn) -> Figure:
    """Section of the part at the end of the stroke and, if it was released, after release."""
    cuts = {name: cut for name, cut in drawn.sections.items() if name == "drawn" or drawn.released is not None}
    along, wall, title = np.array([1.0, 0.0, 0.0]), None, ""
    if drawn.angles is not None and drawn.wall_heights is not None:
        line = drawn.sections["released"].line(along)
        wall, title = np.array([crossing(line, height) for height in drawn.wall_heights]), angles_text(drawn)
    return section_picture(cuts, along, points=wall, title=title)


def ears(drawn: Drawn) -> Figure:
    """Height of the cup over the angle to the rolling direction, which is the x-axis, with the widest of its bands."""
    error = max(drawn[name].error for name in drawn.ears.heights())
    return ears_picture(drawn.ears, zero="the rolling direction", error=error)

"""Pictures of an estimated blank."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.tri import Triangulation

from umform.flat_pattern.one_step.estimate import BlankEstimate
from umform.plotting import COLOUR_MAP, COLOURS, Picture, frame, house_style
from umform.report.part_pictures import coloured
from umform.results.shape import Shape


def pictures(found: BlankEstimate) -> dict[str, Figure]:
    """All pictures by name."""
    return {"flat": flat(found), "thinning": thinning(found), "limits": limits(found)}


def flat(found: BlankEstimate) -> Figure:
    """The blank with its outlines, coloured by thinning; the formed outline dashed."""
    with house_style():
        figure = Picture(figsize=(6.6, 5.2))
        axes = figure.add_subplot()
        frame(figure)
        mesh = Triangulation(found.flat[:, 0], found.flat[:, 1], found.sheet.triangles)
        drawn = axes.tripcolor(mesh, found.fields["thinning"], cmap=COLOUR_MAP)
        for loop in found.sheet.loops:
            closed = [*loop, loop[0]]
            axes.plot(*found.flat[closed].T, color="black", linewidth=1.2)
            axes.plot(*found.sheet.points[closed, :2].T, color=COLOURS[0], linewidth=0.9, linestyle="--")
        axes.set(xlabel="x in mm", ylabel="y in mm", aspect="equal")
        figure.colorbar(drawn, ax=axes, label="thinning in %")
    return figure


def thinning(found: BlankEstimate) -> Figure:
    """The formed part, coloured by thinning."""
    triangles = found.sheet.triangles
    quads = np.concatenate([triangles, triangles[:, 2:]], axis=1)
    return coloured(Shape(found.sheet.points, quads, dict(found.fields)), "thinning", "thinning in %")


def limits(found: BlankEstimate) -> Figure:
    """Forming limit diagram."""
    with house_style():
        figure = Picture(figsize=(6.6, 4.2))
        axes = figure.add_subplot()
        frame(figure)
        minor, major = found.fields["minor"], found.fields["major"]
        axes.plot(minor, major, ".", color=COLOURS[0], markersize=2.5, label="triangles")
        line = np.linspace(min(float(minor.min()), -0.1), max(float(minor.max()), 0.1), 200)
        axes.plot(line, found.limit(line), color=COLOURS[1], label="forming limit")
        axes.set(xlabel="minor strain, logarithmic", ylabel="major strain, logarithmic")
        axes.legend()
    return figure

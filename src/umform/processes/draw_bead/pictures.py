"""Pictures of a draw bead: forces over the travel of the strip, and the sheet between its tools."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

from umform.plotting import COLOUR_MAP, COLOURS, Picture, house_style
from umform.processes.draw_bead.measures import Drawn

Floats = NDArray[np.float64]

_BLUE, _VERMILION, _GREEN = COLOURS[:3]
_TOOL: dict[str, Any] = {"facecolor": "#d9dde2", "edgecolor": "#555555", "linewidth": 0.8}
_FIELD = "plastic_strain_mean"


def curve(drawn: Drawn) -> Figure:
    """Restraining force and uplift over the travel, with their means over the steady part."""
    with house_style():
        figure = Picture(figsize=(7.2, 4.0))
        axes = figure.subplots(gridspec_kw={"left": 0.1, "right": 0.98, "bottom": 0.13, "top": 0.96})
        lines = (
            ("restraining force", drawn.restraint_curve, drawn.restraint, _BLUE),
            ("uplift force", drawn.uplift_curve, drawn.uplift, _VERMILION),
        )
        for label, values, mean, colour in lines:
            axes.plot(drawn.way, values, color=colour, label=f"{label}, steady {mean:.1f} N/mm")
            axes.plot([drawn.case.through, drawn.way[-1]], [mean, mean], color=colour, linestyle="--", linewidth=1.0)
        axes.set(xlabel="way of the strip in mm", ylabel="force in N for each mm of the bead", ylim=(0.0, None))
        axes.legend()
    return figure


def shape(drawn: Drawn) -> Figure:
    """The sheet between the closed tools at the end, coloured by the plastic strain."""
    with house_style():
        figure = Picture(figsize=(8.0, 3.8))
        axes = figure.add_axes((0.02, 0.03, 0.84, 0.94))
        _draw_tools(axes, drawn)
        drawn_sheet = _draw_sheet(axes, drawn)
        far = 1.5 * drawn.case.reach
        low, high = -drawn.case.height - drawn.case.thickness, 3.0 * drawn.case.thickness
        axes.set(xlim=(-far, far), ylim=(1.3 * low, high), aspect="equal")
        axes.axis("off")
        bar = figure.colorbar(drawn_sheet, cax=figure.add_axes((0.89, 0.15, 0.015, 0.7)))
        bar.set_label("equivalent plastic strain, mean of the element")
        bar.outline.set_visible(False)
    return figure


def _draw_sheet(axes: Axes, drawn: Drawn) -> PolyCollection:
    """Sides of the elements at y = 0."""
    model, frame = drawn.result.model, drawn.result.frames[-1]
    x = model.mesh.points + frame.points["displacement"]
    corners = model.mesh.connectivity[:, _front(model.mesh.connectivity.shape[1])]
    quads = x[corners][:, :, [0, 2]]
    sheet = PolyCollection(list(quads), edgecolors="face", linewidths=0.3, cmap=COLOUR_MAP, array=frame.cells[_FIELD])
    axes.add_collection(sheet)
    return sheet


def _front(nodes: int) -> list[int]:
    """Corners of the side at y = 0: those of natural coordinate s = -1, below and above."""
    half = nodes // 2
    return [0, 1, half + 1, half]


def _draw_tools(axes: Axes, drawn: Drawn) -> None:
    case, far = drawn.case, 4.0 * drawn.case.reach
    chord = 1e-3 * case.thickness
    below = case.lower_tool.profile.points(chord, far)
    axes.fill(*np.concatenate([below, [[below[-1, 0], -far], [below[0, 0], -far]]]).T, zorder=0, **_TOOL)
    above = case.profile.points(chord, 0.0) + np.array([0.0, case.thickness + case.air])
    axes.fill(*np.concatenate([above, [[above[-1, 0], far], [above[0, 0], far]]]).T, zorder=0, **_TOOL)

"""Pictures of a part: each bend under load in its tools, and the part."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from umform.plotting import COLOURS, INK, Picture, house_style
from umform.processes.bend_sequence.collisions import die_body, punch_body
from umform.processes.bend_sequence.part import BendDone, Part

_TOOL: dict[str, Any] = {"facecolor": "#d9dde2", "edgecolor": "#555555", "linewidth": 0.8, "zorder": 0}
_SHEET: dict[str, Any] = {"facecolor": COLOURS[0], "edgecolor": INK, "linewidth": 0.4, "zorder": 2}
#: Pictures in a row, and the size of each in inches.
_ACROSS, _SIZE = 3, 3.2


def picture(part: Part) -> Figure:
    """Each bend under load, and the part after the last one; all in true proportion."""
    count = len(part.bends) + 1
    rows = math.ceil(count / _ACROSS)
    columns = min(count, _ACROSS)
    with house_style():
        figure = Picture(figsize=(_SIZE * columns, _SIZE * rows))
        grid = figure.subplots(rows, columns, squeeze=False).ravel()
        for number, (axes, done) in enumerate(zip(grid, part.bends, strict=False), start=1):
            _draw_bend(axes, part, done)
            axes.set_title(f"{number}: {done.measures.loaded_angle:.1f}° under load")
        grid[count - 1].fill(*part.profile.T, **_SHEET)
        grid[count - 1].set_title("part: " + ", ".join(f"{angle:.1f}°" for angle in part.angles))
        for axes in grid:
            axes.set_aspect("equal")
            axes.axis("off")
    return figure


def _draw_bend(axes: Axes, part: Part, done: BendDone) -> None:
    case, bodies = part.sequence.case(done.bend), part.sequence.bodies
    stroke, strip = max(done.states[:-1] or done.states, key=lambda state: state[0])
    lift = np.array([0.0, case.thickness - stroke])
    step = 0.01 * case.opening
    axes.fill(*die_body(case, bodies).points(step, 1.0).T, **_TOOL)
    axes.fill(*(punch_body(case, bodies).points(step, 1.0) + lift).T, **_TOOL)
    axes.fill(*strip.outline.T, **_SHEET)
    x = np.concatenate([strip.outline, [[-case.opening, -case.opening], [case.opening, 2.0 * case.opening]]])
    low, high = x.min(axis=0), x.max(axis=0)
    axes.set(xlim=(low[0] - 2.0, high[0] + 2.0), ylim=(low[1] - 2.0, high[1] + 2.0))

"""Pictures of air bending: force and angle over the stroke; the sheet with its tools, under load and released."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

from umform.model.equations.frame import Frame
from umform.plotting import COLOUR_MAP, COLOURS, Picture, house_style
from umform.processes.air_bending.bend import AirBend
from umform.processes.air_bending.formulas import RULE, shop_forces
from umform.processes.air_bending.measures import Measures
from umform.processes.air_bending.section import Section
from umform.processes.air_bending.spec import AirBending
from umform.report.part_pictures import shade
from umform.results.quantity import FORCE_PER_LENGTH

Floats = NDArray[np.float64]

_BLUE, _VERMILION, _GREEN = COLOURS[:3]
_TOOL: dict[str, Any] = {"facecolor": "#d9dde2", "edgecolor": "#555555", "linewidth": 0.8}
_FIELD = "plastic_strain_mean"
#: Where axes lie in a figure: to find room for their labels takes matplotlib longer than to draw them.
_CURVES = {"left": 0.07, "right": 0.99, "bottom": 0.14, "top": 0.92, "wspace": 0.2}
_SHAPES = {"left": 0.01, "right": 0.9, "bottom": 0.02, "top": 0.92, "wspace": 0.03}
_BAR = (0.92, 0.12, 0.012, 0.7)


def curves(bend: AirBend, table: Sequence[Measures] = ()) -> Figure:
    """Force over stroke in loading and unloading; angle over stroke under load and after unloading."""
    with house_style():
        figure = Picture(figsize=(9.0, 3.6))
        left, right = figure.subplots(1, 2, gridspec_kw=_CURVES)
        _draw_force(left, bend)
        _draw_angle(right, bend, table)
    return figure


def shapes(bend: AirBend) -> Figure:
    """The sheet and its tools under load, and after unloading, coloured by the plastic strain."""
    last = max(n for n, frame in enumerate(bend.result.frames) if bend.step[frame.number] < 2)
    each = bend.stack or (bend,)
    states = [
        (f"under load: {bend['loaded_angle'].full_text}", [one.loaded for one in each], bend.result.frames[last]),
        (f"released: {bend['angle'].full_text}", [one.released for one in each], bend.result.frames[-1]),
    ]
    largest = max(float(frame.cells[_FIELD].max()) for _, _, frame in states)
    with house_style():
        figure = Picture(figsize=(9.0, 4.2))
        grid = figure.subplots(1, 2, sharex=True, sharey=True, gridspec_kw=_SHAPES)
        for axes, (title, sections, frame) in zip(grid, states, strict=True):
            for number, section in enumerate(sections):
                drawn = _draw_sheet(axes, bend, section, frame, number)
                drawn.set_clim(0.0, largest)
            _draw_tools(axes, bend.case, bend.stroke[frame.number])
            axes.set_title(title)
            _frame(axes, bend)
        bar = figure.colorbar(drawn, cax=figure.add_axes(_BAR))
        bar.set_label("equivalent plastic strain, mean of the element")
        bar.outline.set_visible(False)
    return figure


def _draw_force(axes: Axes, bend: AirBend) -> None:
    down = bend.step < 2
    axes.plot(bend.stroke[down], bend.force[down], color=_BLUE, label="loading")
    back = np.flatnonzero(down)[-1]
    axes.plot(bend.stroke[back:], bend.force[back:], color=_VERMILION, label="unloading")
    error = bend["largest_force"].relative_error * np.abs(bend.force[down])
    shade(axes, bend.stroke[down], bend.force[down], error, _BLUE)
    low, high = shop_forces(bend.case)
    axes.axhspan(low, high, color=_GREEN, alpha=0.25, linewidth=0, label=RULE)
    axes.set(xlabel="stroke in mm", ylabel=f"force in {FORCE_PER_LENGTH}", title="Force")
    axes.set_ylim(0.0, 1.35 * max(high, float(bend.force.max())))
    axes.legend(loc="upper left")


def _draw_angle(axes: Axes, bend: AirBend, table: Sequence[Measures]) -> None:
    axes.plot(*bend.path.T, color=_BLUE, label="under load")
    rows = sorted([*table, bend.measures], key=lambda row: row.stroke)
    released = [(row.stroke, row.angle) for row in rows]
    axes.plot(*np.array(released).T, "o-", color=_VERMILION, markersize=4, label="after unloading")
    axes.set(xlabel="stroke in mm", ylabel="angle in degrees", title="Angle between the legs")
    axes.legend(loc="upper right")  # free, as the angle falls: no search for a place


def _draw_sheet(axes: Axes, bend: AirBend, section: Section, frame: Frame, number: int) -> PolyCollection:
    """Elements of the middle of a sheet, counted from the die from 0, and their mirror images."""
    order, levels = section.order, section.current.shape[1] - 1
    elements = (len(section.current) - 1) // order
    cells = bend.result.model.bodies[number].cells  # of each sheet
    values = frame.cells[_FIELD][cells].reshape(elements, -1, levels)[:, 0]
    lines = order * np.arange(elements)[:, None] + np.arange(order + 1)  # of each element
    x = section.current[lines]
    outlines = np.concatenate([x[:, :, :-1], x[:, ::-1, 1:]], axis=1).swapaxes(1, 2).reshape(-1, 2 * order + 2, 2)
    both: Any = np.concatenate([outlines, outlines * [-1.0, 1.0]])  # as a list it would take ten times as long
    drawn = PolyCollection(both, edgecolors="face", linewidths=0.3, cmap=COLOUR_MAP, array=np.tile(values.ravel(), 2))
    axes.add_collection(drawn)
    return drawn


def _draw_tools(axes: Axes, case: AirBending, stroke: float) -> None:
    far = 4.0 * case.half_length
    die = case.die.profile.points(1e-3 * case.thickness, far)
    axes.fill(*np.concatenate([die, [[die[-1, 0], -far], [die[0, 0], -far]]]).T, zorder=0, **_TOOL)
    punch = case.punch.profile.points(1e-3 * case.thickness, far) + np.array([0.0, case.height - stroke])
    axes.fill(*punch.T, zorder=0, **_TOOL)


def _frame(axes: Axes, bend: AirBend) -> None:
    """Show the sheet and as much of the tools as lies about it, in true proportion."""
    across = 1.1 * float(bend.loaded.current[..., 0].max())
    bottom = min(-0.5 * bend.case.opening / np.tan(np.radians(0.5 * bend.case.die_angle)), -bend.measures.stroke)
    axes.set(xlim=(-across, across), ylim=(1.15 * bottom, float(bend.loaded.current[..., 1].max()) + bend.case.height))
    axes.set_aspect("equal")
    axes.axis("off")

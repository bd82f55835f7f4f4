"""Figures of free bending: force over displacement, a panel for each mesh; and the deformed strips."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from umform.plotting import COLOURS, INK, Picture, camera, draw_shape, house_style
from umform.processes.bending.case import Bending
from umform.processes.bending.spec import FreeBending

BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY = COLOURS

#: Force of fine continuum meshes (C3D20R, 60x2x2 and 120x2x4 elements) at displacements of the example.
CONTINUUM = {2.0: 20.1, 5.0: 21.6, 10.0: 23.2}
#: The same at the end, where the hinge localises and the force depends on the mesh.
CONTINUUM_END = (15.0, 21.0, 23.0)

#: Field and point of view (azimuth, elevation) of the deformed strips.
_FIELD, _VIEW = "plastic_strain_max", (-82.0, 26.0)

_CONTACT_COLOURS = {"nodes": VERMILION, "2x2": BLUE, "3x3": BLUE, "5x5": GREEN}


def panels(runs: Sequence[Bending]) -> dict[tuple[str, str], list[Bending]]:
    """The runs of each element and mesh."""
    grouped: dict[tuple[str, str], list[Bending]] = {}
    for run in runs:
        grouped.setdefault((run.case.element, run.case.mesh_name), []).append(run)
    return grouped


def curves(runs: Sequence[Bending]) -> Figure:
    """Force over displacement in loading and unloading, one panel for each element and mesh."""
    groups = panels(runs)
    columns = 1 if len(groups) == 1 else 2
    rows = -(-len(groups) // columns)
    with house_style():
        figure = Picture(figsize=(4.6 * columns + 0.4, 3.5 * rows + 0.2), layout="constrained")
        grid = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
        for axes, ((element, mesh), group) in zip(grid.flat, groups.items(), strict=False):
            _draw_panel(axes, group)
            axes.set_title(f"{element}, {mesh.replace('x', ' × ')} elements")
        for axes in grid.flat[len(groups) :]:
            axes.set_visible(False)
        for axes in grid[-1]:
            axes.set_xlabel("displacement u [mm]")
        for axes in grid[:, 0]:
            axes.set_ylabel("force F [N]")
        grid[0, 0].set_xlim(left=0.0)
        grid[0, 0].set_ylim(bottom=0.0)
    return figure


def _draw_panel(axes: Axes, group: Sequence[Bending]) -> None:
    others = iter((ORANGE, SKY, PURPLE))
    for run in group:
        case = run.case
        paper = case.is_paper_element
        colour = (_CONTACT_COLOURS.get(case.contact_name) or next(others, INK)) if paper else INK
        label = _contact_label(case) if paper else f"{_contact_label(case)}, {_variant_label(case)}"
        dash: Any = "-" if paper else (0, (5, 2))
        bent = run.step < 2
        back = max(int(bent.sum()) - 1, 0)  # the release starts at the end of the stroke
        axes.plot(run.u[bent], run.F[bent], color=colour, linestyle=dash, label=label, linewidth=1.2)
        axes.plot(run.u[back:], run.F[back:], color=colour, linestyle=dash, linewidth=0.8, alpha=0.8)
    if all(run.case.is_example for run in group):
        marks: dict[str, Any] = {"color": INK, "markerfacecolor": "white", "markersize": 5, "zorder": 5}
        axes.plot(list(CONTINUUM), list(CONTINUUM.values()), "D", label="continuum", **marks)
        u, low, high = CONTINUUM_END
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        axes.errorbar([u], [middle], yerr=[half], color=INK, capsize=4, capthick=1.4, elinewidth=1.4, zorder=5)
    axes.legend(loc="upper left", handlelength=2.4, fontsize=8)


def _contact_label(case: FreeBending) -> str:
    return "contact at nodes" if case.contact == "nodes" else f"contact {case.contact} × {case.contact}"


def _variant_label(case: FreeBending) -> str:
    return f"{case.variant_name.replace(' tied', ', E₃₃ tied')}, {case.thickness_points} pts."


def shapes(runs: Sequence[Bending]) -> Figure:
    """Whole deformed strips on their tools, side by side, coloured by the plastic strain; one at least has a shape."""
    pictures = [(run, run.shape) for run in runs if run.shape is not None]
    top = max(float(shape.values[_FIELD].max()) for _, shape in pictures)
    with house_style():
        figure = Picture(figsize=(4.6 * len(pictures) + 0.4, 4.1), layout="constrained")
        grid = figure.subplots(1, len(pictures), sharex=True, sharey=True, squeeze=False)[0]
        for axes, (run, shape) in zip(grid, pictures, strict=True):
            for side in (-1.0, 1.0):
                _draw_tool(axes, run.case, side)
            drawn = draw_shape(axes, shape.mirrored(axis=0), _FIELD, _VIEW, (0.0, top))
            axes.set_title(run.case.name, loc="center")
        bar = figure.colorbar(drawn, ax=grid, orientation="horizontal", shrink=0.5, aspect=40, pad=0.02)
        bar.set_label("largest plastic strain in an element")
        bar.outline.set_visible(False)
    return figure


def _draw_tool(axes: Axes, case: FreeBending, side: float) -> None:
    """Upper half of a cylinder: its face towards the observer and its mantle."""
    towards, across, up = camera(*_VIEW)
    x, _, z = case.centre
    angles = np.linspace(0.0, np.pi, 61)
    ring = np.stack([side * x + case.radius * np.cos(angles), 0.0 * angles, z + case.radius * np.sin(angles)], axis=1)
    across_strip = case.width * np.array([0.0, 1.0, 0.0])
    front, back = ring - 0.2 * across_strip, ring + 1.2 * across_strip
    mantle = np.stack([front[:-1], front[1:], back[1:], back[:-1]], axis=1)
    outwards = mantle.mean(axis=1) - [side * x, 0.5 * case.width, z]
    flat = np.stack([across, up], axis=1)
    visible = list(mantle[outwards @ towards > 0.0] @ flat)
    axes.add_collection(PolyCollection(visible, facecolors="#d9dde1", edgecolors="#d9dde1", linewidths=0.3))
    axes.add_collection(PolyCollection([front @ flat], facecolors="#eceff1", edgecolors="#c3c9ce", linewidths=0.6))

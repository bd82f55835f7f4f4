"""Drawing of the measures: legs, angle, inside radius, neutral fibre, setback."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc
from numpy.typing import NDArray

from umform.plotting import COLOURS, INK, Picture, house_style
from umform.processes.air_bending.bend import AirBend
from umform.processes.air_bending.section import Section

Floats = NDArray[np.float64]

_BLUE, _VERMILION, _GREEN = COLOURS[:3]
#: Fixed axes: an automatic layout would double the time of the drawing.
_PLACE = (0.02, 0.02, 0.96, 0.96)
_THIN: dict[str, Any] = {"color": "#777777", "linewidth": 0.7, "linestyle": (0, (6, 3))}


def drawing(bend: AirBend) -> Figure:
    """The released section with its measures; none for a flat one."""
    section = bend.released
    with house_style():
        figure = Picture(figsize=(7.2, 5.0))
        axes = figure.add_axes(_PLACE)
        _draw_outline(axes, section)
        if section.is_bent:
            _draw_neutral_fibre(axes, section)
            _draw_radius(axes, section)
            _draw_legs(axes, section)
            axes.legend(loc="upper center")
        axes.set_aspect("equal")
        axes.axis("off")
    return figure


def _draw_outline(axes: Axes, section: Section) -> None:
    half = np.concatenate([section.fibre(0.0), section.fibre(1.0)[::-1]])
    outline = np.concatenate(
        [half[: len(half) // 2][::-1] * [-1.0, 1.0], half, half[len(half) // 2 :][::-1] * [-1.0, 1.0]]
    )
    axes.fill(*outline.T, facecolor="#d9dde2", edgecolor=INK, linewidth=1.0)


def _draw_neutral_fibre(axes: Axes, section: Section) -> None:
    fibre = section.fibre(section.neutral_height)
    both = np.concatenate([fibre[::-1] * [-1.0, 1.0], fibre])
    axes.plot(*both.T, color=_BLUE, label="neutral fibre: as long as in the flat sheet")


def _draw_radius(axes: Axes, section: Section) -> None:
    centre, radius = section.circle
    opening = 90.0 - section.angle / 2.0
    circle = Arc(
        (0.0, centre),
        2.0 * radius,
        2.0 * radius,
        theta1=-90.0 - opening,
        theta2=-90.0 + opening,
        color=_VERMILION,
        lw=1.6,
    )
    axes.add_patch(circle)
    at = math.radians(-90.0 + 0.5 * opening)
    rim = (radius * math.cos(at), centre + radius * math.sin(at))
    axes.annotate("", rim, (0.0, centre), arrowprops={"arrowstyle": "->", "color": _VERMILION})
    axes.plot([], [], color=_VERMILION, label=f"inside radius {radius:.2f} mm")


def _draw_legs(axes: Axes, section: Section) -> None:
    """Outer faces extended to the apex, with setback and leg on the right side, and the angle."""
    point, along = section.leg(0.0)
    apex = point - along * (point[0] / along[0])
    end = section.fibre(0.0)[-1]
    setback = (section.radius + section.thickness) * math.tan(section.slope)
    for sign in (1.0, -1.0):
        axes.plot(*np.stack([apex, end * [sign, 1.0]]).T, **_THIN)
    out = 0.8 * section.thickness * np.array([along[1], -along[0]])
    tangent = apex + setback * along
    for start, stop, name in ((apex, tangent, "setback"), (tangent, end, "leg")):
        axes.annotate("", stop + out, start + out, arrowprops={"arrowstyle": "<->", "color": _GREEN})
        x, z = 0.5 * (start + stop) + 1.5 * out
        axes.text(x, z, name, color=_GREEN, ha="left", va="top")
    for place in (apex, tangent, end):
        axes.plot(*np.stack([place, place + 1.2 * out]).T, color=_GREEN, linewidth=0.7)
    size, slope = 1.0 * setback, math.degrees(section.slope)
    axes.add_patch(Arc((apex[0], apex[1]), size, size, theta1=slope, theta2=180.0 - slope, color=INK, lw=0.8))
    axes.text(-0.6 * setback, apex[1], f"angle {section.angle:.1f}°", ha="right", va="center", color=INK)

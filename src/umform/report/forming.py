"""Forming of a run in its report: largest strains, thinning, and the forming limit diagram."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from umform.plotting import COLOURS, INK, Picture, frame, house_style
from umform.report import parts
from umform.results.forming import FormingLimit, PathFields
from umform.results.quantity import Quantity, table

Floats = NDArray[np.float64]


def limit_diagram(
    fields: Mapping[str, Floats],
    limit: FormingLimit | None,
    paths: PathFields | None = None,
    error: float = 0.0,
    used: float = 0.0,
) -> Figure:
    """Forming limit diagram: strains of all elements on both skins and in the middle, and the limit curve.

    Parameters
    ----------
    fields : mapping of str to ndarray
        Of :func:`umform.results.forming.forming_fields`.
    limit : callable, optional
        Largest major strain over the minor one; without it, the diagram has no curve.
    paths : PathFields, optional
        Use of the path-dependent limit, drawn beside the strains.
    error : float
        Error of the margin to the limit, drawn as a band below the curve.
    used : float
        Error of the share of the path-dependent limit that is used, drawn likewise.
    """
    with house_style():
        figure = Picture(figsize=(6.6 if paths is None else 11.4, 4.2))
        left, *right = figure.subplots(1, 1 if paths is None else 2, squeeze=False)[0]
        frame(figure)
        figure.subplots_adjust(wspace=0.22)
        _draw_strains(left, fields, limit, error)
        if paths is not None:
            _draw_paths(right[0], paths, used)
    return figure


def _draw_strains(axes: Axes, fields: Mapping[str, Floats], limit: FormingLimit | None, error: float) -> None:
    axes.set(xlabel="minor strain, logarithmic", ylabel="major strain, logarithmic")
    for name, colour in zip(("lower", "upper", "middle"), (COLOURS[5], COLOURS[4], COLOURS[0]), strict=True):
        axes.plot(fields[f"minor_{name}"], fields[f"major_{name}"], ".", color=colour, markersize=2.5, label=name)
    low, high = axes.get_xlim()
    minor = np.linspace(min(low, -0.1), max(high, 0.1), 200)
    if limit is not None:
        axes.plot(minor, limit(minor), color=COLOURS[1], label="forming limit")
        if error > 0.0:
            below = limit(minor) - error
            axes.fill_between(minor, below, limit(minor), color=COLOURS[1], alpha=0.2, linewidth=0, label="its band")
    axes.plot([0.0, min(low, 0.0)], [0.0, max(-low, 0.0)], color="#999999", linewidth=0.8, label="no thinning")
    axes.legend()


def _draw_paths(axes: Axes, paths: PathFields, error: float) -> None:
    """Effective strain as the radius over the direction of its rate, for each element, and the path of the worst."""
    reached, angle = paths.paths.effective, paths.paths.direction
    axes.plot(reached[-1] * np.sin(angle[-1]), reached[-1] * np.cos(angle[-1]), ".", color=COLOURS[0], markersize=2.5)
    worst = int(np.argmax(paths.use))
    line = reached[:, worst] * np.array([np.sin(angle[:, worst]), np.cos(angle[:, worst])])
    axes.plot(*line, "-", color=INK, linewidth=0.8, label="nearest to the limit")
    low, high = axes.get_xlim()
    top = axes.get_ylim()[1]
    around = np.radians(np.linspace(-44.0, 45.0, 200))
    radius = paths.limit(around)
    shown = np.isfinite(radius) & (radius < 3.0)
    curve = (radius * np.array([np.sin(around), np.cos(around)]))[:, shown]
    axes.plot(*curve, color=COLOURS[1], label="path-dependent limit")
    if error > 0.0:
        ring = np.hstack([curve, max(1.0 - error, 0.0) * curve[:, ::-1]])
        axes.fill(*ring, color=COLOURS[1], alpha=0.2, linewidth=0, label="its band")
    height = max(top, 1.3 * float(paths.limit(0.0)))
    axes.set(xlim=(min(low, -0.5 * height), max(high, 0.8 * height)), ylim=(min(axes.get_ylim()[0], 0.0), height))
    axes.set(
        xlabel="effective strain in the direction of the minor rate",
        ylabel="effective strain in that of the major rate",
    )
    axes.legend()


def forming_parts(numbers: Sequence[Quantity], diagram: Figure) -> Iterator[str]:
    """The part of a report, of :func:`umform.results.forming.extremes` and a diagram."""
    yield parts.heading("Forming")
    header, *rows = table(numbers)
    yield parts.table(header, rows)
    yield parts.figure(
        diagram,
        "Forming limit diagram: strains of all elements on both skins and in the middle; "
        "beside them, their effective strain over the direction of its rate. Shades are bands.",
    )

"""The plot of a sweep: measures over the first key that has numbers, one line for each combination of the others."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import cycle
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from umform.plotting import COLOURS, Plot, house_style, save
from umform.studies.sweep.measures import heading

#: Largest number of lines in a legend.
_MOST_NAMED = 12

Row = Mapping[str, Any]


def plot(rows: Sequence[Row], varied: Sequence[str], measures: Sequence[str], path: str | Path | None = None) -> Figure:
    """Draw measures of the finished jobs over the first varied key, one panel for each.

    Parameters
    ----------
    rows : sequence of mapping
        Of the table.
    varied, measures : sequence of str
        Columns.
    path : str or Path, optional
        Where to save the picture: .png, .svg or .pdf.
    """
    several = [name for name in varied if len({row[name] for row in rows}) > 1]
    x = _abscissa(rows, several or varied)
    lines = _lines([row for row in rows if row["outcome"] == "done"], [name for name in several if name != x], x)
    with house_style():
        figure = Plot(figsize=(6.6, 1.2 + 2.6 * len(measures)), layout="constrained")
        panels = figure.subplots(len(measures), 1, squeeze=False, sharex=True)[:, 0]
        for axes, measure in zip(panels, measures, strict=True):
            _draw(axes, lines, x, measure)
            axes.set_ylabel(heading(rows, measure))
        panels[-1].set_xlabel(x)
        figure.align_ylabels()
        if 1 < len(lines) <= _MOST_NAMED:
            panels[0].legend()
    if path is not None:
        save(figure, path)
    return figure


def _abscissa(rows: Sequence[Row], varied: Sequence[str]) -> str:
    """The first key with numeric values; else the first one."""
    numbers = [name for name in varied if all(_is_number(row[name]) for row in rows)]
    return [*numbers, *varied][0]


def _lines(rows: Sequence[Row], others: Sequence[str], x: str) -> dict[str, list[Row]]:
    """Rows by the values of the other keys, each line from left to right."""
    lines: dict[str, list[Row]] = {}
    for row in rows:
        lines.setdefault(", ".join(f"{name} {row[name]}" for name in others), []).append(row)
    ordered = all(_is_number(row[x]) for row in rows)
    return {name: sorted(line, key=lambda row: row[x]) if ordered else line for name, line in lines.items()}


def _draw(axes: Axes, lines: Mapping[str, Sequence[Row]], x: str, measure: str) -> None:
    for (name, line), colour in zip(lines.items(), cycle(COLOURS)):
        kept = [row for row in line if row[measure] is not None]
        abscissa = [row[x] if _is_number(row[x]) else str(row[x]) for row in kept]
        axes.plot(abscissa, [row[measure] for row in kept], marker="o", markersize=3.5, color=colour, label=name)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)

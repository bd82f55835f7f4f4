"""Picture: measured curves over those of the last run, and single numbers in standard deviations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from umform.plotting import COLOURS, Plot, house_style, save
from umform.studies.derivatives import Derivatives
from umform.studies.identification.data import Measured, MeasuredCurve

#: Columns of measured numbers and of those of the first and of the last run.
Table = Mapping[str, Sequence[Any]]


def picture(
    data: Sequence[Measured], table: Table, last: Sequence[Derivatives], path: str | Path | None = None
) -> Figure:
    """Measurements beside the run.

    Parameters
    ----------
    data : sequence of Measured
        Measurements.
    table : mapping of str to sequence
        The columns x, measured, deviation, before, found, a row for each measured number.
    last : sequence of Derivatives
        The last run of each measurement.
    path : str or Path, optional
        Picture to write.
    """
    ends = np.cumsum([len(one.numbers[0]) for one in data]).tolist()
    curves = [(n, one) for n, one in enumerate(data) if isinstance(one, MeasuredCurve)]
    numbers = [n for n, one in enumerate(data) if not isinstance(one, MeasuredCurve)]
    count = len(curves) + bool(numbers)
    with house_style():
        figure = Plot(figsize=(5.2 * count, 3.6), layout="constrained")
        places = list(np.atleast_1d(figure.subplots(1, count)))
        for axes, (n, curve) in zip(places, curves, strict=False):
            before = table["before"][ends[n] - len(curve.abscissae) : ends[n]]
            _curve(axes, curve, before, last[n])
        if numbers:
            _numbers(places[-1], [_label(data[n]) for n in numbers], table, [ends[n] - 1 for n in numbers])
    if path is not None:
        save(figure, path)
    return figure


def _label(one: Measured) -> str:
    return f"{one.name} ({', '.join(f'{k} {v}' for k, v in one.at.items())})" if one.at else one.name


def _curve(axes: Axes, curve: MeasuredCurve, before: Sequence[float], last: Derivatives) -> None:
    x, (y, deviation) = curve.abscissae, curve.numbers
    bars = deviation if curve.known else None
    axes.errorbar(x, y, bars, fmt="o", markersize=3, linewidth=0.8, color=COLOURS[1], label="measured")
    axes.plot(x, before, ":", color="#777777", label="before")
    axes.plot(*curve.columns(last), color=COLOURS[0], linewidth=1.2, label="found")
    axes.set(xlabel=curve.x, ylabel=curve.y)
    axes.legend()


def _numbers(axes: Axes, labels: Sequence[str], table: Table, rows: Sequence[int]) -> None:
    for key, mark, colour in (("before", "s", "#777777"), ("found", "o", COLOURS[0])):
        off = [(table[key][row] - table["measured"][row]) / table["deviation"][row] for row in rows]
        axes.plot(off, range(len(rows)), mark, color=colour, label=key)
    axes.axvline(0.0, color=COLOURS[1], label="measured")
    axes.set_yticks(range(len(rows)), labels)
    axes.set(xlabel="distance from the measurement in standard deviations", ylim=(-0.5, len(rows) - 0.5))
    axes.legend()

"""Picture of shares: a bar for each result, a colour for each source."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import cycle
from pathlib import Path

from matplotlib.figure import Figure

from umform.plotting import COLOURS, Plot, house_style, save
from umform.studies.scatter.spread import Spread


def bars(spreads: Sequence[Spread], path: str | Path | None = None) -> Figure:
    """Bars of the shares of the sources in the variance of each result, the first result on top.

    Negative shares, of correlated sources, are to the left of zero.

    Parameters
    ----------
    spreads : sequence of Spread
        Results that scatter.
    path : str or Path, optional
        Picture to write.
    """
    with house_style():
        figure = Plot(figsize=(7.2, 1.4 + 0.34 * max(1, len(spreads))), layout="constrained")
        axes = figure.add_subplot()
        ends = [[0.0, 0.0] for _ in spreads]  # of the bars so far: to the left, to the right
        for source, colour in zip(spreads[0].shares if spreads else (), cycle(COLOURS)):
            shares = [one.shares[source].value or 0.0 for one in spreads]
            starts = [end[share > 0.0] for end, share in zip(ends, shares, strict=True)]
            axes.barh(range(len(spreads)), shares, left=starts, color=colour, label=source, height=0.7)
            for end, share in zip(ends, shares, strict=True):
                end[share > 0.0] += share
        axes.set_yticks(
            range(len(spreads)),
            [f"{one.response.label}\nσ = {replace(one.deviation, band=None).full_text}" for one in spreads],
        )
        axes.invert_yaxis()
        axes.set_xlabel("share of the variance, %")
        if spreads:
            figure.legend(*axes.get_legend_handles_labels(), loc="outside upper left", ncols=3)
    if path is not None:
        save(figure, path)
    return figure

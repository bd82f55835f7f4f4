"""Plots of this chapter: lines over an abscissa, with circles for references."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from umform.plotting import INK, house_style

Floats = NDArray[np.float64]
Lines = Mapping[str, tuple[Floats, Floats]]


def lines_figure(
    x: str,
    panels: Mapping[str, Lines],
    *,
    references: Mapping[str, Lines] | None = None,
    logarithmic: bool = False,
) -> Figure:
    """Lines in one or more panels side by side.

    Parameters
    ----------
    x : str
        Label of the abscissa.
    panels : mapping of str to Lines
        Label of the ordinate of each panel and its lines: name -> (abscissae, ordinates).
    references : mapping of str to Lines, optional
        Black dashed lines of the panels.
    logarithmic : bool
        Whether the ordinates are drawn in a logarithmic scale.
    """
    styles = ("-", "--", ":")
    with house_style():
        figure = Figure(figsize=(1.4 + 3.2 * len(panels), 3.4) if len(panels) > 1 else (6.2, 3.6), layout="constrained")
        for axes, (y, lines) in zip(np.ravel(figure.subplots(1, len(panels))), panels.items(), strict=True):
            assert isinstance(axes, Axes)
            for name, (abscissae, ordinates) in (references or {}).get(y, {}).items():
                axes.plot(abscissae, ordinates, color=INK, linewidth=2.2, alpha=0.35, label=name)
            for number, (name, (abscissae, ordinates)) in enumerate(lines.items()):
                marker = "o" if len(abscissae) < 20 else ""
                axes.plot(abscissae, ordinates, styles[number // 6 % 3], marker=marker, markersize=3, label=name)
            axes.set_xlabel(x)
            axes.set_ylabel(y)
            if logarithmic:
                axes.set_yscale("log")
            axes.legend(fontsize=7)
    return figure

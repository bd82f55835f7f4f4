"""Plots of this chapter and the next: curves with labels, and names of contact rules."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from umform.plotting import COLOURS, house_style


@dataclass(frozen=True)
class Curve:
    """A curve of a plot.

    Attributes
    ----------
    label : str
        Name in the legend; empty for none.
    x, y : array_like, shape (n,)
        Its points.
    style : str
        Line and marker, as matplotlib takes them.
    """

    label: str
    x: ArrayLike
    y: ArrayLike
    style: str = "-"


def plot(
    curves: Iterable[Curve],
    x: str,
    y: str,
    *,
    log: str = "",
    level: float | None = None,
    limits: tuple[float, float] | None = None,
) -> Figure:
    """Draw curves into one pair of axes.

    Parameters
    ----------
    curves : iterable of Curve
        The curves.
    x, y : str
        Names of the axes.
    log : str
        Axes that are logarithmic: "x", "y", "xy" or none.
    level : float, optional
        Where a thin horizontal line marks the reference.
    limits : tuple of float, optional
        Range of the ordinate.
    """
    with house_style():
        figure = Figure(figsize=(6.2, 3.6), layout="constrained")
        axes = figure.add_subplot()
        for number, curve in enumerate(curves):
            again = number >= len(COLOURS)  # a colour comes a second time: thinner, with open markers
            width, fill = (0.6, "none") if again else (1.2, "full")
            label = curve.label or None
            axes.plot(curve.x, curve.y, curve.style, markersize=3, linewidth=width, fillstyle=fill, label=label)
        if level is not None:
            axes.axhline(level, color="#999999", linewidth=0.8)
        if "x" in log:
            axes.set_xscale("log")
        if "y" in log:
            axes.set_yscale("log")
        if limits is not None:
            axes.set_ylim(*limits)
        axes.set_xlabel(x)
        axes.set_ylabel(y)
        figure.legend(loc="outside right upper", fontsize=7, handlelength=2.4)
    return figure


def rule_name(points: int | str) -> str:
    """Name of a contact rule: nodes, 2 x 2."""
    return str(points) if points == "nodes" else f"{points} x {points}"

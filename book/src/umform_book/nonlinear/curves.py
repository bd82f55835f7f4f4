"""Load-displacement curves: how far reference points lie off a curve, and the plot of both."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from umform.plotting import COLOURS, INK, house_style
from umform_book.nonlinear.tracing import LOAD, Curve
from umform_book.variants import SEVEN, Variant

Floats = NDArray[np.float64]
_LINES: tuple[Any, ...] = ("-", "--", ":")


def distance(curve: Curve, reference: Curve) -> float:
    """Largest distance of the points of a reference from a curve, over all its columns.

    Measured in the plane of load over the largest load and displacement over the largest displacement of the
    reference, so that a steep part of the curve, where a displacement depends much on the load, counts no more than a
    flat one. The curve is taken as straight between its points.
    """
    loads = float(np.abs(reference[LOAD]).max())
    sizes = {name: float(np.abs(column).max()) for name, column in reference.items() if name != LOAD}
    return max(
        _distance_from_polyline(
            np.column_stack([reference[LOAD] / loads, reference[name] / size]),
            np.column_stack([curve[LOAD] / loads, curve[name] / size]),
        )
        for name, size in sizes.items()
    )


def _distance_from_polyline(points: Floats, corners: Floats) -> float:
    """Largest distance of points (n, 2) from the line through corners (m, 2)."""
    starts, along = corners[:-1], np.diff(corners, axis=0)
    lengths = np.maximum((along**2).sum(axis=1), 1e-300)
    offsets = points[:, None] - starts
    where = np.clip((offsets * along).sum(axis=-1) / lengths, 0.0, 1.0)
    return float(np.linalg.norm(offsets - where[..., None] * along, axis=-1).min(axis=1).max())


def curve_figure(
    fine: Mapping[Variant, Curve], coarse: Mapping[Variant, Curve], reference: Curve, names: Mapping[str, str]
) -> Figure:
    """Load over displacement: a colour for each element, pale on a coarse mesh, a kind of line for each probe."""
    colour = dict(zip(SEVEN, (*COLOURS, INK), strict=True))
    lines = dict(zip(names, _LINES, strict=False))
    with house_style():
        figure = Figure(figsize=(6.2, 3.8), layout="constrained")
        axes = figure.add_subplot()
        for curves, width, alpha in ((coarse, 0.8, 0.4), (fine, 1.1, 1.0)):
            for variant, curve in curves.items():
                for probe, line in lines.items():
                    axes.plot(curve[probe], curve[LOAD], line, color=colour[variant.name], linewidth=width, alpha=alpha)
        for probe in lines:
            axes.plot(reference[probe], reference[LOAD], "o", color=INK, markersize=3.5, fillstyle="none")
        handles = [Line2D([], [], color=colour[v.name], label=v.label) for v in fine]
        if len(names) > 1:
            handles += [Line2D([], [], color=INK, linestyle=line, label=names[probe]) for probe, line in lines.items()]
        handles += [Line2D([], [], color=INK, linestyle="", marker="o", fillstyle="none", label="reference")]
        axes.set_xlabel(", ".join(names.values()))
        axes.set_ylabel("load over full load")
        figure.legend(handles=handles, loc="outside right upper", fontsize=7)
    return figure

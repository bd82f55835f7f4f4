"""Forming of a run in its report: largest strains, thinning, and the forming limit diagram."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from umform.plotting import COLOURS, Picture, frame, house_style
from umform.report import parts
from umform.results.forming import FormingLimit

Floats = NDArray[np.float64]


def limit_diagram(fields: Mapping[str, Floats], limit: FormingLimit | None) -> Figure:
    """Forming limit diagram: strains of all elements on both skins and in the middle, and the limit curve.

    Parameters
    ----------
    fields : mapping of str to ndarray
        Of :func:`umform.results.forming.forming_fields`.
    limit : callable, optional
        Largest major strain over the minor one; without it, the diagram has no curve.
    """
    with house_style():
        figure = Picture(figsize=(6.6, 4.2))
        axes = figure.add_subplot()
        frame(figure)
        axes.set(xlabel="minor strain, logarithmic", ylabel="major strain, logarithmic")
        for name, colour in zip(("lower", "upper", "middle"), (COLOURS[5], COLOURS[4], COLOURS[0]), strict=True):
            axes.plot(fields[f"minor_{name}"], fields[f"major_{name}"], ".", color=colour, markersize=2.5, label=name)
        low, high = axes.get_xlim()
        minor = np.linspace(min(low, -0.1), max(high, 0.1), 200)
        if limit is not None:
            axes.plot(minor, limit(minor), color=COLOURS[1], label="forming limit")
        axes.plot([0.0, min(low, 0.0)], [0.0, max(-low, 0.0)], color="#999999", linewidth=0.8, label="no thinning")
        axes.legend()
    return figure


def measures(fields: Mapping[str, Floats]) -> list[list[str]]:
    """Rows of the extremes of the fields: name, value, unit."""
    rows = [
        ["largest thinning", f"{fields['thinning'].max():.4g}", "%"],
        ["largest thickening", f"{-fields['thinning'].min():.4g}", "%"],
        ["largest major strain in the middle", f"{fields['major_middle'].max():.4g}", ""],
    ]
    if "limit_margin" in fields:
        rows.append(["margin to the forming limit", f"{fields['limit_margin'].min():.4g}", ""])
    return rows


def forming_parts(fields: Mapping[str, Floats], diagram: Figure) -> Iterator[str]:
    """The part of a report."""
    yield parts.heading("Forming")
    yield parts.table(["quantity", "value", "unit"], measures(fields))
    yield parts.figure(diagram, "Forming limit diagram: strains of all elements on both skins and in the middle.")

"""A number of a problem against the mesh, for many elements: the table and the plot of the obstacle courses."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from umform.plotting import COLOURS, house_style
from umform_book.page import Page, StudyRecord
from umform_book.variants import SEVEN, Variant

#: found[variant][divisions]
Study = dict[Variant, dict[int, float]]


def study(
    page: Page,
    variants: Sequence[Variant],
    divisions: Sequence[int],
    compute: Callable[[Variant, int], float | None],
) -> Study:
    """Compute a number for each element on each mesh; NaN where there is none.

    Parameters
    ----------
    page : Page
        Called with the part that is done.
    variants : sequence of Variant
        The elements.
    divisions : sequence of int
        Meshes: intervals between nodes along an edge; 18-node elements have half as many elements.
    compute : callable
        variant, divisions -> number; NaN where no answer is found, None where none was looked for.
    """
    pairs = [(variant, number) for variant in variants for number in divisions]
    found: Study = {variant: {} for variant in variants}
    for variant, number in page.each(pairs, lambda pair: f"{pair[0].label}, {pair[1]}"):
        value = compute(variant, number)
        if value is not None:
            found[variant][number] = float(value)
    return found


def normalised(found: Study, reference: float) -> Study:
    """The numbers over a reference."""
    return {variant: {n: value / reference for n, value in row.items()} for variant, row in found.items()}


def show(
    page: Page, name: str, title: str, found: Study, *, mesh: str = "intervals between nodes along an edge"
) -> None:
    """Enter a normalised study into the page: a table with one column per mesh, and the plot over the meshes."""
    page.studies.append(StudyRecord(page.case.name, title, {v.label: dict(row) for v, row in found.items()}))
    divisions = sorted({number for row in found.values() for number in row})
    page.table(
        f"{title} ({mesh})",
        ("element", *(str(number) for number in divisions)),
        [(variant.label, *(row.get(number) for number in divisions)) for variant, row in found.items()],
    )
    page.figure(name, _plot(title, found, divisions, mesh), f"{title}; dashed: with E_33 tied")


def _plot(title: str, found: Mapping[Variant, Mapping[int, float]], divisions: Sequence[int], mesh: str) -> Figure:
    colour = dict(zip(SEVEN, (*COLOURS, "#222222"), strict=True))
    with house_style():
        figure = Figure(figsize=(6.2, 3.6), layout="constrained")
        axes = figure.add_subplot()
        for variant, row in found.items():
            numbers = np.round([row.get(number, np.nan) for number in divisions], 6)  # no round-off
            style = "--" if variant.options.get("tie_E33") else "-"
            axes.plot(
                divisions, numbers, style, marker="o", markersize=3, color=colour.get(variant.name), label=variant.label
            )
        axes.axhline(1.0, color="#999999", linewidth=0.8)
        axes.set_xscale("log")
        axes.xaxis.set_minor_locator(NullLocator())
        axes.set_xticks(divisions, [str(number) for number in divisions])
        axes.set_xlabel(mesh)
        axes.set_ylabel(title)
        figure.legend(loc="outside right upper", fontsize=7, handlelength=3.0)
    return figure

"""The report of a part with several bends."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import cycle
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from umform.plotting import COLOURS, Picture, house_style
from umform.processes.air_bending.page import parameters
from umform.processes.bend_sequence.part import Part
from umform.report import parts
from umform.report.page import outcome_parts
from umform.report.part_pictures import shade
from umform.results.quantity import FORCE_PER_LENGTH


def write_page(path: Path, part: Part, picture: Figure, note: str = "") -> Path:
    """Write the report.

    Parameters
    ----------
    path : Path
        The page, ending in .html.
    part : Part
        The part.
    picture : Figure
        The bends and the part.
    note : str
        Source of the material data; may be empty.
    """
    given = parameters(part.sequence.sheet)
    shape = parts.figure(picture, "Each bend under load in its tools, and the part after the last one.")
    content = outcome_parts(part, shape, _parts(part), given, note, model="Model of the last bend")
    return parts.write_html(path, part.title, f"plane strain; computed in {part.seconds:.1f} s", content)


def _parts(part: Part) -> Iterator[str]:
    yield parts.heading("Force")
    yield parts.figure(
        curves(part), "Force of the punch per length of bend over the stroke, with unloading; shades are bands."
    )


def curves(part: Part) -> Figure:
    """Force over stroke of all bends."""
    with house_style():
        figure = Picture(figsize=(6.2, 3.8))
        axes = figure.add_subplot()
        for (number, row), done, colour in zip(part.of_bends.items(), part.bends, cycle(COLOURS)):
            axes.plot(done.stroke, done.force, color=colour, label=f"bend {number}")
            largest = next(one for one in row if one.name == "largest_force")
            shade(axes, done.stroke, done.force, largest.relative_error * np.abs(done.force), colour)
        axes.set(xlabel="stroke in mm", ylabel=f"force in {FORCE_PER_LENGTH}")
        axes.legend()
    return figure

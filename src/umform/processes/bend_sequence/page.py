"""The report of a part with several bends."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from matplotlib.figure import Figure

from umform.plotting import COLOURS, Picture, house_style
from umform.processes.air_bending.page import parameters
from umform.processes.bend_sequence.part import Part
from umform.processes.bend_sequence.words import bend_rows, flanges, remarks
from umform.report import parts
from umform.report.page import closing, parameter_parts, settings
from umform.report.repeats import counted


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
    sheet = part.sequence.sheet
    title = f"Part of {len(part.bends)} bends: {sheet.thickness:g} mm sheet, {part.sequence.length:g} mm long"
    seconds = sum(done.result.seconds for done in part.bends)
    return parts.write_html(path, title, f"plane strain; {seconds:.1f} s", _parts(part, picture, note))


def _parts(part: Part, picture: Figure, note: str) -> Iterator[str]:
    for message in counted(part.warnings):
        yield parts.note(message, bad=True)
    header, *rows = bend_rows(part)
    yield parts.heading("Bends")
    yield parts.table(header, rows)
    yield parts.paragraph(flanges(part))
    yield from map(parts.note, remarks(part))
    yield parts.heading("Shape")
    yield parts.figure(picture, "Each bend under load in its tools, and the part after the last one.")
    yield parts.heading("Force")
    yield parts.figure(curves(part), "Force of the punch per mm of bend over the stroke, with unloading.")
    yield from parameter_parts(parameters(part.sequence.sheet), note)
    yield parts.heading("Model of the last bend")
    yield parts.pairs(settings(part.bends[-1].result))
    yield from closing(part.stages, part.bends[-1].result)


def curves(part: Part) -> Figure:
    """Force over stroke of all bends."""
    with house_style():
        figure = Picture(figsize=(6.2, 3.8))
        axes = figure.add_subplot()
        for number, done in enumerate(part.bends):
            axes.plot(done.stroke, done.force, color=COLOURS[number % len(COLOURS)], label=f"bend {number + 1}")
        axes.set(xlabel="stroke in mm", ylabel="force in N per mm of bend")
        axes.legend()
    return figure

"""The report of a draw bead: measures, curve, shape, equivalent bead, settings, versions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from matplotlib.figure import Figure

from umform.processes.draw_bead.equivalent import in_deck
from umform.processes.draw_bead.measures import Drawn
from umform.processes.draw_bead.words import parameters
from umform.processes.solution import solution_texts
from umform.report import parts
from umform.report.materials import material_text
from umform.report.page import outcome_parts


def write_page(path: Path, drawn: Drawn, figures: Mapping[str, Figure], note: str = "") -> Path:
    """Write the report of a bead.

    Parameters
    ----------
    path : Path
        The page, ending in .html.
    drawn : Drawn
        The bead.
    figures : mapping of str to Figure
        Curve and shape.
    note : str
        Source of the material data; may be empty.
    """
    lead = f"plane strain; computed in {drawn.seconds:.1f} s"
    case = drawn.case
    given = parameters(drawn) | solution_texts(case.newton, case.pace) | {"material": material_text(case.material)}
    shape = parts.figure(figures["shape"], "The sheet in the bead at the end.")
    return parts.write_html(path, drawn.title, lead, outcome_parts(drawn, shape, _parts(drawn, figures), given, note))


def _parts(drawn: Drawn, figures: Mapping[str, Figure]) -> Iterator[str]:
    yield parts.figure(figures["curve"], "Forces over the way of the strip; steady where the line is dashed.")
    yield parts.section("Equivalent bead, as a table of a deck", [parts.lines(in_deck(drawn))])

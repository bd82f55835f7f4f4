"""The report of a draw bead: measures, curve, shape, equivalent bead, settings, versions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from matplotlib.figure import Figure

from umform.processes.draw_bead.equivalent import in_deck
from umform.processes.draw_bead.measures import Drawn
from umform.processes.draw_bead.words import parameters, summary
from umform.report import parts
from umform.report.materials import material_text
from umform.report.page import closing, parameter_parts, settings
from umform.report.repeats import counted


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
    case, result = drawn.case, drawn.result
    title = f"Draw bead: {case.thickness:g} mm sheet, {drawn.forces[0]:.1f} N/mm"
    lead = f"plane strain; {int(result['iterations'].sum())} Newton iterations in {result.seconds:.1f} s"
    return parts.write_html(path, title, lead, _parts(drawn, figures, note))


def _parts(drawn: Drawn, figures: Mapping[str, Figure], note: str) -> Iterator[str]:
    for message in counted(drawn.warnings):
        yield parts.note(message, bad=True)
    yield parts.heading("Measures")
    yield parts.table(["quantity", "value", "unit"], summary(drawn))
    yield parts.figure(figures["curve"], "Forces over the way of the strip; steady where the line is dashed.")
    yield parts.figure(figures["shape"], "The sheet in the bead at the end.")
    yield parts.heading("Equivalent bead")
    yield parts.folded("Table of a deck", in_deck(drawn))
    yield from parameter_parts(parameters(drawn) | {"material": material_text(drawn.case.material)}, note)
    yield parts.heading("Model")
    yield parts.pairs(settings(drawn.result))
    yield from closing(drawn.stages, drawn.result)

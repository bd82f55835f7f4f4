"""The report of a bend: measures, curves, shapes, bending table, settings, versions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from umform.elements import element
from umform.processes.air_bending.bend import AirBend
from umform.processes.air_bending.formulas import shop_forces
from umform.processes.air_bending.measures import Measures
from umform.processes.air_bending.remarks import remarks, tools_text
from umform.processes.air_bending.spec import AirBending
from umform.processes.air_bending.words import summary, summary_header, table_header, table_rows
from umform.report import parts
from umform.report.live import Live, style
from umform.report.materials import material_text
from umform.report.page import closing, parameter_parts, settings
from umform.report.repeats import counted

if TYPE_CHECKING:
    from umform.processes.air_bending.budget import Budget

_BUDGET = (
    "± is the root of the sum of squares of the changes by the refinements beside it: the uncertainty from mesh, "
    "layers, points, penalty and increments. In the column stack, the sheet is eight layers of 8-node elements. "
    "Material data, friction and tools have uncertainties of their own."
)

#: Column of the chart: the force of the table of measures.
_FORCE = "force_per_mm"


def write_page(
    path: Path,
    bend: AirBend,
    figures: Mapping[str, Figure],
    table: Sequence[Measures],
    budget: Budget | None,
    deck: str = "",
    note: str = "",
) -> Path:
    """Write the report of a bend.

    Parameters
    ----------
    path : Path
        The page, ending in .html.
    bend : AirBend
        The bend.
    figures : mapping of str to Figure
        Curve, shape and drawing.
    table : sequence of Measures
        Bending table; may be empty.
    budget : Budget or None
        Error budget.
    deck : str
        The bend as a deck; may be empty.
    note : str
        Where the material comes from; may be empty.
    """
    case = bend.case
    kind = "plane strain" if case.width is None else f"{case.width:g} mm wide"
    title = f"Air bending: {case.thickness:g} mm sheet, {case.opening:g} mm opening, {bend.measures.angle:.2f} degrees"
    lead = f"{kind}; {bend.iterations} Newton iterations in {bend.result.seconds:.1f} s"
    live = Live.of(bend.result, stills=False, more={_FORCE: bend.force}, first=("stroke", _FORCE))
    content = _parts(bend, live, figures, table, budget, deck, note)
    return parts.write_html(path, title, lead, content, style=style(), scripts=live.scripts)


def _parts(
    bend: AirBend,
    live: Live,
    figures: Mapping[str, Figure],
    table: Sequence[Measures],
    budget: Budget | None,
    deck: str,
    note: str,
) -> Iterator[str]:
    for message in counted(bend.warnings):
        yield parts.note(message, bad=True)
    yield parts.heading("Measures")
    yield parts.table(summary_header(budget), summary(bend.measures, bend.case.width, budget))
    if budget:
        yield parts.paragraph(_BUDGET)
        for name, why in budget.failures.items():
            yield parts.note(f"{name}: {why}", bad=True)
    low, high = shop_forces(bend.case)
    yield parts.paragraph(f"The rule of the shop, 1.33 to 1.42 Rm t²/V, gives {low:.1f} to {high:.1f} N/mm.")
    yield parts.paragraph(tools_text(bend.case))
    yield from map(parts.note, remarks(bend.case, bend.measures))
    yield parts.figure(figures["drawing"], "What is measured.")
    yield parts.heading("Curves")
    yield parts.figure(figures["curve"], "Force and angle over the stroke.")
    yield live.curves
    yield parts.paragraph(
        f"{_FORCE}: force of the punch in N per mm of bend, that of the table of measures. Other forces are those of "
        "the modelled part of the sheet."
    )
    yield parts.heading("Shape")
    yield parts.figure(figures["shape"], "The sheet and its tools in true proportion.")
    yield live.shape
    yield from map(parts.note, live.notes)
    if table:
        yield parts.heading("Bending table")
        yield parts.table(table_header(), table_rows(table))
    yield parts.heading("History")
    yield live.table
    yield from parameter_parts(parameters(bend.case), note)
    yield parts.heading("Model")
    yield parts.pairs(settings(bend.result))
    if deck:
        yield parts.heading("Deck")
        yield parts.folded("The input of this bend, for umform run", deck)
    yield from closing(bend.stages, bend.result)


def parameters(case: AirBending) -> dict[str, object]:
    """The parameters of a bend, for people; those that follow from others are left out."""
    words = {"material": material_text(case.material), "element": element(case.element).name}
    drawn = {"punch_section": case.punch_section, "die_section": case.die_section}
    words |= {name: tool.words for name, tool in drawn.items() if tool is not None}
    record = case.record() | words | {"width": "plane strain" if case.width is None else case.width}
    return {name: value for name, value in record.items() if value is not None}

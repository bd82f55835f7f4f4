"""The report of a bend: measures, curves, shapes, bending table, settings, versions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from matplotlib.figure import Figure

from umform.elements import element
from umform.processes.air_bending.bend import AirBend
from umform.processes.air_bending.spec import AirBending
from umform.report import parts
from umform.report.live import Live, style
from umform.report.looks import MILLIMETRES
from umform.report.materials import material_text
from umform.report.page import outcome_parts
from umform.results.quantity import FORCE_PER_LENGTH

#: Column of the chart: the force of the table of measures.
_FORCE = f"force {FORCE_PER_LENGTH}"


def write_page(path: Path, bend: AirBend, figures: Mapping[str, Figure], deck: str = "", note: str = "") -> Path:
    """Write the report of a bend.

    Parameters
    ----------
    path : Path
        The page, ending in .html.
    bend : AirBend
        The bend.
    figures : mapping of str to Figure
        Curve, shape and drawing.
    deck : str
        The bend as a deck; may be empty.
    note : str
        Where the material comes from; may be empty.
    """
    kind = "plane strain" if bend.case.width is None else f"{bend.case.width:g} mm wide"
    lead = f"{kind}; computed in {bend.seconds:.1f} s"
    live = Live.of(bend.result, stills=False, more={_FORCE: bend.force}, first=("stroke", _FORCE), units=MILLIMETRES)
    given = parameters(bend.case)
    content = outcome_parts(bend, live.shape, _parts(live, figures, deck), given, note)
    return parts.write_html(path, bend.title, lead, content, style=style(), scripts=live.scripts)


def _parts(live: Live, figures: Mapping[str, Figure], deck: str) -> Iterator[str]:
    yield from map(parts.note, live.notes)
    yield parts.side_by_side(
        [
            parts.figure(figures["drawing"], "What is measured."),
            parts.figure(figures["shape"], "The sheet and its tools in true proportion."),
        ]
    )
    yield parts.heading("Curves")
    yield parts.figure(figures["curve"], "Force and angle over the stroke.")
    about = (
        f"{_FORCE}: force of the punch per length of bend, that of the measures. "
        "Other forces are those of the computed part of the sheet."
    )
    yield parts.section("History", [live.curves, parts.paragraph(about), live.table])
    if deck:
        yield parts.section("Deck", [parts.lines(deck)])


def parameters(case: AirBending) -> dict[str, object]:
    """The parameters of a bend, for people; those that follow from others are left out."""
    words = {"material": material_text(case.material), "element": element(case.element).name}
    drawn = {"punch_section": case.punch_section, "die_section": case.die_section}
    words |= {name: tool.words for name, tool in drawn.items() if tool is not None}
    record = case.record() | words | {"width": "plane strain" if case.width is None else case.width}
    return {name: value for name, value in record.items() if value is not None}

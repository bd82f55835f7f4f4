"""The report of a hem."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from matplotlib.figure import Figure

from umform.processes.air_bending.page import parameters
from umform.processes.hemming.measures import Hem
from umform.processes.hemming.words import remarks, rows
from umform.report import parts
from umform.report.page import closing, parameter_parts, settings
from umform.report.repeats import counted


def write_page(path: Path, hem: Hem, picture: Figure, note: str = "") -> Path:
    """Write the report.

    Parameters
    ----------
    path : Path
        The page, ending in .html.
    hem : Hem
        The hem.
    picture : Figure
        Force and section.
    note : str
        Source of the material data; may be empty.
    """
    case = hem.case
    title = f"Hem: {case.sheet.thickness:g} mm sheet, gap {case.gap:g} mm, {'insert' if case.insert else 'open'}"
    lead = f"plane strain; {hem.result.seconds + hem.first.bends[0].result.seconds:.1f} s"
    return parts.write_html(path, title, lead, _parts(hem, picture, note))


def _parts(hem: Hem, picture: Figure, note: str) -> Iterator[str]:
    for message in counted(hem.warnings):
        yield parts.note(message, bad=True)
    yield parts.heading("Measures")
    yield parts.table(["quantity", "value", "unit"], rows(hem.measures))
    yield from map(parts.note, remarks(hem))
    yield parts.heading("Force and section")
    yield parts.figure(picture, "Force of the plate per mm of hem, and the hem after unloading.")
    yield from parameter_parts(_given(hem), note)
    yield parts.heading("Model of the flattening")
    yield parts.pairs(settings(hem.result))
    yield from closing(hem.stages, hem.result)


def _given(hem: Hem) -> dict[str, object]:
    case = hem.case
    own = {name: getattr(case, name) for name in ("gap", "flange", "base", "insert", "angle")}
    return own | parameters(case.sheet)

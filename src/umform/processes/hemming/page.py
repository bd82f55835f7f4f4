"""The report of a hem."""

from __future__ import annotations

from pathlib import Path

from matplotlib.figure import Figure

from umform.processes.air_bending.page import parameters
from umform.processes.hemming.measures import Hem
from umform.report import parts
from umform.report.page import outcome_parts


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
    drawn = parts.figure(
        picture, "Force of the plate per length of hem, the hem after unloading, and the gap of flange and base."
    )
    content = outcome_parts(
        hem, drawn, (), hem.given | parameters(hem.case.sheet), note, model="Model of the flattening"
    )
    return parts.write_html(path, hem.title, f"plane strain; computed in {hem.seconds:.1f} s", content)

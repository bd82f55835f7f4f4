"""The files of a draw bead: curve, measures, pictures, fields, report."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Any

from umform.io.staging import staging
from umform.io.tables import write_csv, write_json
from umform.processes.draw_bead.equivalent import in_deck, in_python
from umform.processes.draw_bead.measures import Drawn
from umform.processes.draw_bead.words import parameters
from umform.report.versions import versions
from umform.results.outcome import QUANTITIES

_DATA = ("curve.csv", QUANTITIES, "bead.json", "bead.vtkhdf", "equivalent.toml")
_PAGE = ("curve.png", "curve.svg", "shape.png", "shape.svg", "report.html")
#: Files of a bead; they also mark a folder as that of a bead, with the files of a run that ended early.
FILES = (*_DATA, *_PAGE)
RESULTS = (*FILES, "history.csv")


def write_files(out: str | Path, drawn: Drawn, note: str = "") -> list[Path]:
    """Write all files of a bead.

    Parameters
    ----------
    out : str or Path
        Folder for curve.csv, quantities.csv, bead.json, bead.vtkhdf, equivalent.toml, curve and shape as .png and .svg,
        report.html.
    drawn : Drawn
        The bead.
    note : str, optional
        Source of the material data, for the report.

    Returns
    -------
    list of Path
        The files.
    """
    from umform.plotting import save
    from umform.processes.draw_bead.page import write_page
    from umform.processes.draw_bead.pictures import curve, shape

    with staging(out, FILES) as stage:
        here = stage.waiting
        columns = {
            "way mm": drawn.way,
            "restraint N/mm": drawn.restraint_curve,
            "uplift N/mm": drawn.uplift_curve,
        }
        write_csv(here / "curve.csv", columns)
        drawn.write(here)
        write_json(here / "bead.json", record(drawn))
        drawn.result.write(here / "bead.vtkhdf")
        (here / "equivalent.toml").write_text(in_deck(drawn), encoding="utf-8")
        files = stage.commit(_DATA)  # a failure of a picture must not lose the numbers
        figures = {"curve": curve(drawn), "shape": shape(drawn)}
        for name, figure in figures.items():
            for ending in (".png", ".svg"):
                save(figure, here / (name + ending))
        write_page(here / "report.html", drawn, figures, note)
        return [*files, *stage.commit(_PAGE)]


def record(drawn: Drawn) -> dict[str, Any]:
    """Parameters and measures as JSON data."""
    return {
        "parameters": parameters(drawn),
        "measures": drawn.values,
        "limits": {name: asdict(limit) for name, limit in drawn.limits.items()},
        "equivalent": in_python(drawn),
        **drawn.record(),
        "versions": versions(),
    }

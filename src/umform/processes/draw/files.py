"""The files of a drawn part: curve, measures, fields, profiles, pictures, report."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from umform.io.staging import staging
from umform.io.tables import write_csv, write_json
from umform.processes.draw.cup import Cup
from umform.processes.draw.drawn import Drawn
from umform.processes.draw.u_bend import UBend
from umform.processes.draw.words import parameters
from umform.report.versions import versions
from umform.results.forming.sections import columns as section_columns
from umform.results.outcome import QUANTITIES

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_PICTURES = (
    "blank", "curve", "thinning", "major_middle", "limit_margin", "wrinkling", "punch_distance", "gauge", "limits",
    "outline", "section", "thinning_section", "ears",
)  # fmt: skip
#: The mesh over the wanted sizes, drawn before the run.
_BEFORE = "blank.png"
_DATA = (
    "curve.csv", QUANTITIES, "fields.csv", "outline.csv", "section.csv", "ears.csv", "part.json", "draw.vtkhdf",
    "release.vtkhdf",
)  # fmt: skip
_PAGE = (*(f"{name}.png" for name in _PICTURES), "report.html")
#: Files of a part.
FILES = (*_DATA, *_PAGE)
#: Files that mark a folder as that of a part.
RESULTS = (*FILES, "history.csv")
#: Dots per inch of the pictures.
_DPI = 120


def write_files(out: str | Path, drawn: Drawn, note: str = "", blank: Figure | None = None) -> list[Path]:
    """Write all files of a part.

    Parameters
    ----------
    out : str or Path
        Folder for tables (.csv), part.json, the fields of both stages (.vtkhdf), pictures (.png), report.html.
    drawn : Drawn
        The part.
    note : str, optional
        Source of the material data, for the report.
    blank : Figure, optional
        The picture of the blank, if it has been drawn.

    Returns
    -------
    list of Path
        The files.
    """
    from umform.plotting import save
    from umform.processes.draw.page import write_page
    from umform.processes.draw.pictures import pictures

    with staging(out, FILES) as stage:
        here = stage.waiting
        _write_tables(here, drawn)
        drawn.write(here)
        write_json(here / "part.json", record(drawn))
        drawn.result.write(here / "draw.vtkhdf")
        if drawn.released is not None:
            for frame in drawn.released.frames:
                frame.points["punch_distance"] = drawn.distance_from_punch(frame.points["displacement"])
            drawn.released.write(here / "release.vtkhdf")
        files = stage.commit(_DATA)  # a failure of a picture must not lose the numbers
        figures = pictures(drawn, blank)
        for name, figure in figures.items():
            save(figure, here / f"{name}.png", dpi=_DPI)
        write_page(here / "report.html", drawn, figures, note)
        return [*files, *stage.commit(_PAGE)]


def draw_blank(out: str | Path, case: Cup | UBend) -> tuple[Path, Figure]:
    """Draw the mesh of the blank over the sizes that the tools ask for; before the run."""
    from umform.plotting import save
    from umform.processes.draw.pictures import blank

    with staging(out, (_BEFORE,)) as stage:
        figure = blank(case)
        save(figure, stage.waiting / _BEFORE, dpi=_DPI)
        return stage.commit((_BEFORE,))[0], figure


def _write_tables(here: Path, drawn: Drawn) -> None:
    result = drawn.result
    forces = {f"{name}_force N": values for name, values in drawn.forces.items()}
    work = {
        f"{name} N mm": drawn.case.parts * result[name] for name in ("external_work", "plastic_work", "friction_work")
    }
    write_csv(here / "curve.csv", {"stroke mm": drawn.stroke, **forces, **work})
    mesh = result.model.mesh
    middle = mesh.points[mesh.connectivity].mean(axis=1)
    distance = drawn.punch_distance[mesh.connectivity].mean(axis=1)
    fields = drawn.fields | {"punch_distance": distance}
    write_csv(here / "fields.csv", {"x": middle[:, 0], "y": middle[:, 1], **fields})
    write_csv(here / "outline.csv", drawn.outline.columns())
    write_csv(here / "section.csv", section_columns(drawn.sections))
    if isinstance(drawn.case, Cup):
        write_csv(here / "ears.csv", {"angle": drawn.ears.angle, "height": drawn.ears.height})


def record(drawn: Drawn) -> dict[str, Any]:
    """Parameters and measures as JSON data."""
    return {
        "parameters": parameters(drawn.case),
        "measures": drawn.values,
        "errors": {one.name: None if one.band is None else one.band.error for one in drawn.quantities},
        "about_errors": drawn.about_errors,
        "estimates": {name: asdict(limit) for name, limit in drawn.estimates.items()},
        "ending": None if drawn.ending is None else drawn.ending.text,
        "elements": len(drawn.result.model.mesh.connectivity),
        **drawn.record(),
        "versions": versions(),
    }

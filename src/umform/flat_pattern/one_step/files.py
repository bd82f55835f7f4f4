"""The files of an estimated blank: drawing, tables, numbers, pictures, page."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from umform.flat_pattern.one_step.estimate import ESTIMATE, BlankEstimate
from umform.io.staging import staging
from umform.io.tables import write_csv, write_json
from umform.results.outcome import QUANTITIES
from umform.surfaces.dxf import UNITS, dxf_library

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_DATA = ("blank.dxf", "outline.csv", "fields.csv", QUANTITIES, "blank.json")
_PICTURES = ("flat.png", "thinning.png", "limits.png")
#: Files of an estimate.
FILES = (*_DATA, *_PICTURES, "blank.html")
#: Layers of the drawing with their colours by the AutoCAD index, as in flat patterns of bent parts.
LAYERS = {"CONTOUR": 7, "HOLES": 5}
_DPI = 120
_CAPTIONS = {
    "flat": "The blank with its outline, coloured by the thinning of the formed part; the formed outline dashed.",
    "thinning": "Thinning of the formed part.",
    "limits": "Strains of all triangles and the forming limit.",
}


def write_files(out: str | Path, found: BlankEstimate, note: str = "") -> list[Path]:
    """Write drawing, tables, numbers, pictures and page.

    Parameters
    ----------
    out : str or Path
        The folder.
    found : BlankEstimate
        The estimate.
    note : str
        Source of the material data; may be empty.
    """
    from umform.flat_pattern.one_step.pictures import pictures
    from umform.plotting import save

    with staging(out, FILES) as stage:
        here = stage.waiting
        write_dxf(here / "blank.dxf", found.outlines)
        write_csv(here / "outline.csv", outline_columns(found))
        middle = found.sheet.points[found.sheet.triangles].mean(axis=1)
        flat = found.flat[found.sheet.triangles].mean(axis=1)
        places = dict(zip(("x", "y", "z", "flat_x", "flat_y"), [*middle.T, *flat.T], strict=True))
        write_csv(here / "fields.csv", places | found.fields)
        found.write(here)
        write_json(here / "blank.json", record(found))
        files = stage.commit(_DATA)
        figures = pictures(found)
        for name, figure in figures.items():
            save(figure, here / f"{name}.png", dpi=_DPI)
        _write_page(here / "blank.html", found, figures, note)
        return [*files, *stage.commit((*_PICTURES, "blank.html"))]


def outline_columns(found: BlankEstimate) -> dict[str, Any]:
    """Columns of a table of all outlines: number of the outline, place in the flat, place in the part."""
    number = np.repeat(np.arange(len(found.sheet.loops)), [len(loop) for loop in found.sheet.loops])
    loops = np.concatenate(found.sheet.loops)
    names = ("flat_x", "flat_y", "x", "y", "z")
    columns = [*found.flat[loops].T, *found.sheet.points[loops].T]
    return {"outline": number, **dict(zip(names, columns, strict=True))}


def write_dxf(path: Path, outlines: Iterable[NDArray[np.float64]], unit: str = "mm") -> None:
    """Write outlines in a unit as closed polylines, AutoCAD 2010: the outer one, then holes.

    Raises
    ------
    FileProblem
        If ezdxf is not installed.
    """
    ezdxf = dxf_library("writing", str(path))
    drawing = ezdxf.new("R2010")
    drawing.units = UNITS[unit]
    for name, colour in LAYERS.items():
        drawing.layers.add(name, color=colour)
    space = drawing.modelspace()
    for number, outline in enumerate(outlines):
        layer = "HOLES" if number else "CONTOUR"
        space.add_lwpolyline(outline.tolist(), format="xy", close=True, dxfattribs={"layer": layer})
    drawing.saveas(path)


def record(found: BlankEstimate) -> dict[str, Any]:
    """Parameters and numbers as JSON data."""
    from umform.report.versions import versions

    return {
        "part": found.name,
        "estimate": ESTIMATE,
        "parameters": parameters(found),
        "triangles": len(found.sheet.triangles),
        "loads": found.found.loads,
        **found.record(),
        "versions": versions(),
    }


def parameters(found: BlankEstimate) -> dict[str, Any]:
    """The input as text."""
    from umform.report.materials import material_text

    case = found.case
    given = {one.name: getattr(case, one.name) for one in fields(case)}
    return given | {"material": material_text(case.material)}


def _write_page(path: Path, found: BlankEstimate, figures: dict[str, Figure], note: str) -> None:
    from umform.report import parts
    from umform.report.live import style
    from umform.report.page import parameter_parts
    from umform.report.versions import versions

    content = [parts.note(text, bad=True) for text in found.warnings]
    content.append(parts.note(ESTIMATE))
    content.append(parts.first_screen(found.leading, parts.figure(figures["thinning"], _CAPTIONS["thinning"])))
    content.append(parts.items([text for text in found.all_notes if text != ESTIMATE]))
    content.append(parts.side_by_side(parts.figure(figures[name], _CAPTIONS[name]) for name in ("flat", "limits")))
    for title, (header, *rows) in found.tables.items():
        content.append(parts.section(title, [parts.table(header, rows)]))
    content += parameter_parts(parameters(found), note)
    content.append(parts.section("Versions", [parts.pairs(versions())]))
    lead = f"{len(found.sheet.triangles)} triangles; {found.iterations} iterations in {found.seconds:.1f} s"
    parts.write_html(path, found.title, lead, content, style=style())

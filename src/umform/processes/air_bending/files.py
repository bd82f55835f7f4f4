"""The files of a bend: tables, pictures, fields, report; they appear together or not at all."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from umform.elements import element
from umform.errors import InvalidValue
from umform.io.staging import staging
from umform.io.tables import write_csv, write_json
from umform.materials.laws import full_text
from umform.processes.air_bending.bend import AirBend
from umform.processes.air_bending.formulas import shop_forces, strength
from umform.processes.air_bending.measures import Measures
from umform.processes.air_bending.problem import problem_of
from umform.processes.air_bending.remarks import coarse_mesh
from umform.processes.air_bending.spec import AirBending
from umform.processes.air_bending.stack import StackedSheet
from umform.processes.air_bending.stacked import of_stack
from umform.report.versions import versions
from umform.results.outcome import QUANTITIES
from umform.results.quantity import FORCE_PER_LENGTH, columns, quantities_of, values

_DATA = ("curve.csv", "table.csv", QUANTITIES, "bend.json", "bend.vtkhdf", "bend.toml")
_PAGE = ("curve.png", "curve.svg", "shape.png", "shape.svg", "drawing.png", "drawing.svg", "report.html")
#: Files of a bend; they also mark a folder as that of a bend, with the files of a run that ended early.
FILES = (*_DATA, *_PAGE)
RESULTS = (*FILES, "history.csv")
#: Dots per inch of the PNG files, for screens; the SVG files serve for print. Most of the time compresses dots.
_DPI = 120


def write_files(out: str | Path, bend: AirBend, note: str = "") -> list[Path]:
    """Write all files of a bend.

    Parameters
    ----------
    out : str or Path
        Folder for curve.csv, quantities.csv, bend.json, bend.vtkhdf, bend.toml (the deck; not for your own hardening
        curve), curve, shape and drawing as .png and .svg, report.html, and table.csv if there is a table; made if it is
        missing.
    bend : AirBend
        The bend.
    note : str, optional
        Source of the material data, for the report.

    Returns
    -------
    list of Path
        The files.
    """
    from umform.plotting import save
    from umform.processes.air_bending.drawing import drawing
    from umform.processes.air_bending.page import write_page
    from umform.processes.air_bending.pictures import curves, shapes

    with staging(out, FILES) as stage:
        here = stage.waiting
        write_csv(
            here / "curve.csv", {"step": bend.step, "stroke mm": bend.stroke, f"force {FORCE_PER_LENGTH}": bend.force}
        )
        if bend.table:
            write_table(here / "table.csv", bend.table)
        bend.write(here)
        write_json(here / "bend.json", record(bend))
        bend.result.write(here / "bend.vtkhdf")
        deck = ""
        with suppress(InvalidValue):  # a deck cannot express a curve or an element of the user
            deck = problem_of(bend.case).toml()
            (here / "bend.toml").write_text(deck, encoding="utf-8")
        files = stage.commit(_DATA)  # a failure of a picture must not lose the numbers
        figures = {"curve": curves(bend, bend.table), "shape": shapes(bend), "drawing": drawing(bend)}
        for name, figure in figures.items():
            save(figure, here / f"{name}.png", dpi=_DPI)
            save(figure, here / f"{name}.svg")
        write_page(here / "report.html", bend, figures, deck, note)
        return [*files, *stage.commit(_PAGE)]


def write_table(path: Path, table: Sequence[Measures]) -> None:
    """Write all measures of a bending table, with units in the header; NaN for unknown ones."""
    found = columns([quantities_of(row) for row in table], units=True)
    write_csv(path, {name: [math.nan if one is None else one for one in column] for name, column in found.items()})


def record(bend: AirBend) -> dict[str, Any]:
    """Parameters, measures, table and budget as JSON data; None for unknown values."""
    budget = bend.budget
    content: dict[str, Any] = {
        **bend.record(),
        "parameters": parameters(bend.case),
        "measures": bend.values,
        "bend_length": bend.bend_length,
        "total_force": bend.total_force,
        "shop_forces": shop_forces(bend.case),
        "tensile_strength": strength(bend.case),
        **_told({"force_balance": bend.force_balance}),
        "penetration": bend.penetration,
        "coarse_mesh": coarse_mesh(bend.case),
        "versions": versions(),
        "sheets": [
            {**_of_sheet(one), **values(numbers)}
            for one, numbers in zip(bend.case.sheets, [of_stack(n, s) for n, s in enumerate(bend.stack)], strict=False)
        ],
        "table": [values(quantities_of(row)) for row in bend.table],
    }
    if budget:
        finished = {name: _told(change) for name, change in budget.changes.items() if name not in budget.failures}
        content["budget"] = {"changes": finished, "failures": budget.failures}
    return content


def _told(numbers: Mapping[str, float]) -> dict[str, float | None]:
    """Numbers by name, None for NaN."""
    return {name: None if math.isnan(number) else number for name, number in numbers.items()}


def _of_sheet(sheet: StackedSheet) -> dict[str, Any]:
    return {
        "thickness": sheet.thickness,
        "material": full_text(sheet.material),
        "friction": sheet.friction,
        "bonded": sheet.bonded,
    }


def parameters(case: AirBending) -> dict[str, Any]:
    """Parameters as JSON data; the material as text."""
    words = {"element": element(case.element).name, "material": full_text(case.material)}
    drawn = {"punch_section": case.punch_section, "die_section": case.die_section}
    on_top = [_of_sheet(sheet) for sheet in case.on_top]
    return (
        case.record()
        | {"on_top": on_top}
        | words
        | {name: None if tool is None else tool.words for name, tool in drawn.items()}
    )

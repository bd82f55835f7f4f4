"""Jobs that compute a bend table, by the calls of `umform bend table`; bends of the store are there at once."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from umform.bench.folders import RESULTS
from umform.bench.live import write_live
from umform.bench.wanted import Wanted
from umform.io.staging import staging
from umform.io.store import Store
from umform.studies.bend_table import (
    FORMATS,
    BendTable,
    Setup,
    StoredBend,
    Tabled,
    bend_table,
    stored_bends,
    write_table,
)
from umform.studies.bend_table.formats import file_names
from umform.studies.bend_table.stored import TOLERANCE

#: Progress before the files are written.
_BEFORE_FILES = 0.97


def run_table(folder: Path, wanted: Wanted) -> dict[str, Any]:
    """Compute a bend table and write it in all formats.

    Parameters
    ----------
    folder : Path
        Folder of the job.
    wanted : Wanted
        The form.

    Returns
    -------
    dict
        The summary of the page.
    """
    table = computed_table(folder, wanted.setups(), wanted.values["angles"], check=wanted.values["check"])
    return written(folder, table) | {"table": rows_of(table)}


def computed_table(
    folder: Path,
    setups: Sequence[Setup],
    angles: Sequence[float],
    *,
    check: bool,
    notes: Sequence[str] = (),
    begin: float = 0.0,
) -> BendTable:
    """Compute a table, one setup after the other; the live data of the job have the bends that are there.

    Parameters
    ----------
    folder : Path
        Folder of the job.
    setups : sequence of Setup
        Sheets and tools.
    angles : sequence of float
        Angles between the legs in degrees.
    check : bool
        Measure the errors between the angles.
    notes : sequence of str
        Lines for the heads of the files.
    begin : float
        Progress of the job before it.
    """
    store = Store()
    parts: list[Tabled] = []
    known = {setup.name: stored_bends(setup.case, angles, store=store) for setup in setups}
    count = len(setups) * len(angles)

    def show() -> None:
        done = sum(len(found) for found in known.values())
        rows = [row_of(setup, one) for setup in setups for one in sorted(known[setup.name], key=lambda one: one.wanted)]
        fraction = begin + (_BEFORE_FILES - begin) * done / count
        live = {"phase": "table", "fraction": fraction, "done": done, "count": count, "table": rows, "shape": 0}
        write_live(folder, live)

    show()
    for setup in setups:

        def tick(name: str, fraction: float, detail: str = "", /, setup: Setup = setup) -> None:
            there = [one.wanted for one in known[setup.name]]
            next_one = [angle for angle in sorted(angles, reverse=True) if angle not in there][:1]  # from flat to sharp
            known[setup.name] += stored_bends(setup.case, next_one, store=store)
            show()

        parts += bend_table([setup], angles, check=check, store=store, processes=1, progress=tick).parts
        known[setup.name] = list(parts[-1].bends)
        show()
    return BendTable(tuple(parts), TOLERANCE, tuple(notes))


def written(folder: Path, table: BendTable) -> dict[str, Any]:
    """Write a table in all formats; what the page says of it."""
    files = file_names([part.setup for part in table.parts], FORMATS)
    with staging(folder / RESULTS, files):
        write_table(table, folder / RESULTS, FORMATS)
    return {
        "computed": table.computed,
        "remarks": list(dict.fromkeys(remark for part in table.parts for remark in part.remarks)),
        "failed": [f"{which}: {why}" for which, why in table.failed.items()],
        "linear_error": max((part.linear_error for part in table.parts if part.linear_error is not None), default=None),
    }


def rows_of(table: BendTable) -> list[dict[str, Any]]:
    """All bends of a table for the page."""
    return [row_of(part.setup, one) for part in table.parts for one in part.bends]


def row_of(setup: Setup, one: StoredBend) -> dict[str, Any]:
    """A bend for the page."""
    case, measures = setup.case, one.measures
    return {
        "name": setup.name,
        "metal": setup.metal,
        "thickness": case.thickness,
        "opening": case.opening,
        "punch_radius": case.punch_radius,
        "die_radius": case.die_radius,
        "angle": one.wanted,
        "radius": one.radius,
        "k_factor": one.k_factor,
        "bend_allowance": one.allowance,
        "bend_deduction": one.deduction,
        "stroke": measures.stroke,
        "largest_force": measures.largest_force,
        "springback": measures.springback,
        "computed": one.computed,
    }

"""Table and plot of a sweep as files."""

from __future__ import annotations

import csv
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

from umform.errors import FileProblem
from umform.io.folders import numbered
from umform.io.parquet import can_write_parquet, write_parquet
from umform.io.staging import Staging
from umform.io.tables import write_csv
from umform.studies.sweep.measures import unit_of

#: The table, as Parquet too where pyarrow is installed, and the plot.
TABLE, PARQUET, PLOT = "sweep.csv", "sweep.parquet", "sweep.png"
FILES = (TABLE, PARQUET, PLOT)
#: Folder of the jobs beside them.
JOBS = "jobs"
#: Largest number of measures to draw, and to print.
_FEW = 4

Row = Mapping[str, Any]


def columns(
    rows: Sequence[Row], varied: Sequence[str], measures: Sequence[str], *, units: bool = False
) -> dict[str, list[Any]]:
    """Columns of a sweep by name: varied values, outcome, measures, and remarks; ``units`` puts them behind names."""
    titled = {name: f"{name} {unit_of(rows, name)}".strip() if units else name for name in measures}
    names = [*varied, "outcome", *measures, "warnings", "seconds", "reason", "folder"]
    return {titled.get(name, name): [row[name] for row in rows] for name in names}


def telling(rows: Sequence[Row], measures: Sequence[str]) -> list[str]:
    """The measures to show first: those that differ between jobs, then the others."""
    differ = {name: len({row[name] for row in rows if row["outcome"] == "done"}) > 1 for name in measures}
    return sorted(measures, key=lambda name: not differ[name])[:_FEW]


def folder_of(out: str | Path | None, default: Path, jobs: Collection[str], *, overwrite: bool) -> Path:
    """The folder of a study: the given one, or the first one by default that has not the table of another one.

    Raises
    ------
    FileProblem
        The given folder has the table of another study, which may not be overwritten.
    """
    if out is None:
        return next(one for one in numbered(default) if overwrite or not _others(one, jobs))
    folder = Path(out)
    if not overwrite and (others := _others(folder, jobs)):
        raise FileProblem(
            "the folder holds another sweep",
            where=str(folder),
            value=f"{TABLE} with {others} finished jobs, none of them of this sweep",
            cause="another deck, another version of umform, or other keys, values or changes",
            remedy="choose another folder, or --overwrite",
        )
    return folder


def _others(folder: Path, jobs: Collection[str]) -> int:
    """Number of finished jobs of a table that has none of these."""
    try:
        with (folder / TABLE).open(encoding="utf-8", newline="") as file:
            done = {row.get("folder") for row in csv.DictReader(file) if row.get("outcome") == "done"}
    except (OSError, ValueError, csv.Error):  # there is none, or it is damaged
        return 0
    return len(done) if done.isdisjoint(jobs) else 0


def write(stage: Staging, rows: Sequence[Row], varied: Sequence[str], measures: Sequence[str]) -> list[Path]:
    """Write the table, and draw the plot if there is data.

    Returns
    -------
    list of Path
        The written files.
    """
    table = columns(rows, varied, measures, units=True)
    write_csv(stage.waiting / TABLE, table)
    if can_write_parquet():
        write_parquet(stage.waiting / PARQUET, table)
    files = stage.commit([TABLE, PARQUET])
    if any(row["outcome"] == "done" for row in rows):
        from umform.studies.sweep.plot import plot  # matplotlib loads slowly

        plot(rows, varied, telling(rows, measures), stage.waiting / PLOT)
    return [*files, *stage.commit([PLOT])]

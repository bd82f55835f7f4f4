"""Table and plot of a sweep as files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from umform.io.parquet import can_write_parquet, write_parquet
from umform.io.staging import Staging
from umform.io.tables import write_csv

#: The table, as Parquet too where pyarrow is installed, and the plot.
TABLE, PARQUET, PLOT = "sweep.csv", "sweep.parquet", "sweep.png"
FILES = (TABLE, PARQUET, PLOT)
#: Folder of the jobs beside them.
JOBS = "jobs"
#: Largest number of measures to draw, and to print.
_FEW = 4

Row = Mapping[str, Any]


def columns(rows: Sequence[Row], varied: Sequence[str], measures: Sequence[str]) -> dict[str, list[Any]]:
    """Columns of a sweep by name: varied values, outcome, measures, and remarks."""
    names = [*varied, "outcome", *measures, "warnings", "seconds", "reason", "folder"]
    return {name: [row[name] for row in rows] for name in names}


def telling(rows: Sequence[Row], measures: Sequence[str]) -> list[str]:
    """The measures to show first: those that differ between jobs, then the others."""
    differ = {name: len({row[name] for row in rows if row["outcome"] == "done"}) > 1 for name in measures}
    return sorted(measures, key=lambda name: not differ[name])[:_FEW]


def write(stage: Staging, rows: Sequence[Row], varied: Sequence[str], measures: Sequence[str]) -> list[Path]:
    """Write the table, and draw the plot if there is data.

    Returns
    -------
    list of Path
        The written files.
    """
    table = columns(rows, varied, measures)
    write_csv(stage.waiting / TABLE, table)
    if can_write_parquet():
        write_parquet(stage.waiting / PARQUET, table)
    files = stage.commit([TABLE, PARQUET])
    if any(row["outcome"] == "done" for row in rows):
        from umform.studies.sweep.plot import plot  # matplotlib loads slowly

        plot(rows, varied, telling(rows, measures), stage.waiting / PLOT)
    return [*files, *stage.commit([PLOT])]

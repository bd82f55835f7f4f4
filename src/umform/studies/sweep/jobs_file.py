"""Jobs of a sweep from a CSV file."""

from __future__ import annotations

import csv
from os import PathLike
from pathlib import Path

from umform.errors import FileProblem
from umform.studies.sweep.values import Written

_REMEDY = "a CSV file with commas: keys in the first line, the values of a job in each other line"


def read_jobs(path: str | PathLike[str]) -> list[dict[str, Written]]:
    """Jobs of a CSV file: the keys are the header, each other line is a job.

    Raises
    ------
    FileProblem
        If the file cannot be read, has no row, or a row of another length than the header.
    """
    where = str(path)
    try:
        with Path(path).open(newline="", encoding="utf-8-sig") as text:
            header, *rows = [row for row in csv.reader(text) if row] or [[]]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        cause = getattr(error, "strerror", None) or "another kind of file, or text that is not UTF-8"
        raise FileProblem("the jobs cannot be read", where=where, cause=cause, remedy=_REMEDY) from error
    if not rows or any(len(row) != len(header) for row in rows):
        cause = "a row with more or fewer cells than the header, or no row"
        raise FileProblem("this is no table of jobs", where=where, cause=cause, remedy=_REMEDY)
    keys = [key.strip() for key in header]
    if len(set(keys)) < len(keys):
        twice = ", ".join(sorted({key for key in keys if keys.count(key) > 1}))
        raise FileProblem(
            "a key is varied twice", where=where, value=twice, cause="equal cells of the header", remedy="give it once"
        )
    return [{key.strip(): Written(cell.strip()) for key, cell in zip(header, row, strict=True)} for row in rows]

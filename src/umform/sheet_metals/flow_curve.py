"""Measured flow curves: pairs of plastic strain and yield stress from a file."""

from __future__ import annotations

from os import PathLike
from pathlib import Path

from umform.errors import FileProblem
from umform.materials import Table


def read_flow_curve(path: str | PathLike[str]) -> Table:
    """Read a flow curve from a CSV file with two columns: plastic strain from 0, true stress in MPa.

    Parameters
    ----------
    path : str or PathLike
        The file. Its first row may hold the names of the columns; lines after # are comments.

    Raises
    ------
    FileProblem
        If there is no such file, or a row is no pair of numbers.
    InvalidValue
        If the pairs are no hardening curve.
    """
    try:
        lines = Path(path).read_text(encoding="utf-8-sig").splitlines()
    except (OSError, ValueError) as error:
        cause = getattr(error, "strerror", None) or "another kind of file, or text that is not UTF-8"
        raise FileProblem("the flow curve cannot be read", where=str(path), cause=cause, remedy=_REMEDY) from None
    rows = [(number, line.split("#")[0].strip()) for number, line in enumerate(lines, start=1)]
    rows = [(number, row) for number, row in rows if row]
    if rows and not any(character.isdigit() for character in rows[0][1]):
        del rows[0]
    if len(rows) < 2:
        cause = "one point only" if rows else "an empty file"
        raise FileProblem("a flow curve has two points or more", where=str(path), cause=cause, remedy=_REMEDY)
    pairs = [_pair(row, f"{path}, line {number}") for number, row in rows]
    return Table(tuple(strain for strain, _ in pairs), tuple(stress for _, stress in pairs))


_REMEDY = "a CSV file with two columns, plastic strain and true stress, as 0.05,275"


def _pair(row: str, where: str) -> tuple[float, float]:
    try:
        strain, stress = map(float, row.split(","))
    except ValueError:
        cause = "another separator than a comma, a decimal comma, or another number of columns"
        raise FileProblem("this is no pair of numbers", where=where, value=row, cause=cause, remedy=_REMEDY) from None
    return strain, stress

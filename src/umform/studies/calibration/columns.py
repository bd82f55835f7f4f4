"""Columns of a CSV file by their names, with the line of what does not fit."""

from __future__ import annotations

import math
from collections.abc import Mapping
from contextlib import suppress
from os import PathLike
from pathlib import Path

from umform.errors import FileProblem

#: Line of the file, and the cells of the row by the names of the columns.
Row = tuple[int, dict[str, str]]


def read_rows(
    path: str | PathLike[str], wanted: tuple[str, ...], example: str, names: Mapping[str, str] | None = None
) -> list[Row]:
    """Rows of a CSV file whose first row has the names of the columns; what follows # is a comment.

    Parameters
    ----------
    path : str or PathLike
        The file.
    wanted : tuple of str
        Columns that must be there.
    example : str
        How such a file begins, for messages.
    names : mapping of str to str, optional
        Names of columns in the file where they differ: ``{"stress": "sigma"}``.

    Raises
    ------
    FileProblem
        If the file cannot be read, a column is missing, or a row has another number of cells.
    """
    remedy = f"a CSV file that begins as {example}"
    table = _table(path, remedy)
    own = {_key(there): name for name, there in (names or {}).items()}
    header = [own.get(_key(name), _key(name)) for name in table[0][1]]
    missing = [(names or {}).get(name, name) for name in wanted if name not in header]
    if missing:
        raise FileProblem(
            f"the column {missing[0]} is missing",
            where=f"{path}, line {table[0][0]}",
            value=", ".join(header),
            cause="no row with the names of the columns, another name, or another separator than a comma",
            remedy=remedy,
        )
    rows = []
    for number, row in table[1:]:
        if len(row) != len(header):
            raise FileProblem(
                f"this row has {len(row)} cells, the header {len(header)}",
                where=f"{path}, line {number}",
                value=",".join(row),
                cause="a decimal comma, or a cell that was left out",
                remedy="a point in decimals, and a comma for each cell, also for an empty one",
            )
        rows.append((number, dict(zip(header, row, strict=True))))
    return rows


def _table(path: str | PathLike[str], remedy: str) -> list[tuple[int, list[str]]]:
    """Lines of a file that are no comments with their numbers, as cells.

    Raises
    ------
    FileProblem
        If it cannot be read, or there are none.
    """
    try:
        lines = Path(path).read_text(encoding="utf-8-sig").splitlines()
    except (OSError, ValueError) as error:
        cause = getattr(error, "strerror", None) or "another kind of file, or text that is not UTF-8"
        raise FileProblem("this table cannot be read", where=str(path), cause=cause.lower(), remedy=remedy) from None
    cells = [(number, line.split("#")[0].strip()) for number, line in enumerate(lines, start=1)]
    table = [(number, [cell.strip() for cell in line.split(",")]) for number, line in cells if line]
    if not table:
        raise FileProblem("this table has no rows", where=str(path), cause="an empty file", remedy=remedy)
    return table


def has_column(path: str | PathLike[str], name: str) -> bool:
    """Whether a CSV file has a column of a name."""
    return _key(name) in map(_key, _table(path, "a CSV file with the names of its columns in the first row")[0][1])


def _key(name: str) -> str:
    return name.strip().casefold().replace(" ", "_")


def number(path: str | PathLike[str], row: Row, column: str, *, empty: bool = False) -> float | None:
    """The number in a column of a row; None for an empty cell, if it may be empty.

    Raises
    ------
    FileProblem
        If it is not a number.
    """
    line, cells = row
    text = cells.get(column, "")
    if empty and not text:
        return None
    with suppress(ValueError):
        if math.isfinite(value := float(text)):
            return value
    raise FileProblem(
        f"the {column} is not a number",
        where=f"{path}, line {line}",
        value=repr(text),
        cause="an empty cell, a unit behind the number, or a decimal comma",
        remedy="a number as 0.05 or 275",
    )

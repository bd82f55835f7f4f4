"""Read histories of runs from their CSV files."""

from __future__ import annotations

import csv
import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from umform.errors import FileProblem

Floats = NDArray[np.float64]
#: Columns by name.
History = dict[str, Floats]

#: Names of the history in the folder of a run, of the curve of a bend or a draw, and of those of several bends.
HISTORIES = ("history.csv", "curve.csv", "curves.csv")
_REMEDY = "give the history.csv of a run"


def read_history(path: str | os.PathLike[str]) -> History:
    """Read the history of a run.

    Parameters
    ----------
    path : str or os.PathLike
        A CSV file with one header row, or a folder with one of `HISTORIES`. Semicolons in the header stand for decimal
        commas in the numbers.

    Returns
    -------
    dict of str to ndarray
        The columns, as :meth:`umform.Result.table` has them.

    Raises
    ------
    FileProblem
        The file is missing, or is no table of numbers.
    """
    file = _file(Path(path))
    try:
        with file.open(newline="", encoding="utf-8-sig") as text:
            german = ";" in text.readline()
            text.seek(0)
            header, *rows = list(csv.reader(text, delimiter=";" if german else ",")) or [[]]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        cause = getattr(error, "strerror", None) or "another kind of file, or text that is not UTF-8"
        raise FileProblem("the history cannot be read", where=str(file), cause=cause, remedy=_REMEDY) from error
    if not rows:
        raise FileProblem("this history has no rows", where=str(file), remedy=_REMEDY)
    for number, row in enumerate(rows, start=2):
        if len(row) != len(header):
            cause = "a cut file, or another table"
            what = f"a row has {len(row)} cells and not {len(header)}"
            raise FileProblem(what, where=f"{file}, line {number}", cause=cause, remedy=_REMEDY)
    values = np.array(
        [
            [
                _number(cell.replace(",", ".") if german else cell, f"{file}, line {number}, column {name}")
                for name, cell in zip(header, row, strict=True)
            ]
            for number, row in enumerate(rows, start=2)
        ]
    )
    return dict(zip(header, values.T, strict=True))


def _number(cell: str, where: str) -> float:
    try:
        return float(cell)
    except ValueError:
        cause = "an empty cell, a decimal comma, or another table"
        what = "a history is a table of numbers"
        raise FileProblem(what, where=where, value=repr(cell), cause=cause, remedy=_REMEDY) from None


def read_histories(paths: Sequence[str | os.PathLike[str]]) -> dict[str, History]:
    """Read histories of several runs, with the shortest names that distinguish them.

    Parameters
    ----------
    paths : sequence of str or os.PathLike
        Files or folders.

    Returns
    -------
    dict of str to dict
        The history of each run.
    """
    names = [_name(Path(path)) for path in paths]
    clear = len(set(names)) == len(names)
    return {
        name if clear else str(path): read_history(path) for name, path in zip(names, map(Path, paths), strict=True)
    }


def _file(path: Path) -> Path:
    files = [path / name for name in HISTORIES] if path.is_dir() else [path]
    file = next((one for one in files if one.is_file()), path)
    if not file.is_file():
        raise FileProblem(
            "there is no history here",
            where=str(path),
            cause=f"the folder holds none of {', '.join(HISTORIES)}" if path.is_dir() else "there is no such file",
            remedy="give a CSV file that result.write() made, or the folder of a run, a bend or a draw",
        )
    return file


def _name(path: Path) -> str:
    """The folder of one of `HISTORIES`, the name of another file."""
    path = path.resolve()
    if path.is_dir():
        return path.name
    return path.parent.name if path.name in HISTORIES else path.stem

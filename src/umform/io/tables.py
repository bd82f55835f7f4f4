"""Tables as CSV and records as JSON, written atomically."""

from __future__ import annotations

import csv
import json
import math
import os
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from typing import Any

import numpy as np

from umform.errors import InvalidValue, NotFinite
from umform.io.atomic import PendingFile, write_text

Scalar = bool | int | float | str | None


@dataclass(frozen=True)
class CsvStyle:
    """How a CSV table is written.

    Attributes
    ----------
    separator, decimal : str
        Between the cells, and in front of the digits behind the point.
    encoding : str
        Name of the encoding.
    """

    separator: str
    decimal: str
    encoding: str


#: Styles by name; a spreadsheet with German settings opens the second one, whose mark tells that it is UTF-8.
CSV_STYLES = {"plain": CsvStyle(",", ".", "utf-8"), "german": CsvStyle(";", ",", "utf-8-sig")}
_style = ContextVar("csv style", default=CSV_STYLES["plain"])


@contextmanager
def csv_style(name: str) -> Iterator[None]:
    """Write all CSV tables inside in a style of `CSV_STYLES`.

    Raises
    ------
    InvalidValue
        There is no such style.
    """
    if name not in CSV_STYLES:
        raise InvalidValue("there is no such style of CSV tables", value=name, remedy="one of " + ", ".join(CSV_STYLES))
    token = _style.set(CSV_STYLES[name])
    try:
        yield
    finally:
        _style.reset(token)


def write_csv(path: str | os.PathLike[str], columns: Mapping[str, Iterable[Any]]) -> None:
    """Write named columns as a CSV table with one header row.

    Floats are written with enough digits to be read back exactly; NaN is written as ``nan`` and None as an empty field.
    `csv_style` chooses separator and decimal sign.

    Parameters
    ----------
    path : str or os.PathLike
        The file to write.
    columns : mapping of str to iterable
        The columns by name, in the order of the table, all of the same length; numbers, strings or None.

    Raises
    ------
    InvalidValue
        There is no column, the lengths differ, or an entry is not a scalar.
    FileProblem
        The file cannot be written.
    """
    table = {name: [_scalar(value, f"column {name!r}") for value in column] for name, column in columns.items()}
    lengths = {name: len(column) for name, column in table.items()}
    if len(set(lengths.values())) != 1:
        raise InvalidValue(
            "a table needs at least one column, and columns of one length",
            where=os.fspath(path),
            value=lengths,
            remedy="give every column the same number of entries",
        )
    style = _style.get()
    cells = (
        [repr(value).replace(".", style.decimal) if isinstance(value, float) else value for value in column]
        for column in table.values()
    )
    with PendingFile(path) as temporary, temporary.open("w", newline="", encoding=style.encoding) as file:
        writer = csv.writer(file, delimiter=style.separator, lineterminator="\n")
        writer.writerow(table)
        writer.writerows(zip(*cells))


def write_json(path: str | os.PathLike[str], record: Any) -> None:
    """Write a record as JSON, with sorted keys, so that equal records give equal files.

    Parameters
    ----------
    path : str or os.PathLike
        The file to write.
    record : object
        Mappings with string keys, lists, tuples, NumPy arrays and scalars, numbers, strings and None, nested
        at will.

    Raises
    ------
    NotFinite
        A number is NaN or infinite, which JSON cannot express.
    InvalidValue
        A value or key is of another kind.
    FileProblem
        The file cannot be written.
    """
    text = json.dumps(_plain(record, "$"), indent=2, sort_keys=True, allow_nan=False, ensure_ascii=False)
    write_text(path, text + "\n")


def _plain(value: Any, where: str) -> Any:
    """Convert a record to JSON types; `where` is the place in the record, such as ``$.a[3]``."""
    if isinstance(value, Mapping):
        for key in value:
            if not isinstance(key, str):
                raise InvalidValue(
                    "a key of a JSON object must be a string",
                    where=where,
                    value=repr(key),
                    cause="a number as a key",
                    remedy="its text",
                )
        return {key: _plain(item, f"{where}.{key}") for key, item in value.items()}
    if isinstance(value, list | tuple) or (isinstance(value, np.ndarray) and value.ndim > 0):
        return [_plain(item, f"{where}[{i}]") for i, item in enumerate(value)]
    scalar = _scalar(value, where)
    if isinstance(scalar, float) and not math.isfinite(scalar):
        raise NotFinite(
            "JSON has no NaN and no infinity",
            where=where,
            value=scalar,
            remedy="find out where the number comes from, or write None for a missing one",
        )
    return scalar


def _scalar(value: Any, where: str) -> Scalar:
    """Convert a NumPy scalar to the Python scalar of the same value; refuse anything but scalars."""
    if isinstance(value, np.generic) or (isinstance(value, np.ndarray) and value.ndim == 0):
        value = value.item()
    if value is None or isinstance(value, bool | int | float | str):
        return value
    raise InvalidValue(
        "only numbers, strings and None can be written here",
        where=where,
        value=f"{type(value).__name__} {value!r}",
        cause="an object of Python",
        remedy="its number, or its text",
    )

"""Tables of jobs as CSV for spreadsheets: significant digits, and the decimal sign of the language of the reader."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from umform.bench.form import form_fields
from umform.bench.index import Job
from umform.io.tables import CSV_STYLES, CsvStyle
from umform.results.quantity import UNKNOWN, Quantity

#: Style of CSV files by language; others are plain.
_STYLES = {"de": "german"}


def style_of(language: str) -> CsvStyle:
    """The style of CSV files for a language."""
    return CSV_STYLES[_STYLES.get(language, "plain")]


def table_of(jobs: Sequence[Job], language: str) -> bytes:
    """Jobs in rows: number, title, parameters, and the quantities with their decimals."""
    shown = [name for name in form_fields() if any(job.parameters.get(name) is not None for job in jobs)]
    rows = [_quantities(job.summary) for job in jobs]
    names = {name: one.key for row in rows for name, one in row.items()}
    header = ["job", "title", *("wanted_angle" if name == "angle" else name for name in shown), *names.values()]
    body = [
        [
            job.number,
            job.title,
            *(job.parameters.get(name) for name in shown),
            *(_number(row.get(name)) for name in names),
        ]
        for job, row in zip(jobs, rows, strict=True)
    ]
    return _written([header, *body], style_of(language))


def converted(path: Path, language: str) -> bytes:
    """A plain CSV file in the style of a language, with all of its digits."""
    with path.open(newline="", encoding="utf-8-sig") as text:
        return _written(list(csv.reader(text)), style_of(language))


def _quantities(summary: Mapping[str, Any]) -> dict[str, Quantity]:
    found = [Quantity.of(one) for kind in ("quantities", "checks") for one in summary.get(kind, ())]
    return {one.name: one for one in found}


def _number(one: Quantity | None) -> str:
    """The number as the page shows it; empty if it is not known."""
    text = "" if one is None else one.number(one.best)
    return "" if text == UNKNOWN else text


def _written(rows: Sequence[Sequence[Any]], style: CsvStyle) -> bytes:
    text = io.StringIO()
    csv.writer(text, delimiter=style.separator).writerows([[_cell(cell, style) for cell in row] for row in rows])
    return text.getvalue().encode(style.encoding)


def _cell(value: Any, style: CsvStyle) -> Any:
    """A cell: numbers with the decimal sign, and no text that a spreadsheet takes for a formula."""
    if value is None or isinstance(value, bool):
        return value
    try:
        float(value)
    except (TypeError, ValueError):
        return f"'{value}" if isinstance(value, str) and value[:1] in "=+-@\t\r" else value
    return str(value).replace(".", style.decimal)

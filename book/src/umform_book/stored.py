"""Results of a case, stored beside its page: the pages of all cases are written from these files."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path
from typing import Any

from umform.errors import FileProblem
from umform_book.checks import Verdict
from umform_book.outcome import CheckRecord, Outcome
from umform_book.page import Comparison, StudyRecord
from umform_book.writing import write_text

#: Folder of the results beside the pages.
RESULTS = "results"


def store(folder: Path, outcome: Outcome) -> None:
    """Write the results of a case below the folder of the pages, a line for each check and each row of a study."""
    head = {"verdict": outcome.verdict.name, "versions": outcome.versions}
    if outcome.failure:
        head["failure"] = outcome.failure
    parts = [f" {json.dumps(key)}: {_line(value)}" for key, value in head.items()]
    if outcome.balance:
        parts.append(f' "balance": {_line(dict(outcome.balance))}')
    parts.append(f' "checks": {_lines(_check_items(check) for check in outcome.checks)}')
    if outcome.comparisons:
        parts.append(f' "comparisons": {_lines(asdict(one) for one in outcome.comparisons)}')
    if outcome.studies:
        rows = (
            {"title": study.title, "element": label, "values": {n: _printed(value) for n, value in row.items()}}
            for study in outcome.studies
            for label, row in study.values.items()
        )
        parts.append(f' "studies": {_lines(rows)}')
    write_text(_path(folder, outcome.name), "{\n" + ",\n".join(parts) + "\n}\n")


def stored(folder: Path, names: Iterable[str]) -> dict[str, Outcome]:
    """Results below the folder of the pages, of those of the given cases that have some.

    Raises
    ------
    FileProblem
        If a file cannot be read or is not one of results.
    """
    paths = {name: _path(folder, name) for name in names}
    return {name: _read(path) for name, path in paths.items() if path.exists()}


def _read(path: Path) -> Outcome:
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
        tables: dict[str, dict[str, dict[int, float]]] = {}
        for row in data.get("studies", ()):
            values = {int(n): math.nan if value is None else value for n, value in row["values"].items()}
            tables.setdefault(row["title"], {})[row["element"]] = values
        return Outcome(
            path.stem,
            Verdict[data["verdict"]],
            tuple(_check(items) for items in data["checks"]),
            data.get("balance"),
            tuple(StudyRecord(path.stem, title, values) for title, values in tables.items()),
            tuple(Comparison(**items) for items in data.get("comparisons", ())),
            data.get("failure", ""),
            data["versions"],
        )
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise FileProblem(
            "the results of a case cannot be read",
            where=str(path),
            value=f"{type(error).__name__}: {error}",
            remedy=f"write them again: umform verify {path.stem} --out {path.parents[1]}",
        ) from error


def _check_items(check: CheckRecord) -> dict[str, Any]:
    items = asdict(check) | {"verdict": check.verdict.name}
    items["share"] = check.share if math.isfinite(check.share) else None
    if not check.note:
        del items["note"]
    return items


def _check(items: dict[str, Any]) -> CheckRecord:
    share = math.inf if items["share"] is None else float(items["share"])
    return CheckRecord(**items | {"verdict": Verdict[items["verdict"]], "share": share})


def _printed(value: float) -> float | None:
    """A number as tables show it; JSON has no NaN and no infinity."""
    return float(f"{value:.4g}") if math.isfinite(value) else None


def _path(folder: Path, name: str) -> Path:
    return folder / RESULTS / f"{name}.json"


def _line(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False)


def _lines(items: Iterable[Any]) -> str:
    return "[\n" + ",\n".join(f"  {_line(item)}" for item in items) + "\n ]"

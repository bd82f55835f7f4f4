"""What was measured: kept in a JSON file by case, so that a single case can be repeated; and its tables in Markdown."""

from __future__ import annotations

import json
import os
import platform
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from entries import Entry, Outcome
from measure import Cost
from ratios import HEADER, Found, markdown

#: Between these lines of a page stand the ratios.
MARK = "<!-- peers -->", "<!-- /peers -->"


def machine() -> str:
    """Processor, cores, system, Python."""
    info = Path("/proc/cpuinfo")
    lines = info.read_text().splitlines() if info.exists() else []
    names = [line.split(":")[1].strip() for line in lines if line.startswith("model name")] or [platform.machine()]
    return f"{names[0]}, {os.cpu_count()} cores, {platform.system()}, Python {platform.python_version()}"


def runs(found: Found) -> dict[str, dict[str, Any]]:
    """Numbers of the runs of a case, ready for JSON."""
    made = {}
    for key, (_, o) in found.items():
        cost = {name: round(value, 3) for name, value in vars(o.cost).items()}
        curve = {"u": [round(u, 6) for u in o.u.tolist()], "force": [round(f, 6) for f in o.force.tolist()]}
        plain = {k: v for k, v in vars(o).items() if k not in ("cost", *curve)}
        made[key] = plain | cost | (curve if len(o.u) else {})
    return made


def restored(case: Mapping[str, Any], entries: Iterable[Entry]) -> Found:
    """The runs of a case as they came out, by the entries that made them."""
    found = {}
    for entry in entries:
        if entry.key in case["runs"]:
            plain = dict(case["runs"][entry.key])
            cost = Cost(**{name: plain.pop(name) for name in ("cpu", "wall", "memory")})
            curve = {name: np.array(plain.pop(name, [])) for name in ("u", "force")}
            found[entry.key] = entry, Outcome(cost=cost, **plain, **curve)
    return found


def text(record: Mapping[str, Any]) -> str:
    """All tables."""
    command = "Made by `python benchmarks/peers/run.py --out benchmarks/peers/results.md`."
    lines = ["# Beside other codes", "", command, "", *summary(record), ""]
    for case in record.values():
        lines += [f"## {case['title']}", "", f"{case['machine']}; one thread. {case['codes']}.", ""]
        lines += [markdown(case["table"]), ""]
    return "\n".join(lines)


def summary(record: Mapping[str, Any]) -> list[str]:
    """The ratios of all cases in one table, and what they were measured with."""
    rows = [HEADER, *(row for case in record.values() for row in case["ratios"])]
    with_what = list(dict.fromkeys(f"{case['machine']}; {case['codes']}" for case in record.values()))
    return [markdown(rows), "", *(f"Measured on one thread: {line}." for line in with_what)]


def load(path: Path) -> dict[str, Any]:
    """The record beside a file of tables; empty if there is none."""
    beside = path.with_suffix(".json")
    kept: dict[str, Any] = json.loads(beside.read_text(encoding="utf-8")) if beside.exists() else {}
    return kept


def write(path: Path, record: Mapping[str, Any]) -> None:
    """Tables in Markdown, and all numbers in JSON beside them."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text(record), encoding="utf-8")
    spread = json.dumps(record, indent=1)
    in_rows = re.sub(r"\[[^][{}]*\]", lambda found: re.sub(r"\s+", " ", found[0]), spread)  # lists on one line
    path.with_suffix(".json").write_text(in_rows + "\n", encoding="utf-8")


def write_page(path: Path, record: Mapping[str, Any]) -> None:
    """Put the ratios between the marks of a page."""
    page = path.read_text(encoding="utf-8")
    begin, end = page.index(MARK[0]) + len(MARK[0]), page.index(MARK[1])
    inside = "\n".join(["", *summary(record), ""])
    path.write_text(page[:begin] + inside + page[end:], encoding="utf-8")

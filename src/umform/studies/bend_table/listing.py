"""What is in a store, as a table and as files."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

from umform.io.atomic import PendingFile
from umform.io.store import Entry, Store
from umform.studies.bend_table.stored import KIND

#: Columns on a terminal: what a bend was computed from, and its numbers.
_ABOUT = ("thickness", "opening", "punch_radius", "die_radius", "angle")
_NUMBERS = ("radius", "k_factor", "bend_allowance", "bend_deduction")


def listed(store: Store) -> list[list[str]]:
    """A header and a row for each bend."""
    rows = [["key", *(name.replace("_", " ") for name in (*_ABOUT, *_NUMBERS)), "law", ""]]
    for entry in _sorted(store):
        sizes = [f"{entry.about[name]:g}" for name in _ABOUT]
        numbers = [f"{entry.value[name]:.3f}" for name in _NUMBERS]
        rows.append([entry.key[:8], *sizes, *numbers, _law(entry), "" if entry.current else "old"])
    return rows


def _law(entry: Entry) -> str:
    curve = dict(entry.about["material"].get("hardening") or {})
    name = curve.pop("curve", entry.about["material"].get("law", ""))
    first = next((value for value in curve.values() if isinstance(value, float)), None)
    return name if first is None else f"{name} {first:.4g}"


def _sorted(store: Store) -> list[Entry]:
    def place(entry: Entry) -> tuple[Any, ...]:
        return (_law(entry), *(entry.about[name] for name in _ABOUT))

    return sorted(store.entries(KIND), key=place)


def export(store: Store, file: Path) -> int:
    """Write all bends to a file, CSV or JSON by its name.

    Returns
    -------
    int
        Number of bends.
    """
    entries = _sorted(store)
    rows: list[dict[str, Any]] = [
        {"key": one.key, "version": one.version, **one.about, **{f"found_{name}": n for name, n in one.value.items()}}
        for one in entries
    ]
    with PendingFile(file) as temporary, temporary.open("w", encoding="utf-8", newline="") as out:
        if file.suffix == ".json":
            json.dump(rows, out, indent=1)
        else:
            names = list(dict.fromkeys(name for row in rows for name in row))
            table = csv.DictWriter(out, names, lineterminator="\n")
            table.writeheader()
            table.writerows(
                {name: json.dumps(n) if isinstance(n, dict | list) else n for name, n in row.items()} for row in rows
            )
    return len(rows)

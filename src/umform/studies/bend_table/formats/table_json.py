"""All numbers of a bend table as JSON, for programs; docs/bend-tables.md has the keys."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import umform
from umform.io.atomic import PendingFile
from umform.studies.bend_table.formats.reading import Reading
from umform.studies.bend_table.head import DEFINITIONS
from umform.studies.bend_table.stored import StoredBend
from umform.studies.bend_table.table import BendTable, Tabled


def write(table: BendTable, folder: Path) -> list[Path]:
    """Write bends.json."""
    path = folder / "bends.json"
    data = {
        "umform": umform.__version__,
        "notes": list(table.notes),
        "definitions": list(DEFINITIONS),
        "tolerance": table.tolerance,
        "setups": [_setup(part) for part in table.parts],
    }
    with PendingFile(path) as temporary:
        temporary.write_text(json.dumps(data, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    return [path]


def _setup(part: Tabled) -> dict[str, Any]:
    case = part.setup.case
    sizes = ("thickness", "opening", "die_angle", "die_radius", "punch_angle", "punch_radius", "width")
    return {
        "name": part.setup.name,
        "metal": part.setup.metal,
        **{name: getattr(case, name) for name in sizes},
        "failed": {f"{angle:g}": why for angle, why in part.failed.items()},
        "linear_error": part.linear_error,
        "cubic_error": part.cubic_error,
        "bends": [_bend(one) for one in part.bends],
        "checks": [_bend(one) for one in part.checks],
    }


def _bend(one: StoredBend) -> dict[str, Any]:
    numbers = {"wanted_angle": one.wanted, "k_din": one.k_din, "tangent_deduction": one.tangent_deduction}
    return {**numbers, **asdict(one.measures), "notes": list(one.notes), "key": one.key}


def read(path: Path) -> dict[str, Reading]:
    """Tables by the names of their setups: deductions over the angle."""
    data = json.loads(path.read_text(encoding="utf-8"))
    return {
        setup["name"]: Reading(
            setup["thickness"], {one["wanted_angle"]: one["bend_deduction"] for one in setup["bends"]}
        )
        for setup in data["setups"]
    }

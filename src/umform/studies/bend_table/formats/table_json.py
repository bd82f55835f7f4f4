"""All numbers of a bend table as JSON, for programs; docs/bend-tables.md has the keys."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import umform
from umform.errors import FileProblem
from umform.io.atomic import write_text
from umform.studies.bend_table.formats.reading import Reading
from umform.studies.bend_table.head import DEFINITIONS
from umform.studies.bend_table.stored import StoredBend, plain
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
    return [write_text(path, json.dumps(data, indent=1, allow_nan=False) + "\n")]


def _setup(part: Tabled) -> dict[str, Any]:
    case = part.setup.case
    sizes = ("thickness", "opening", "die_angle", "die_radius", "punch_angle", "punch_radius", "width")
    return {
        "name": part.setup.name,
        "metal": part.setup.metal,
        **{name: getattr(case, name) for name in sizes},
        "parameters": plain(case),
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


@dataclass(frozen=True)
class Issued:
    """What a table was issued with.

    Attributes
    ----------
    setups : tuple of (str, dict)
        Metal, and parameters of the bend, of each setup.
    angles : tuple of float
        All angles.
    tolerance : float
        Tolerance of the angles in degrees.
    checked : bool
        Whether the intervals were checked.
    """

    setups: tuple[tuple[str, dict[str, Any]], ...]
    angles: tuple[float, ...]
    tolerance: float
    checked: bool


def issued(path: Path) -> Issued:
    """What bends.json was issued with, to issue it again.

    Raises
    ------
    FileProblem
        It is no such file.
    """
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
        setups = tuple((one["metal"], one["parameters"]) for one in data["setups"])
        angles = {one["wanted_angle"] for setup in data["setups"] for one in setup["bends"]}
        angles |= {float(angle) for setup in data["setups"] for angle in setup["failed"]}
        checked = any(setup["checks"] for setup in data["setups"])
        return Issued(setups, tuple(sorted(angles)), data["tolerance"], checked)
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise FileProblem(
            "this is no bend table that can be issued again",
            where=str(path),
            cause="it is missing or damaged, or not the bends.json of `umform bend table --format json`",
            remedy="the path of bends.json",
        ) from error

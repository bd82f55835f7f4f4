"""All numbers of a bend table as CSV."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path

from umform.io.atomic import PendingFile
from umform.studies.bend_table.formats.reading import Reading
from umform.studies.bend_table.head import head
from umform.studies.bend_table.stored import StoredBend
from umform.studies.bend_table.table import BendTable, Setup

#: Columns: name with unit, and value.
COLUMNS: dict[str, Callable[[Setup, StoredBend], object]] = {
    "metal": lambda setup, one: setup.metal,
    "thickness mm": lambda setup, one: setup.case.thickness,
    "opening mm": lambda setup, one: setup.case.opening,
    "die_angle degrees": lambda setup, one: setup.case.die_angle,
    "die_radius mm": lambda setup, one: setup.case.die_radius,
    "punch_angle degrees": lambda setup, one: setup.case.punch_angle,
    "punch_radius mm": lambda setup, one: setup.case.punch_radius,
    "angle degrees": lambda setup, one: one.wanted,
    "bend_angle degrees": lambda setup, one: one.bend_angle,
    "radius mm": lambda setup, one: one.radius,
    "k_ansi": lambda setup, one: one.k_factor,
    "k_din": lambda setup, one: one.k_din,
    "bend_allowance mm": lambda setup, one: one.allowance,
    "bend_deduction mm": lambda setup, one: one.deduction,
    "tangent_deduction mm": lambda setup, one: one.tangent_deduction,
    "setback mm": lambda setup, one: one.measures.setback,
    "stroke mm": lambda setup, one: one.measures.stroke,
    "force kN/m": lambda setup, one: one.measures.largest_force,
    "springback degrees": lambda setup, one: one.measures.springback,
    "found_angle degrees": lambda setup, one: one.measures.angle,
}
#: Metal; thickness, opening, radii of punch and die in mm.
Sizes = tuple[str, float, float, float, float]
_SIZES = ("thickness", "opening", "punch_radius", "die_radius")


def write(table: BendTable, folder: Path) -> list[Path]:
    """Write bends.csv."""
    path = folder / "bends.csv"
    with PendingFile(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        file.writelines(f"# {line}\n" for line in head(table, *table.parts))
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(COLUMNS)
        for part in table.parts:
            for one in part.bends:
                rows.writerow([value(part.setup, one) for value in COLUMNS.values()])
    return [path]


def read(path: Path) -> dict[Sizes, Reading]:
    """Tables by metal, thickness, opening, radii of punch and die: deductions over the angle."""
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    found: dict[Sizes, Reading] = {}
    for row in csv.DictReader(lines):
        thickness, opening, punch, die = (float(row[f"{name} mm"]) for name in _SIZES)
        part = found.setdefault((row["metal"], thickness, opening, punch, die), Reading(thickness, {}))
        part.deductions[float(row["angle degrees"])] = float(row["bend_deduction mm"])
    return found

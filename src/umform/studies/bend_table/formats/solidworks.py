"""Bend deductions for SolidWorks: a block of cells for each thickness, as text with tabs."""

from __future__ import annotations

from pathlib import Path

from umform.io.atomic import write_text
from umform.studies.bend_table.formats.reading import Reading
from umform.studies.bend_table.head import head
from umform.studies.bend_table.table import BendTable, Tabled

_NOTES = (
    "Angle: bend angle. Deductions from the virtual sharp; the columns of radii have the same ones: to sides up to the "
    "virtual sharp the radius does not matter.",
)


def write(table: BendTable, folder: Path, part: Tabled) -> Path:
    """Write the file of a setup: SolidWorks takes one table for each thickness."""
    radii = [one.radius for one in part.bends]
    ends = sorted({min(radii), max(radii)})
    rows = [
        ["Unit:", "Millimeters"],
        ["Type:", "Bend Deduction"],
        ["Material:", part.setup.metal],
        *(["Comment:", line] for line in (*head(table, part), *_NOTES)),
        ["Thickness:", f"{part.setup.case.thickness:g}"],
        ["Angle", "Radius"],
        ["", *(f"{radius:.9f}" for radius in ends)],
        *([f"{one.bend_angle:g}", *[f"{one.deduction:.9f}"] * len(ends)] for one in reversed(part.bends)),
    ]
    path = folder / f"{part.setup.name}.solidworks.txt"
    return write_text(path, "\n".join("\t".join(row) for row in rows) + "\n")


def read(path: Path) -> Reading:
    """The table of a file."""
    rows = [line.split("\t") for line in path.read_text(encoding="utf-8").splitlines()]
    named = {row[0]: row[1] for row in rows if row[0].endswith(":")}
    unit = {"Millimeters": 1.0, "Centimeters": 10.0, "Meters": 1000.0, "Inches": 25.4}[named["Unit:"]]
    first = next(number for number, row in enumerate(rows) if row[0] == "Angle") + 2
    return Reading(
        unit * float(named["Thickness:"]), {180.0 - float(row[0]): unit * float(row[1]) for row in rows[first:]}
    )

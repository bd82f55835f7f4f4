"""Bend tables of Creo: developed lengths of 90 degrees over radius and thickness; Creo multiplies by angle / 90."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from umform.io.atomic import write_text
from umform.studies.bend_table.formats.reading import within
from umform.studies.bend_table.head import head
from umform.studies.bend_table.table import BendTable, Tabled

_NOTES = (
    "Cells: developed length BA 90 / bend angle of the bend that has the radius R of its column: each radius is an "
    "angle. Give the bends of the part these radii.",
    "FORMULA holds only beyond the table, where nothing was computed: Y = pi / 2 K of the bend nearest to 90 degrees.",
)


def write(table: BendTable, folder: Path, part: Tabled) -> Path:
    """Write the file of a setup."""
    ordered = part.by_radius
    y = 0.5 * math.pi * min(ordered, key=lambda one: abs(one.wanted - 90.0)).k_factor
    angles = ", ".join(f"{one.radius:.4f}: {one.wanted:g}" for one in ordered)
    lines = [
        *(f"! {line}" for line in (*head(table, part), *_NOTES, f"R: angle of each column: {angles}")),
        "FORMULA",
        f"L = (PI / 2 * R + {y:.6f} * T)",
        "END FORMULA",
        "CONVERSION",
        "L = A",
        "END CONVERSION",
        "START MATERIALS",
        part.setup.metal.upper(),
        "END MATERIALS",
        "TABLE",
        "\t" + "\t".join(f"{one.radius:.9f}" for one in ordered),
        f"{part.setup.case.thickness:g}\t"
        + "\t".join(f"{one.allowance * 90.0 / (180.0 - one.measures.angle):.9f}" for one in ordered),
    ]
    path = folder / f"{part.setup.name}.bnd"
    return write_text(path, "\n".join(lines) + "\n")


@dataclass(frozen=True)
class Lengths:
    """Developed lengths of 90 degrees over the radius.

    Attributes
    ----------
    thickness : float
        Thickness of the sheet in mm.
    lengths : mapping of float to float
        Developed length by the radius, in mm.
    """

    thickness: float
    lengths: Mapping[float, float]

    def flat_length(self, angle: float, radius: float, sides: tuple[float, float]) -> float:
        """Flat length of a part, as of `Reading.flat_length`."""
        known = sorted(self.lengths)
        within(radius, known, "radius")
        of_90 = float(np.interp(radius, known, [self.lengths[one] for one in known]))
        setback = (radius + self.thickness) * math.tan(0.5 * math.radians(180.0 - angle))
        return sum(sides) - 2.0 * setback + of_90 * (180.0 - angle) / 90.0


def read(path: Path) -> Lengths:
    """The table of a file."""
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("!")]
    radii, row = (line.split() for line in lines[lines.index("TABLE") + 1 :])
    cells = zip((float(one) for one in radii), (float(one) for one in row[1:]), strict=True)
    return Lengths(float(row[0]), dict(cells))

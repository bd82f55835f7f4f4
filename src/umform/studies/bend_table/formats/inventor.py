"""Bend tables of Autodesk Inventor: text, a table for each thickness, corrections x in L = A + B - x."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from pathlib import Path

from umform.errors import FileProblem
from umform.io.atomic import write_text
from umform.studies.bend_table.formats.reading import Reading
from umform.studies.bend_table.head import head
from umform.studies.bend_table.table import BendTable, Tabled

_NOTES = (
    "Unfold rule of the kind bend table: L = A + B - x with x = BD, A and B to where the outer faces meet.",
    "A: bend angle; x would be 0 at A = 0. The columns R have the same x: to these A and B, R does not matter.",
)


def write(table: BendTable, folder: Path) -> list[Path]:
    """Write a file for each metal and pair of tools."""
    return [_write(table, folder, name, list(parts)) for name, parts in _by_tools(table)]


def _by_tools(table: BendTable) -> Iterator[tuple[str, Iterator[Tabled]]]:
    parts = sorted((part for part in table.parts if part.bends), key=lambda part: part.setup.tools)
    return itertools.groupby(parts, key=lambda part: part.setup.tools)


def _write(table: BendTable, folder: Path, name: str, parts: list[Tabled]) -> Path:
    lines = [*(f"; {line}" for line in (*head(table, *parts), *_NOTES)), "/U mm"]
    lines += ["/T1 0.000100", "/T2 0.010000", f"/T3 {max(0.01, table.tolerance):.6f}"]
    for number, part in enumerate(parts, start=1):
        radii = [one.radius for one in part.bends]
        ends = sorted({min(radii), max(radii)})
        lines += [f"*** TABLE {number}", f"/S {part.setup.case.thickness:.6f}"]
        lines.append("/R " + " ".join(f"{radius:.9f}" for radius in ends))
        for one in reversed(part.bends):
            lines.append(f"/A {one.bend_angle:.6f} " + " ".join([f"{one.deduction:.9f}"] * len(ends)))
    path = folder / f"{name}.inventor.txt"
    return write_text(path, "\n".join(lines) + "\n")


def read(path: Path) -> dict[float, Reading]:
    """Tables by thickness in mm.

    Raises
    ------
    FileProblem
        A line that is none of such a table.
    """
    unit, found, thickness = 10.0, {}, 0.0  # the default unit is the centimetre
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        words = line.split(";")[0].split()
        try:
            match words:
                case [] | ["***", *_] | ["/T1" | "/T2" | "/T3", _] | ["/R", *_]:
                    pass
                case ["/U", name]:
                    unit = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4}[name]
                case ["/S", value]:
                    thickness = unit * float(value)
                    found[thickness] = Reading(thickness, {})
                case ["/A", angle, first, *_]:
                    found[thickness].deductions[180.0 - float(angle)] = unit * float(first)
                case _:
                    raise ValueError
        except (ValueError, KeyError) as error:
            raise FileProblem(
                "this is no line of a bend table of Inventor",
                where=f"{path}, line {number}",
                value=line,
                remedy="/U mm, /S 1, /R 1 2, /A 90 1.8 1.8",
            ) from error
    return found

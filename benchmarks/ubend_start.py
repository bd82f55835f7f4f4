"""The first 10 mm of the U-bend of NUMISHEET 93: what its punch force depends on, beside CalculiX.

    python benchmarks/ubend_start.py --page docs/performance-codes.md
    python benchmarks/ubend_start.py --calculix 2000    # with so many CPU seconds for each run of CalculiX

Meshes are fine where the sheet is bent.
"""

from __future__ import annotations

import argparse
import shutil
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

import needs_book  # noqa: F401
import pages
import record
from ubend import LENGTH, MU, THICKNESS, build, deck, run_deck
from umform_book.calculix import totals

#: Strokes at which forces are compared, the stroke that is run, and the part of the sheet that is bent on the way.
MARKS, STROKE, BENT = (2.0, 5.0, 10.0), 10.5, (17.5, 45.0)
#: Layers and lengths of the elements; what else is changed with one layer of 0.5 mm.
MESHES = ((1, 1.0), (1, 0.5), (1, 0.25), (2, 1.0), (2, 0.5), (2, 0.25), (4, 0.5))
CHANGES: Mapping[str, Mapping[str, Any]] = {
    "5 times the penalties": {"stiffer": 5.0},
    "3 x 3 cells": {"rule": "cells"},
    "210 increments": {"increments": 210},
}
#: In CalculiX: layers, length, and the largest way of the punch in an increment, of which the first takes a fifth.
THEIRS = ((2, 0.5, 0.21), (2, 1.0, 0.05), (2, 0.5, 0.05), (2, 0.25, 0.05))


def mesh_of(layers: int, size: float) -> Any:
    """Half of the blank, its lower face at z = 0."""
    import umform as uf

    first, last = BENT
    bent = np.linspace(first, last, round((last - first) / size) + 1)
    lines = np.concatenate([np.linspace(0.0, first, 8)[:-1], bent, np.linspace(last, LENGTH, 53)[1:]])
    return uf.mesh.grid(lines, (0.0, 1.0), np.linspace(0.0, THICKNESS, layers + 1))


def ours(layers: int, size: float, friction: float | None, increments: int | None = None, **more: Any) -> list[float]:
    """Force of the punch at the marks, N per mm of width on half of the blank."""
    import umform as uf

    uf.set_threads(1)
    model, (hold, ram) = build(friction, STROKE, mesh=mesh_of(layers, size), **more)
    result = uf.solve(model, [hold, uf.Move(ram.control, ram.to, steps=increments)], frames=0, progress=False)
    drawn = result["step"] == 2
    return [float(np.interp(mark, -result["stroke"][drawn], result["punch_fz"][drawn])) for mark in MARKS]


def theirs(layers: int, size: float, way: float, friction: float | None, seconds: float) -> list[float]:
    """The same in CalculiX; NaN beyond its end."""
    with tempfile.TemporaryDirectory() as name:
        run_deck(Path(name), deck(mesh_of(layers, size), friction, STROKE, (way / 5.0, way)), seconds)
        time, force = totals((Path(name) / "job.dat").read_text())
    stroke = (time - 1.0) * STROKE
    return [float(np.interp(mark, stroke, -force[:, 2], right=np.nan)) for mark in MARKS]


def table(rows: Mapping[str, tuple[list[float], list[float]]]) -> str:
    """Rows as a table in Markdown."""
    marks = " | ".join([f"{mark:g} mm" for mark in MARKS] + [f"{mark:g} mm, no friction" for mark in MARKS])
    lines = [f"| | {marks} |", "|---" + "|---:" * 2 * len(MARKS) + "|"]
    for label, forces in rows.items():
        values = ["" if np.isnan(force) else f"{force:.2f}" for force in (*forces[0], *forces[1])]
        lines.append(f"| {label} | {' | '.join(values)} |")
    return "\n".join(lines)


def main() -> None:
    """Run, print, and write where asked."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    record.add_option(parser)
    parser.add_argument("--page", type=Path, help="page that gets the table between its marks")
    parser.add_argument(
        "--calculix", type=float, default=0.0, metavar="SECONDS", help="CPU seconds of each of its runs"
    )
    given = parser.parse_args()
    rows: dict[str, tuple[list[float], list[float]]] = {}

    def add(label: str, forces: tuple[list[float], list[float]]) -> None:
        rows[label] = forces
        print(label, *forces, flush=True)

    for layers, size in MESHES:
        add(f"BEND8, layers {layers}, {size:g} mm", (ours(layers, size, MU), ours(layers, size, None)))
    for label, change in CHANGES.items():
        add(f"layers 1, 0.5 mm, {label}", (ours(1, 0.5, MU, **change), ours(1, 0.5, None, **change)))
    if given.calculix > 0 and shutil.which("ccx"):
        for layers, size, way in THEIRS:
            found = [theirs(layers, size, way, friction, given.calculix) for friction in (MU, None)]
            add(f"CalculiX, C3D8I, layers {layers}, {size:g} mm, increments of {way:g} mm", (found[0], found[1]))
    print(table(rows))
    if given.page is not None:
        pages.put(given.page, "ubend-start", table(rows))
    record.write(given.json, "ubend-start", rows)


if __name__ == "__main__":
    main()

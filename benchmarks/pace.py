"""Increments at a pace beside equal ones: iterations, and how far the forces are from those of four times as many.

``python benchmarks/pace.py --page docs/performance-increments.md`` writes the table between the marks of the page.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

import pages
import umform as uf
from dome import build as dome
from umform.processes.air_bending import loading, problem
from umform.processes.air_bending.spec import AirBending
from umform.processes.bending import case as bending
from umform.processes.bending.spec import FreeBending

Floats = NDArray[np.float64]
#: Model and the control that moves, how far it goes, and how many equal increments are compared with.
Build = Callable[[], tuple[Any, Any, float, int]]


def strip(**keys: Any) -> Build:
    """The free bending of the demo."""

    def build() -> tuple[Any, Any, float, int]:
        case = FreeBending(**keys)
        return *bending.build(case), -case.stroke, case.steps

    return build


def air_bend() -> tuple[Any, Any, float, int]:
    """The air bending of the defaults, to a stroke of 6."""
    case = replace(AirBending(), stroke=6.0)
    model, punch = problem.build(case)
    return model, punch, case.stroke, loading.increments(case, case.stroke)


def pressed_sheet() -> tuple[Any, Any, float, int]:
    """A sphere that is pressed into a clamped sheet."""
    model, move = dome(32)
    return model, move.control, float(move.to), 40


CASES: dict[str, Build] = {
    "free bending, 24x1 ANS3DEAS": strip(),
    "free bending, 48x2 ANS3DEAS, 5 points": strip(mesh=(48, 2), contact=5),
    "free bending, 12x1 MI9K3DEAS": strip(mesh=(12, 1), element="MI9K3DEAS"),
    "air bending to a stroke of 6": air_bend,
    "sphere into a clamped sheet, 32x32": pressed_sheet,
}


def curve(build: Build, steps: Callable[[int], int | uf.Pace | None]) -> tuple[Floats, Floats, int, int]:
    """Way and force of the control, increments and iterations."""
    model, control, to, count = build()
    result = uf.solve(model, uf.Move(control, to, steps=steps(count)), frames=0, progress=False)
    way, force = np.abs(result[control.name]), result[f"{control.name}_force"]
    return way, force, len(result) - 1, int(result["iterations"].sum())


def row(name: str, build: Build) -> str:
    """One line of the table."""
    equal_way, equal_force, equal_count, equal_iterations = curve(build, lambda count: count)
    fine_way, fine_force, *_ = curve(build, lambda count: 4 * count)
    way, force, count, iterations = curve(build, lambda count: None)
    fine, scale = PchipInterpolator(fine_way, fine_force), np.abs(fine_force).max()
    away = [100 * np.abs(f - fine(w)).max() / scale for w, f in ((equal_way, equal_force), (way, force))]
    share = f"{iterations / equal_iterations:.2f}"
    return (
        f"| {name} | {equal_count} | {equal_iterations} | {away[0]:.2f} % "
        f"| {count} | {iterations} | {share} | {away[1]:.2f} % |"
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", choices=list(CASES), action="append", metavar="NAME", help="default: all")
    parser.add_argument("--page", type=Path, help="page that gets the table between its marks")
    arguments = parser.parse_args()
    uf.set_threads(1)
    lines = [
        "| | equal increments | iterations | force away | at a pace | iterations | ratio | force away |",
        "|---|---:|---:|---:|---:|---:|---:|---:|",
        *(row(name, CASES[name]) for name in arguments.only or CASES),
    ]
    text = "\n".join(lines) + "\n"
    print(text)
    if arguments.page:
        pages.put(arguments.page, "pace", text)


if __name__ == "__main__":
    main()

"""A sphere that is pressed into a clamped sheet, on ever finer meshes: what Newton's method takes and discards.

A quarter of the sheet, one layer of ANS3DEAS with five points through the thickness, J2 and contact. Each size runs in
a process of its own, so that its peak of memory is its own; 160 000 elements need some 6 GB.
"""

from __future__ import annotations

import argparse
import json
import math
import resource
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

import pages
import record

SIZES = (1_000, 2_500, 10_000, 40_000, 160_000)
#: Sizes that the exponents are fitted to, and what they should be at most.
LARGE, GOALS = 10_000, {"s per iteration": 1.3, "peak GB": 1.1}


def build(cells: int, thickness: float = 1.0, increments: int = 10) -> tuple[Any, Any]:
    """A quarter of a clamped sheet of metal, 50 x 50, and a sphere of radius 20 that goes 8 deep."""
    import umform as uf

    law = uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(yield_stress=160.0, modulus=500.0))
    mesh = uf.mesh.strip(length=50.0, width=50.0, thickness=thickness, cells=(cells, cells))
    model = uf.Model(mesh, "ANS3DEAS", material=law, thickness_order=1, thickness_points=5)
    model.symmetry("x0", normal="x")
    model.symmetry("y0", normal="y")
    model.fix("x1")
    model.fix("y1")
    sphere = uf.Sphere(centre=(0, 0, 20.0 + 0.5 * thickness), radius=20.0)
    contact = model.contact("upper", sphere, penalty=200.0, points=2)
    return model, uf.Move(model.drive(contact, "z", name="punch"), to=-8.0, steps=increments)


def one_iteration(timing: Any) -> float:
    """Wall seconds of one evaluation with its recovery and contact, one factorisation and one solution, on average."""
    parts = (timing.elements, timing.recovery, timing.contact, timing.factorisation, timing.solve)
    return float(sum(part.seconds / max(1, part.calls) for part in parts))


def measured(elements: int, increments: int, solver: str) -> dict[str, Any]:
    """One run in this process."""
    import umform as uf
    from umform.errors import NoConvergence

    uf.set_threads(1)
    model, step = build(round(math.sqrt(elements)), increments=increments)
    count = len(model.mesh.connectivity)
    cpu, wall = time.process_time(), time.perf_counter()
    try:
        result, failure = uf.solve(model, step, solver=solver, frames=0, progress=False), ""
    except NoConvergence as error:
        result, failure = error.result, str(error)  # type: ignore[attr-defined]
    cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
    iterations, timing = int(result["iterations"].sum()), result.timing
    attempts = timing.attempts
    return {
        "elements": count,
        "equations": model.system.pattern.n,
        "solver": result.solver,
        "CPU s": cpu,
        "wall s": wall,
        "peak GB": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e9,
        "increments": len(result) - 1,
        "iterations": iterations,
        "evaluations": attempts.evaluations,
        "factorisations": timing.factorisation.calls,
        "discarded": attempts.discarded,
        "share discarded": attempts.share,
        "share beyond accepted iterations": 1.0 - iterations / attempts.evaluations,
        "s per iteration": cpu / wall * one_iteration(timing),
        "us per element and accepted iteration": 1e6 * cpu / (count * max(1, iterations)),
        "factorisation s": timing.factorisation.seconds,
        "elements s": timing.elements.seconds,
        "force": float(result["punch_force"][-1]),
        "way": float(result["punch"][-1]),
        "drift": float(np.abs(result.balance().drift).max()),
        "failed attempts": dict(attempts.causes.most_common()),
        "failure": failure,
    }


def exponents(rows: list[dict[str, Any]]) -> dict[str, float]:
    """Slopes of the logarithms of the columns with a goal over that of the elements; none without two large sizes."""
    large = [row for row in rows if row["elements"] >= LARGE]
    if len(large) < 2:
        return {}
    n = np.log([row["elements"] for row in large])
    return {name: float(np.polyfit(n, np.log([row[name] for row in large]), 1)[0]) for name in GOALS}


#: Columns of the table, and how their numbers are written.
COLUMNS = {
    "elements": "d",
    "CPU s": ".1f",
    "wall s": ".1f",
    "s per iteration": ".3f",
    "peak GB": ".2f",
    "increments": "d",
    "iterations": "d",
    "evaluations": "d",
    "factorisations": "d",
    "share discarded": ".0%",
    "share beyond accepted iterations": ".0%",
    "us per element and accepted iteration": ".1f",
}


def table(rows: list[dict[str, Any]]) -> str:
    """All sizes in Markdown, and how time and memory grow."""
    lines = ["| " + " | ".join(COLUMNS) + " |", "|" + "---:|" * len(COLUMNS)]
    lines += ["| " + " | ".join(format(row[name], form) for name, form in COLUMNS.items()) + " |" for row in rows]
    for name, value in exponents(rows).items():
        verdict = "met" if value <= GOALS[name] else "missed"
        words = f"{name} grows with the elements to the power of {value:.2f}, from {LARGE} of them on"
        lines += ["", f"{words}; the goal is {GOALS[name]:g}: {verdict}."]
    return "\n".join(lines)


def failures(rows: list[dict[str, Any]]) -> str:
    """Why attempts failed, and sizes that did not arrive."""
    lines = [
        f"{row['elements']} elements, {row['solver']}: {count} attempts failed: {reason}"
        for row in rows
        for reason, count in row["failed attempts"].items()
    ]
    return "\n".join(lines + [f"{row['elements']} elements: {row['failure']}" for row in rows if row["failure"]])


def draw(rows: list[dict[str, Any]], path: Path) -> None:
    """Time of an iteration, memory and share discarded, against the elements."""
    from umform.plotting import Picture, house_style, save

    n = np.array([row["elements"] for row in rows], dtype=float)
    with house_style():
        figure = Picture(figsize=(7.2, 2.6), layout="tight")
        for axes, name in zip(figure.subplots(1, 3), [*GOALS, "share discarded"], strict=True):
            values = np.array([row[name] for row in rows])
            axes.plot(n, values, "o-")
            axes.set_xscale("log")
            if name in GOALS:
                axes.set_yscale("log")
                axes.plot(n, values[-1] * (n / n[-1]) ** GOALS[name], ":", label=f"power of {GOALS[name]:g}")
                axes.legend()
            else:
                axes.set_ylim(0.0, 1.0)
            axes.set_title({"s per iteration": "CPU s of an iteration", "peak GB": "Peak memory, GB"}.get(name, name))
            axes.set_xlabel("elements")
    save(figure, path, dpi=110)


def known(path: Path | None) -> dict[int, dict[str, Any]]:
    """Rows of earlier runs in a file, by their elements."""
    if path is None or not path.is_file():
        return {}
    benchmarks = json.loads(path.read_text()).get("benchmarks", {})
    rows = [one["numbers"] for name, one in benchmarks.items() if name.startswith("dome ")]
    return {row["elements"]: row for row in rows if "elements" in row}


def main() -> None:
    """Start a process for each size, print what they say, and how it grows."""
    parser = argparse.ArgumentParser(description=__doc__)
    what = "square sheets of about so many; none: the table and the picture of the file of --json"
    parser.add_argument("--elements", type=int, nargs="*", default=SIZES, help=what)
    parser.add_argument("--increments", type=int, default=10)
    parser.add_argument("--solver", default="auto")
    parser.add_argument(
        "--plot", type=Path, metavar="FILE", help="draw all sizes of the file of --json, or of this run"
    )
    parser.add_argument("--page", type=Path, help="page that gets the table between its marks")
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    record.add_option(parser)
    arguments = parser.parse_args()
    if arguments.inside:
        row = measured(arguments.elements[0], arguments.increments, arguments.solver)
        print(json.dumps(row))
        return
    rows = known(arguments.json)
    words = ["--increments", str(arguments.increments), "--solver", arguments.solver]
    for elements in arguments.elements:
        command = [sys.executable, __file__, "--inside", "--elements", str(elements), *words]
        output = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout
        row = json.loads(output.splitlines()[-1])
        rows[row["elements"]] = row
        record.write(arguments.json, f"dome {row['elements']}", row)
    ordered = [rows[elements] for elements in sorted(rows)]
    print(f"{table(ordered)}\n\n{failures(ordered)}")
    record.write(arguments.json, "dome exponents", exponents(ordered))
    if arguments.page is not None:
        pages.put(arguments.page, "dome", table(ordered))
    if arguments.plot is not None:
        draw(ordered, arguments.plot)


if __name__ == "__main__":
    main()

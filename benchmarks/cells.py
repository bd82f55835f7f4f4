"""Contact over cells beside contact at points: how smooth the force is, and what it costs.

A strip is bent over a cylinder on regular, graded and distorted meshes, a sheet in a V-die, a cylinder is pressed into
a block; with nodes, Gauss points and cells on the same mesh. All are measured against 20 x 20 cells a face. The page
gets the tables, and a picture.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import pages
import record
from cell_cases import PROBLEMS, Curve, Problem, Rule
from umform.errors import NoConvergence
from umform.plotting import house_style

PAGE, FIGURE = Path("docs/performance-cells.md"), Path("docs/images/cells.png")
FINEST = 20

#: Where the law is asked, by what it is called in the tables.
RULES: dict[str, Rule] = {
    "nodes": {"points": "nodes"},
    **{f"Gauss {n}": {"points": n} for n in (2, 5, 10)},
    **{f"cells {n}": {"cells": n} for n in (3, 5)},
    "cells auto": {"cells": "auto"},
}


def table(problem: Problem, runs: dict[str, Curve | None], finest: Curve) -> str:
    """Table of a problem."""
    lines = [
        f"### {problem.name}\n",
        "| rule | deviation % | ripple % | expected % | jump of slope %/mm | penetration | iterations | CPU s "
        "| drift |",
        "|---|---:|---:|---:|---:|---:|---:|---:|---:|",
    ]
    for name, run in {**runs, f"cells {FINEST}": finest}.items():
        if run is None:
            lines.append(f"| {name} | no convergence | | | | | | | |")
            continue
        apart = " | " if run is finest else f"{100 * run.deviation(finest):.2g} | {100 * run.ripple(finest):.2g}"
        expected = "" if run.expected is None else f"{100 * run.expected:.2g}"
        shown = f"cells auto: {run.cells}" if name == "cells auto" else name
        lines.append(
            f"| {shown} | {apart} | {expected} | {100 * run.jump():.3g} | {run.penetration:.2g} | {run.iterations} "
            f"| {run.seconds:.1f} | {run.drift:.1e} |"
        )
    return "\n".join(lines)


def draw(problem: Problem, runs: dict[str, Curve | None], finest: Curve) -> None:
    """Force over way, and its difference from that of the finest cells."""
    with house_style():
        figure = Figure(figsize=(7.5, 5.2), layout="constrained")
        above, below = figure.subplots(2, 1, sharex=True)
        for name in ("Gauss 2", "Gauss 5", "cells 3"):
            run = runs[name]
            if run is None:
                continue
            above.plot(run.way, run.force, label=name)
            below.plot(run.way, 100 * (run.force - np.interp(run.way, finest.way, finest.force)) / finest.force.max())
        above.plot(finest.way, finest.force, "k:", label=f"cells {FINEST}")
        above.set(ylabel="force N", title=problem.name, ylim=(0.75 * finest.force.max(), None))
        below.set(xlabel="way mm", ylabel="difference %", ylim=(-4, 4))
        above.legend()
        figure.savefig(FIGURE, dpi=120)


def bent(problem: Problem, rule: Rule, steps: int) -> Curve | None:
    """A run; None where it does not arrive."""
    try:
        return problem.bend(rule, steps)
    except NoConvergence as error:
        print(f"{problem.name}, {rule}: {error}")
        return None


def main() -> None:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--steps", type=int, default=300, help="increments of each run")
    parser.add_argument("--problem", type=int, action="append", choices=range(len(PROBLEMS)), help="default: all")
    parser.add_argument("--page", action="store_true", help=f"put tables into {PAGE} and the picture beside it")
    record.add_option(parser)
    arguments = parser.parse_args()
    numbers: dict[str, float] = {}
    tables: list[str] = []
    for problem in [PROBLEMS[number] for number in arguments.problem or range(len(PROBLEMS))]:
        finest = problem.bend({"cells": FINEST}, arguments.steps)
        runs = {name: bent(problem, rule, arguments.steps) for name, rule in RULES.items()}
        tables.append(table(problem, runs, finest))
        print(tables[-1], flush=True)
        arrived = {name: run for name, run in runs.items() if run is not None}
        numbers |= {f"{problem.name}, {name}, deviation": run.deviation(finest) for name, run in arrived.items()}
        if arguments.page and problem == PROBLEMS[1]:
            draw(problem, runs, finest)
    if arguments.page:
        pages.put(PAGE, "tables", "\n\n".join(tables))
    record.write(arguments.json, "cells", numbers)


if __name__ == "__main__":
    main()

"""CalculiX: a deck, the program ``ccx`` on one thread, and what it prints."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
from entries import Entry, Outcome
from measure import Crashed, measured

from problem import Floats, Problem
from umform_book.calculix import FIRST, Ring, contact_with_ring, element, metal, node_set, totals


class CalculiX:
    """The program ``ccx``.

    The element of an entry is its name in CalculiX. Options: ``solver``, default what this ``ccx`` takes of itself.
    """

    name = "CalculiX"
    remedy = "apt install calculix-ccx"

    def version(self) -> str | None:
        """Version of ``ccx``, or None if there is none."""
        if not shutil.which("ccx"):
            return None
        told = subprocess.run(["ccx", "-v"], capture_output=True, text=True, check=False).stdout
        return told.split()[-1]

    def solve(self, entry: Entry, problem: Problem, folder: Path) -> Outcome:
        """Run ``ccx`` in the folder; writing the deck is not counted."""
        solver = entry.options.get("solver", "SPOOLES")
        (folder / "job.inp").write_text("\n".join(_deck(problem, entry.element, solver)) + "\n", encoding="ascii")
        cost = measured(["ccx", "job"], folder, cwd=folder)
        printed = (folder / "job.dat").read_text(encoding="ascii")
        increments, iterations = _counts(folder, problem)
        u, force = np.zeros(0), np.zeros(0)
        if len(problem.pushed):
            time, forces = totals(printed)
            ends = _strokes(problem)
            u = np.interp(np.append(0.0, time), np.arange(len(ends) + 1.0), [0.0, *np.abs(ends)])
            force = np.append(0.0, forces[:, 2]) * np.sign(problem.stroke)
            if time[-1] < len(ends) - 1e-6:
                raise Crashed(f"{entry.key}: ended at {u[-1]:.3g} of a stroke of {abs(problem.stroke):.3g}")
        return Outcome(
            cost=cost,
            start_up=0.0,
            unknowns=problem.unknowns,
            increments=increments,
            iterations=iterations,
            solver=solver.lower(),
            probes={name: _mean(printed, name) for name in problem.probes},
            u=u,
            force=force,
        )


def _deck(problem: Problem, kind: str, solver: str) -> list[str]:
    """Lines of the deck."""
    made = ["*NODE,NSET=NALL"]
    made += [f"{n},{x:.12g},{y:.12g},{z:.12g}" for n, (x, y, z) in enumerate(problem.points.tolist(), 1)]
    made.append(f"*ELEMENT,TYPE={kind},ELSET=SHEET")
    for number, nodes in enumerate((problem.cells + 1).tolist(), 1):
        made += element(number, nodes)
    held: list[str] = []
    if problem.tool is not None:
        tool = problem.tool
        width = float(np.ptp(problem.points[:, 1]))
        ring = Ring(tool.radius, tool.x, tool.z, facets=tool.facets, width=width)
        lines, reference = ring.lines(len(problem.points), len(problem.cells))
        made += lines + contact_with_ring((problem.touching + 1).tolist(), tool.penalty)
        held = [f"{node},1,3" for node in reference]
    made += metal(problem.young, problem.poisson, problem.flow, "SHEET")
    for name, ids in [("PUSHED", problem.pushed), *problem.probes.items()]:
        made += node_set(name, (ids + 1).tolist()) if len(ids) else []
    made += ["*BOUNDARY", *held, *(f"{n + 1},{axis + 1},{axis + 1}" for n, axis in problem.fixed.tolist())]
    strokes = _strokes(problem)
    for stroke in strokes:
        made += _step(problem, solver, stroke, problem.levels if stroke == strokes[-1] else 1)
    return made


def _strokes(problem: Problem) -> list[float]:
    """Displacements at the ends of the steps: with a tool, a short one comes first."""
    short = [] if problem.tool is None else [float(np.copysign(FIRST, problem.stroke))]
    return [*short, problem.stroke]


def _step(problem: Problem, solver: str, stroke: float, levels: int) -> list[str]:
    """One step: increments as the levels, shorter ones where it cuts them."""
    if problem.large:
        made = ["*STEP,NLGEOM,INC=100000", f"*STATIC,SOLVER={solver}", f"{1 / levels},1.,1e-9,{1 / levels}"]
    else:
        made = ["*STEP", f"*STATIC,SOLVER={solver}"]
    if problem.forces is not None:
        made.append("*CLOAD")
        for n, axis in np.argwhere(problem.forces != 0).tolist():
            made.append(f"{n + 1},{axis + 1},{problem.forces[n, axis]:.12g}")
    if len(problem.pushed):
        made += ["*BOUNDARY", f"PUSHED,3,3,{stroke}", "*NODE PRINT,NSET=PUSHED,TOTALS=ONLY", "RF"]
    for name in problem.probes:
        made += [f"*NODE PRINT,NSET={name}", "U"]
    return [*made, "*END STEP"]


def _counts(folder: Path, problem: Problem) -> tuple[int, int]:
    """Accepted increments from ``.sta``, all iterations from ``.cvg``."""
    if not problem.large:
        return 1, 1
    rows = [line.split() for line in (folder / "job.sta").read_text().splitlines()[2:]]
    accepted = sum(not row[2].endswith("U") for row in rows)
    return accepted, len((folder / "job.cvg").read_text().splitlines()[4:])


def _mean(printed: str, name: str) -> list[float]:
    """Mean displacement of a set at the last time that it was printed."""
    last = re.findall(rf"displacements .* for set {name.upper()} .*\n\n((?:\s+\d+( +\S+)+\n)+)", printed)[-1][0]
    table: Floats = np.array([line.split()[1:] for line in last.splitlines()], dtype=float)
    mean: list[float] = table.mean(axis=0).tolist()
    return mean

"""Codes that are Python packages: each runs in a process of its own, so that time and memory are its own."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from problem import Problem

if TYPE_CHECKING:
    from entries import Entry, Outcome

HERE = Path(__file__).parent


class Scripted:
    """A code whose script reads ``problem.npz`` and ``options.json`` and writes ``outcome.json``.

    Parameters
    ----------
    name, ask, remedy : str
        Name, Python code that prints the version, and how one would install it.
    python : str
        The interpreter that has it.
    """

    def __init__(self, name: str, ask: str, remedy: str, python: str = sys.executable) -> None:
        self.name, self.ask, self.remedy, self.python = name, ask, remedy, python

    def version(self) -> str | None:
        """Version of the package, or None if there is no such interpreter or it has no such package."""
        if not shutil.which(self.python):
            return None
        told = subprocess.run([self.python, "-c", self.ask], capture_output=True, text=True, check=False)
        return told.stdout.strip() if told.returncode == 0 else None

    def solve(self, entry: Entry, problem: Problem, folder: Path) -> Outcome:
        """Run the script of the code."""
        from entries import Outcome
        from measure import measured

        problem.save(folder / "problem.npz")
        (folder / "options.json").write_text(json.dumps({"element": entry.element, **entry.options}))
        script = HERE / f"{self.name.lower()}_peer.py"
        cost = measured([self.python, str(script), str(folder)], folder)
        told = json.loads((folder / "outcome.json").read_text())
        curve = {name: np.array(told.pop(name, [])) for name in ("u", "force")}
        return Outcome(cost=cost, unknowns=problem.unknowns, **told, **curve)


def work(solve: Callable[[Problem, Mapping[str, Any]], dict[str, Any]]) -> None:
    """What the script of a code does: read, solve, write."""
    folder = Path(sys.argv[1])
    start_up = time.process_time()
    problem = Problem.load(folder / "problem.npz")
    options = json.loads((folder / "options.json").read_text())
    told = solve(problem, options)
    (folder / "outcome.json").write_text(json.dumps({"start_up": start_up, **told}))


def means(problem: Problem, u: Any) -> dict[str, list[float]]:
    """Mean displacements of the probes, from all displacements (n, 3)."""
    return {name: np.asarray(u)[ids].mean(axis=0).tolist() for name, ids in problem.probes.items()}

"""Codes that are Python packages: each runs in a process of its own, so that time and memory are its own."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
from entries import Entry, Outcome
from measure import measured

from problem import Problem

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
        """Run the script of the code; writing the problem is not counted."""
        problem.save(folder / "problem.npz")
        (folder / "options.json").write_text(json.dumps({"element": entry.element, **entry.options}))
        script = HERE / f"{self.name.lower()}_peer.py"
        cost = measured([self.python, str(script), str(folder)], folder)
        told = json.loads((folder / "outcome.json").read_text())
        curve = {name: np.array(told.pop(name, [])) for name in ("u", "force")}
        return Outcome(cost=cost, unknowns=problem.unknowns, **told, **curve)

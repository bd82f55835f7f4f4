"""What the script of a code does in a process of its own: read a problem, solve it, write what came out."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from problem import Problem


def work(solve: Callable[[Problem, Mapping[str, Any]], dict[str, Any]]) -> None:
    """Solve the problem in the folder that the command names."""
    folder = Path(sys.argv[1])
    start_up = time.process_time()
    problem = Problem.load(folder / "problem.npz")
    options = json.loads((folder / "options.json").read_text())
    told = solve(problem, options)
    (folder / "outcome.json").write_text(json.dumps({"start_up": start_up, **told}))


def means(problem: Problem, u: Any) -> dict[str, list[float]]:
    """Mean displacements of the probes, from all displacements (n, 3)."""
    return {name: np.asarray(u)[ids].mean(axis=0).tolist() for name, ids in problem.probes.items()}

"""An entry of the comparison, and what comes out of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from measure import Cost

from problem import Floats, Problem

#: Tolerances of Newton's method in umform that are nearer to those of the other codes than its own 1e-9 and 1e-6:
#: CalculiX ends at a residual of 0.5 % and a correction of 1 %.
LOOSE = {"newton": {"residual": 1e-4, "increment": 1e-2}}


@dataclass(frozen=True)
class Entry:
    """One run to be made.

    Attributes
    ----------
    peer : str
        The code.
    element : str
        Name of the element in that code.
    mesh : str
        The mesh in words.
    build : callable
        Makes the problem.
    options : mapping
        Further settings of the code: solver, points through the thickness.
    note : str
        What tells it from another entry with the same element and mesh.
    """

    peer: str
    element: str
    mesh: str
    build: Callable[[], Problem]
    options: Mapping[str, Any] = field(default_factory=dict)
    note: str = ""

    @property
    def key(self) -> str:
        """Name in tables."""
        words = f"{self.peer} {self.element}, {self.mesh}"
        return f"{words}, {self.note}" if self.note else words


@dataclass
class Outcome:
    """What came out of a run.

    Attributes
    ----------
    cost : Cost
        CPU seconds, wall seconds, memory; of the whole program.
    start_up : float
        CPU seconds until the problem was read: imports of Python. Not told by CalculiX.
    unknowns, increments, iterations : int
        Size of the problem; increments that were accepted; iterations, those of refused increments too where the code
        tells them.
    solver : str
        Linear solver.
    probes : dict
        Mean displacements at full load.
    u, force : ndarray
        Displacements of the pushed nodes and the forces on them, in the direction of the push.
    """

    cost: Cost
    start_up: float
    unknowns: int
    increments: int
    iterations: int
    solver: str
    probes: dict[str, list[float]]
    u: Floats = field(default_factory=lambda: np.zeros(0))
    force: Floats = field(default_factory=lambda: np.zeros(0))


class Peer(Protocol):
    """A code that solves problems."""

    name: str
    #: How one would install it.
    remedy: str

    def version(self) -> str | None:
        """Version, or None if it is not installed."""

    def solve(self, entry: Entry, problem: Problem, folder: Path) -> Outcome:
        """Solve the problem in an empty folder."""

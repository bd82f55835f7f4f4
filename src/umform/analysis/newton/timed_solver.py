"""A sparse solver whose time counts to the timing of a run."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.solvers import Factorisation, Pattern, SparseSolver
from umform.solvers.protocol import Accepting
from umform.timing import Timing

Floats = NDArray[np.float64]


class TimedSolver:
    """A sparse solver with timing.

    Parameters
    ----------
    solver : SparseSolver
        The solver, with an analysed pattern.
    timing : Timing
        Its parts `analysis`, `factorisation` and `solve` are counted.
    """

    def __init__(self, solver: SparseSolver, timing: Timing) -> None:
        self.solver, self.timing, self.name = solver, timing, solver.name

    def analyse(self, pattern: Pattern) -> None:
        """See :class:`umform.solvers.SparseSolver`."""
        with self.timing.analysis:
            self.solver.analyse(pattern)

    def factor(self, values: Floats) -> Factorisation:
        """See :class:`umform.solvers.SparseSolver`."""
        with self.timing.factorisation:
            return self.solver.factor(values)

    def accept(self) -> Factorisation | None:
        """See :class:`umform.solvers.protocol.Accepting`; None if the solver cannot."""
        return self.solver.accept() if isinstance(self.solver, Accepting) else None

    def solve(self, rhs: Floats) -> Floats:
        """See :class:`umform.solvers.SparseSolver`."""
        with self.timing.solve:
            return self.solver.solve(rhs)

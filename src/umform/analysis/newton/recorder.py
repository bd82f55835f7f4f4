"""Records of the iterations of one increment, and their callbacks."""

from __future__ import annotations

import logging
import time as clock
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from umform.analysis.newton.system import Evaluation
from umform.ranks import Ranks
from umform.results.records import Iteration

log = logging.getLogger("umform.newton")


class Recorder:
    """Records of the iterations of one increment.

    Parameters
    ----------
    callbacks : sequence of callable
        Called with each record.
    ranks : Ranks
        Ranks that share the model.
    start : float
        Start time of the increment.
    """

    def __init__(self, callbacks: Sequence[Callable[[Iteration], None]], ranks: Ranks, start: float) -> None:
        self.iterations: list[Iteration] = []
        self._callbacks, self._ranks, self._start = callbacks, ranks, start
        self._flowing: NDArray[np.uint8] | None = None  # of the previous iteration
        self._status: NDArray[np.uint8] | None = None

    def moved(self, evaluation: Evaluation) -> bool:
        """Whether contact points have opened or closed, begun or ceased to slip since the previous iteration."""
        before = evaluation.status if self._status is None else self._status
        return self._ranks.any(not np.array_equal(evaluation.status, before))

    def add(
        self,
        evaluation: Evaluation,
        residual: float,
        increment: float,
        energy: float,
        step_length: float,
        pivots: int | None,
    ) -> None:
        """Add a record of an evaluation; the other arguments are those of :class:`Iteration`."""
        status, flowing = evaluation.status, evaluation.flowing
        before = status if self._status is None else self._status
        entered, left = self._count((status > 0) & (before == 0)), self._count((status == 0) & (before > 0))
        switched = 0 if self._flowing is None else self._count(flowing != self._flowing)
        self._status, self._flowing = status, flowing
        number, seconds = len(self.iterations) + 1, clock.perf_counter() - self._start
        record = Iteration(number, residual, increment, energy, entered, left, step_length, pivots, seconds, switched)
        self.iterations.append(record)
        log.debug(
            "    iteration %2d  residual %.3e  increment %.3e  contact +%d -%d%s%s",
            number,
            residual,
            increment,
            entered,
            left,
            f"  flow switched {switched}" if switched else "",
            f"  negative pivots {pivots}" if pivots else "",
        )
        for callback in self._callbacks:
            callback(record)

    def _count(self, points: NDArray[np.bool_]) -> int:
        return int(self._ranks.sum(float(points.sum())))

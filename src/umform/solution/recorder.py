"""Records of the iterations of one increment, and their callbacks."""

from __future__ import annotations

import logging
import time as clock
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from umform.ranks import Ranks
from umform.solution.records import Iteration

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

    def add(
        self,
        flowing: NDArray[np.uint8],
        residual: float,
        increment: float,
        energy: float,
        entered: int,
        left: int,
        step_length: float,
        pivots: int | None,
    ) -> None:
        """Add a record; the arguments are those of :class:`Iteration`, and the plastic points."""
        before, self._flowing = self._flowing, flowing
        switched = 0 if before is None else int(self._ranks.sum(float((flowing != before).sum())))
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

"""A converged state that a step may go back to, and increments that are solved so far that a force is exact."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray

from umform.model import Evaluation, Model, Snapshot
from umform.model.term import Term
from umform.steps.loop import Run


@dataclass(frozen=True)
class Saved:
    """A converged state with its evaluation, and the histories that this had read."""

    snapshot: Snapshot
    evaluation: Evaluation
    before: list[tuple[Term, NDArray[np.float64]]]

    @classmethod
    def of(cls, model: Model, evaluation: Evaluation) -> Self:
        """That of a model."""
        return cls(model.snapshot(), evaluation, [(term, term.before) for term in model.terms])

    def restore(self, run: Run) -> None:
        """Put the run back, so that a checkpoint can repeat the evaluation to the last bit."""
        run.model.restore(self.snapshot)
        run.model.stand(self.evaluation)
        for term, before in self.before:
            term.before = before
        run.evaluation, run.trail = self.evaluation, None


@contextmanager
def tightened(run: Run, force: float) -> Iterator[None]:
    """Let Newton's method go on until the residual is no more than a force, if its tolerance asks for less."""
    own = run.newton.options
    scale = run.evaluation.force_scale
    run.newton.options = replace(own, residual=min(own.residual, force / scale)) if scale > 0.0 else own
    try:
        yield
    finally:
        run.newton.options = own

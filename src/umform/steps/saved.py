"""A converged state to which a step may return, and increments with an accurate force."""

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
    """A converged state with its evaluation, and the input histories of the evaluation."""

    snapshot: Snapshot
    evaluation: Evaluation
    before: list[tuple[Term, NDArray[np.float64]]]

    @classmethod
    def of(cls, model: Model, evaluation: Evaluation) -> Self:
        """State of the model."""
        return cls(model.snapshot(), evaluation, [(term, term.before) for term in model.terms])

    def restore(self, run: Run) -> None:
        """Restore the run, so that a checkpoint can repeat the evaluation to the last bit."""
        run.model.restore(self.snapshot)
        run.model.stand(self.evaluation)
        for term, before in self.before:
            term.before = before
        run.evaluation, run.trail = self.evaluation, None


@contextmanager
def tightened(run: Run, force: float) -> Iterator[None]:
    """Continue Newton's method until the residual is below a force, if its tolerance is looser."""
    own = run.newton.options
    scale = run.evaluation.force_scale
    run.newton.options = replace(own, residual=min(own.residual, force / scale)) if scale > 0.0 else own
    try:
        yield
    finally:
        run.newton.options = own

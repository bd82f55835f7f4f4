"""A converged state to which a step may return, and tolerances for an accurate force."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from umform.analysis.newton.newton import Newton
from umform.analysis.steps.run_state import Run
from umform.model import Evaluation, Model, Snapshot
from umform.model.terms.term import Term


@dataclass(frozen=True)
class Saved:
    """A converged state with its evaluation, and the input histories of the evaluation."""

    snapshot: Snapshot
    evaluation: Evaluation
    before: list[tuple[Term, NDArray[np.float64]]]

    @classmethod
    def of(cls, model: Model, evaluation: Evaluation) -> Self:
        """State of the model."""
        return cls(model.system.snapshot(), evaluation, [(term, term.before) for term in model.system.terms])

    def restore(self, run: Run) -> None:
        """Restore the run, so that a checkpoint can repeat the evaluation to the last bit.

        Nothing is left to extrapolate: the next attempt evaluates the tangent of the state, from which the enhanced
        parameters are recovered.
        """
        run.model.system.restore(self.snapshot)
        run.model.system.stand(self.evaluation)
        for term, before in self.before:
            term.before = before
        run.evaluation, run.trail = self.evaluation, None


def tightened(run: Run, force: float) -> Newton:
    """The method of a run with a residual below a force, if its own tolerance is looser."""
    newton, scale = run.newton, run.evaluation.force_scale
    return newton.but(residual=min(newton.options.residual, force / scale)) if scale > 0.0 else newton

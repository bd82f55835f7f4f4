"""Diagnosis of a failed increment: a sheet that has thinned too far."""

from __future__ import annotations

import numpy as np

from umform.analysis.steps.run_state import Run
from umform.results.fields import thickness_change

#: Loss of thickness above which a sheet has necked, and burst.
_BURST = 0.5


def thinned(run: Run) -> tuple[str, str] | None:
    """Cause and remedy if the sheet had lost half of its thickness at the last converged state; None otherwise."""
    with np.errstate(invalid="ignore", divide="ignore"):  # a face without an area has no thickness
        loss = run.model.system.ranks.max(float(-thickness_change(run.model).min()))
    if not loss > _BURST:
        return None
    lost = f"{100.0 * loss:.0f} % of its thickness"
    cause = f"at the last converged state the sheet has lost {lost}, far past its necking: it would have burst before"
    remedy = (
        "end the step at a smaller load or displacement; if the sheet should not be so thin, more elements where it "
        "thins: a coarse mesh carries more than the sheet, and has the maximum of its load later or not at all"
    )
    return cause, remedy

"""An early end: frames and checkpoint are brought to the last row of the history."""

from __future__ import annotations

from typing import TYPE_CHECKING

from umform.analysis.steps.run_state import Run
from umform.errors import NoConvergence

if TYPE_CHECKING:
    from umform.analysis.run.checkpoint import Checkpoints


class Stopped(KeyboardInterrupt):
    """A stop between two increments, on all ranks, with its checkpoint."""


def ended_early(run: Run, checkpoints: Checkpoints | None, error: BaseException) -> None:
    """Write the checkpoint and keep the frame of the last converged state, whatever has ended the run.

    The frame is not in the checkpoint: a run that is continued has the frames of an uninterrupted one. A state after
    the last row, whose row has failed, is in neither; nor is one that the runs that follow have not reached.
    """
    ranks, result = run.model.system.ranks, run.result
    if not (ranks.size == 1 or isinstance(error, NoConvergence | Stopped)) or not _at_last_row(run):
        return  # what keeps states needs all ranks
    try:
        level = run.follower is None or run.follower.level
        if checkpoints is not None and level and not isinstance(error, Stopped):
            checkpoints.write(run)
        old = not result.frames or result.frames[-1].number < len(result) - 1
        if ranks.any(run.frames > 0 and ranks.rank == 0 and old):  # the first rank has the frames
            with result.timing.output:
                result.add_frame(run.evaluation)
    except Exception as problem:  # a function of the user that fails again must not hide the first failure
        result.warn(f"the last converged state could not be kept: {problem}")


def _at_last_row(run: Run) -> bool:
    """Whether the model stands where the last row of the history was written."""
    if not run.result.rows:
        return False
    row, model = run.result.rows[-1], run.model
    return row["time"] == model.system.time and all(row[control.name] == control.value for control in model.controls)

"""Error for data that only the ranks of a run hold."""

from __future__ import annotations

from umform.errors import ModelError


def not_here(what: str) -> ModelError:
    """The error for data of elements that only the ranks hold after a run on ranks."""
    return ModelError(
        f"{what} is not here",
        cause="the model was solved with the solver petsc, and each rank had what belongs to its own elements",
        remedy="read history and frames of the result; give all steps in one solve(), or go on with resume()",
    )

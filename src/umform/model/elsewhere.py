"""What is said where the ranks of a run have what is asked for."""

from __future__ import annotations

from umform.errors import ModelError


def not_here(what: str) -> ModelError:
    """The error for what each rank had of its own elements, after a run on ranks."""
    return ModelError(
        f"{what} is not here",
        cause="the model was solved with the solver petsc, and each rank had what belongs to its own elements",
        remedy="read history and frames of the result; give all steps in one solve(), or go on with resume()",
    )

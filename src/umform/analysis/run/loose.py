"""Springs under an initially loose sheet, added automatically if the steps bring tools to it.

docs/theory, 4.18
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from itertools import chain, count

from umform.analysis.steps import Close, Move, Release, Step
from umform.errors import ModelError
from umform.model import Model
from umform.model.equations.checks import free_in_touch, free_now
from umform.model.equations.rest_springs import Rest
from umform.model.terms.control import OnDofs
from umform.model.tools.tool_controls import ToolForce, ToolWay
from umform.results.history import History


def carry_loose_sheet(model: Model, steps: Sequence[Step]) -> Rest | None:
    """Add springs under a sheet that can move as a rigid body now but will be held by tools.

    Parameters
    ----------
    model : Model
        The model before the first step.
    steps : sequence of Step
        Steps of the run.

    Returns
    -------
    Rest or None
        The springs, if needed.
    """
    motions = carried_motions(model, steps)
    if not motions:
        return None
    taken = {name for term in model.system.others for name in term.column_names()}
    free = (name for name in chain(["rest"], (f"rest{k}" for k in count(2))) if f"{name}_acts" not in taken)
    return model.rest(name=next(free), motions="; ".join(motions))


@contextmanager
def carried(model: Model, steps: Sequence[Step]) -> Iterator[None]:
    """Add springs under a loose sheet within the block."""
    springs = carry_loose_sheet(model, steps)
    try:
        yield
    finally:
        if springs is not None:
            model.system.others.remove(springs)
            model.system.now.restructured()


def carried_motions(model: Model, steps: Sequence[Step]) -> list[str]:
    """Rigid-body motions that are free now and that tools will constrain, as text; none if others remain free."""
    if not model.carries_loose_sheet or not model.contacts or not _brings_tools(model, steps):
        return []
    try:
        free = free_now(model.system)
    except ModelError:  # the check of the model reports the details
        return []
    return free if free and not free_in_touch(model.system) else []


def note_springs(model: Model, result: History) -> None:
    """Note in the events that a run added springs under the sheet."""
    for term in model.system.others:
        if isinstance(term, Rest) and term.motions and term.acts(model.system.ranks):
            result.note(
                f"{term.name}: the sheet is loose, free: {term.motions}; it rests on weak springs until tools hold "
                f"it (columns {term.name}_acts, {term.name}_energy)"
            )


def _brings_tools(model: Model, steps: Sequence[Step]) -> bool:
    """Whether a step moves a tool, or nodes of the sheet."""
    if any(tool.motion is not None for tool in model.tools):
        return True
    moved = [control for step in steps if isinstance(step, Move | Close) for control in step.moved()]
    moved += [step.control for step in steps if isinstance(step, Release)]
    return any(isinstance(control, ToolWay | ToolForce | OnDofs) for control in moved)

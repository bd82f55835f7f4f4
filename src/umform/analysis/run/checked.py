"""Reject steps that a model cannot execute, before the first one starts."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from umform.analysis.steps import Step
from umform.analysis.steps.arc_length.arc import Arc
from umform.analysis.steps.arc_length.checks import refuse_on_an_arc
from umform.analysis.steps.close import Close, way_is_found
from umform.analysis.steps.free import Free
from umform.analysis.steps.release import Release
from umform.errors import InvalidValue
from umform.model import Model, Tool
from umform.model.supports.support import Support
from umform.model.terms.control import Control


def needs_model(model: object) -> None:
    """Reject what is no model in a run of one process.

    Raises
    ------
    InvalidValue
    """
    if not isinstance(model, Model):
        raise InvalidValue(
            "there is no model",
            where="solve(), resume() or OpenRun()",
            value=model,
            cause="another object, or None, which only ranks but the first may have, with the solver petsc",
            remedy="the model first, then its steps; on ranks solver='petsc'",
        )


def checked(model: Model | None, steps: Sequence[Step] | Step) -> list[Step]:
    """The steps, if they are valid for the model."""
    assert model is not None
    if not isinstance(steps, Step | Iterable):
        raise InvalidValue(
            "a run has a step, or a list of steps",
            where="steps",
            value=steps,
            cause="a control, a class in place of its step, or no step at all",
            remedy="Move(control, to=-1.0, steps=10)",
        )
    sequence = [steps] if isinstance(steps, Step) else list(steps)
    for number in range(len(sequence)):
        check_step(model, sequence, number)
    for step in sequence:
        if isinstance(step, Free):
            step.prepare(model)  # the history has the columns of its forces from the beginning
    return sequence


def check_step(model: Model, steps: Sequence[Step], number: int) -> None:
    """Reject a step of some, counted from 0, that the model cannot execute then.

    Raises
    ------
    InvalidValue
    """
    step, earlier, where = steps[number], steps[:number], f"step {number + 1}"
    if isinstance(step, Arc):
        refuse_on_an_arc(model, where)
    if not isinstance(step, Step):
        raise InvalidValue(
            "a step is a Move, a Release, an Arc, a Free or a Close",
            where=where,
            value=step,
            cause="a control, a class in place of its step, or nothing",
            remedy="Move(control, to=-1.0, steps=10)",
        )
    if isinstance(step, Free):
        _refuse_to_free(model, step, earlier, where)
        return
    for control in [step.control] if isinstance(step, Release) else step.moved():
        if control not in model.controls:
            raise InvalidValue(
                "a step moves a control that the model does not have",
                where=where,
                value=control,
                cause="it belongs to another model",
                remedy="use what prescribe(), force(), pressure() or drive() of this model returned",
            )
        _refuse_a_way_that_is_found(model, control, earlier, where)


def _refuse_a_way_that_is_found(model: Model, control: Control, earlier: Sequence[Step], where: str) -> None:
    """Reject to move a tool whose travel a force or a spring determines, unless it was released or opened."""
    press = way_is_found(model, control)
    if press is None:
        return
    held = press.held
    for step in earlier:
        if isinstance(step, Release | Close) and step.control is press.force:
            held = isinstance(step, Release)
        held = held or (isinstance(step, Free) and press.way.tool in step.things)
    if not held:
        raise InvalidValue(
            "a step moves the way of a tool that a force presses",
            where=where,
            value=control,
            cause="the way would be given and found at the same time",
            remedy=f"move the force, control {press.force.name}; Release gives the way back; drive() goes by way",
        )


def _refuse_to_free(model: Model, step: Free, earlier: Sequence[Step], where: str) -> None:
    """Reject to remove a support that is inactive when its step begins, or a tool that is open."""
    freed = [thing for other in earlier if isinstance(other, Free) for thing in other.things]
    put = [other.on for other in earlier if isinstance(other, Free)]
    for thing in step.things:
        there = thing in model.tools if isinstance(thing, Tool) else thing in model.supports.all
        if not there or thing in freed:
            raise InvalidValue(
                "a step frees a support or a tool that the model does not have then",
                where=where,
                value=thing if isinstance(thing, Support) else f"tool {thing.name}",
                cause="it belongs to another model, or an earlier step has freed it",
                remedy="free each support and each tool of this model once",
            )
    if step.on is not None and (step.on not in model.supports.all or not step.on.removed or step.on in put):
        raise InvalidValue(
            "a step puts a support in place that does not wait then",
            where=where,
            value=step.on,
            cause="it belongs to another model, or is in place already",
            remedy="a rigid support of this model that waits, in one step",
        )

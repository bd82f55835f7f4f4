"""Free a support gradually: the forces that it exerts become a load, which goes to zero."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

from umform.errors import InvalidValue
from umform.model.control import Control
from umform.model.removal import put_supports, states_of_supports
from umform.model.support import Support
from umform.steps.loop import Run
from umform.steps.move import Move
from umform.steps.moving import Marching


@dataclass(frozen=True)
class Free:
    """Remove a support; its reactions become a dead load that goes to zero over the step.

    The history has the columns ``<name>`` and ``<name>_force`` of the support, from the beginning of the run on: the
    share of the reactions that is left, zero while the support acts.

    Parameters
    ----------
    support : Support
        What ``fix``, ``symmetry``, ``hinge`` or ``hold_director`` of the model returned.
    steps, cuts, grow
        As for :class:`umform.Move`.
    """

    support: Support
    steps: int = 10
    cuts: int = 10
    grow: float = 1.0

    def __post_init__(self) -> None:
        if not isinstance(self.support, Support):
            raise InvalidValue(
                "a step Free takes a support",
                where="Free",
                value=self.support,
                cause="a control, or the name of a set",
                remedy="what fix(), symmetry(), hinge() or hold_director() returned; Release for a control",
            )
        Move([], [], self.steps, self.cuts, self.grow)  # refuses numbers that make no sense

    def moved(self) -> list[Control]:
        """The load that takes the place of the support."""
        return [] if self.support.load is None else [self.support.load]

    def move(self) -> Move:
        """The step as a move of the load."""
        return Move(self.moved(), [0.0], self.steps, self.cuts, self.grow)


class Freeing(Marching):
    """Moves the load that takes the place of a support; the support is gone once the first increment converges."""

    @classmethod
    def begin(cls, run: Run, step: Free) -> Self:  # type: ignore[override]
        """The loop at the beginning of the step."""
        return cls([1.0], run.model.time, 1.0 / step.steps)

    @classmethod
    def recall(cls, run: Run, step: Free, memory: dict[str, object]) -> Self:  # type: ignore[override]
        """The loop as it stood."""
        return super().recall(run, step.move(), memory)

    def advance(self, run: Run, step: Free) -> None:  # type: ignore[override]
        """Try one increment; as long as none has converged the support acts between two of them."""
        if self.fraction > 0.0:
            super().advance(run, step.move())
            return
        model = run.model
        before = states_of_supports(model)
        load = model.remove(step.support)
        try:
            super().advance(run, step.move())
        finally:
            if self.fraction == 0.0:
                put_supports(model, before)
                load.value = 0.0

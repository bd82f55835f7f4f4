"""Move controls along lines or functions, in equal increments or at a pace that follows what happens."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from umform.errors import InvalidValue, NotFinite
from umform.model.control import Control
from umform.steps.pace import Pace


@dataclass(frozen=True)
class Move:
    """Move one or more controls along straight lines in time, or along functions of time.

    Parameters
    ----------
    control : Control or sequence of Control
        What is moved: a prescribed displacement, a load factor, a pressure, a tool.
    to : float, callable or sequence
        End value, or a function of the fraction (0 ... 1) of the step, one for each control.
    steps : int or Pace, optional
        Number of equal increments; or limits of what may happen in one, from which its size follows. Default: those of
        :class:`umform.Pace`.
    cuts : int
        How often an increment may be halved before the run is given up.
    grow : float
        Largest increment over the nominal one: 1 never grows beyond ``1/steps``. A pace has a limit of its own.
    """

    control: Control | Sequence[Control]
    to: float | Callable[[float], float] | Sequence[float | Callable[[float], float]]
    steps: int | Pace | None = None
    cuts: int = 10
    grow: float = 1.0

    def __post_init__(self) -> None:
        if (isinstance(self.steps, int) and self.steps < 1) or not isinstance(self.steps, int | Pace | None):
            raise InvalidValue(
                "a step needs a whole number of increments, one at least",
                value=self.steps,
                remedy="a number, or limits of what may happen in an increment: Pace()",
            )
        if not isinstance(self.cuts, int) or self.cuts < 0:
            raise InvalidValue("cuts must be 0 or more", value=self.cuts)
        if not self.grow >= 1:
            raise InvalidValue("grow must be 1 or more", value=self.grow)
        for target in self.targets():
            if not callable(target) and not (np.isscalar(target) and np.isrealobj(target) and np.isfinite(target)):
                raise InvalidValue("a control is moved to a finite number or along a function", value=target)
        if len(self.targets()) != len(self.moved()):
            raise InvalidValue(
                "give one target for each control", value=f"{len(self.moved())} controls, {len(self.targets())} targets"
            )

    @property
    def pace(self) -> Pace | None:
        """What limits the increments; None if they are equal."""
        return Pace() if self.steps is None else self.steps if isinstance(self.steps, Pace) else None

    @property
    def nominal(self) -> float:
        """First increment, as a part of the step."""
        return self.pace.first if self.pace is not None else 1.0 / self.steps  # type: ignore[operator]

    def moved(self) -> list[Control]:
        """The controls of the step."""
        return [self.control] if isinstance(self.control, Control) else list(self.control)

    def targets(self) -> list[float | Callable[[float], float]]:
        """Their targets."""
        return list(self.to) if isinstance(self.to, Sequence) else [self.to]

    def values(self, fraction: float, starts: Sequence[float]) -> list[float]:
        """Values of the controls at a fraction of the step that has begun at ``starts``."""
        values = [
            float(target(fraction)) if callable(target) else start + fraction * (target - start)
            for start, target in zip(starts, self.targets(), strict=True)
        ]
        for control, value in zip(self.moved(), values, strict=True):
            if not math.isfinite(value):
                where = f"fraction {fraction:g} of the step"
                raise NotFinite(f"the function that moves {control.name} is not finite", where=where, value=value)
        return values

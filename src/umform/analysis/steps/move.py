"""Move controls along lines or functions, in equal or adaptive increments."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Annotated, Any

import numpy as np

from umform.analysis.steps.pace import Pace
from umform.errors import InvalidValue, NotFinite
from umform.model.terms.control import Control
from umform.spec import About, check_fields, names_its_words
from umform.spec.types import FARTHEST, Cuts, Duration, Growth, Increments

#: One or several controls.
Moved = Annotated[
    Control | Sequence[Control],
    About(
        cause="its name, a tool, or a missing value",
        remedy="what prescribe(), force(), pressure() or drive() of the model returned, or a list of it",
    ),
]
#: Value of a control as a function of another one: a function, or pairs of both.
Law = Callable[[float], float] | Sequence[tuple[float, float]]


@names_its_words
@dataclass(frozen=True)
class Move:
    """Move one or more controls along straight lines in time, or along functions of time.

    Examples
    --------
    A holder force that rises from 35 to 60 over the first 20 of a stroke of 70, then stays:

    >>> from umform import J2, Box, Linear, Model, Move, Plane
    >>> from umform.mesh import strip
    >>> model = Model(strip(80.0, 1.0, 0.8, (20, 1)), material=J2(E=206e3, nu=0.3, hardening=Linear(200.0, 500.0)))
    >>> hold = model.press(model.tool("holder", Plane((0, 0, 0.4), (0, 0, -1))), "z", "hold")
    >>> stroke = model.drive(model.tool("punch", Box((0, 0, 50.4), (25, 50, 100), 5)), "z", "stroke")
    >>> step = Move(stroke, -70.0, follow={hold: [(0.0, -35.0), (-20.0, -60.0)]})
    >>> [control.name for control in step.moved()]
    ['stroke', 'hold']
    """

    control: Moved
    """What moves, one or several: a prescribed displacement, a load factor, a pressure, a tool."""
    to: float | Callable[[float], float] | Sequence[float | Callable[[float], float]]
    """End value, or a function of the fraction (0 ... 1) of the step, one for each control."""
    steps: Increments | Pace | None = None
    """Number of equal increments, or limits on the changes in one, which determine its size; default: those of
    :class:`umform.Pace`."""
    cuts: Cuts = 10
    """How often an increment may be halved before the run fails."""
    grow: Growth = 1.0
    """Largest increment relative to the nominal one: 1 never exceeds ``1/steps``. A pace has its own limit."""
    follow: Mapping[Control, Law] = field(default_factory=dict)
    """More controls, as functions of the value of the first one: a holder force over the stroke. Pairs (stroke, force)
    are a table with straight lines between them, constant outside."""
    time: Duration = 1.0
    """Duration of the step: for rate-dependent metals, and for motions of tools in time."""

    def __post_init__(self) -> None:
        check_fields(self)
        for target in self.targets():
            if not callable(target) and not (isinstance(target, int | float | np.number) and abs(target) <= FARTHEST):
                raise InvalidValue(
                    "a control is moved to a finite number or along a function",
                    where="Move, to",
                    value=target,
                    cause=f"a missing value, a division by zero, or beyond {FARTHEST:g}",
                    remedy="-15.0, or lambda fraction: -15.0 * fraction",
                )
        if len(self.targets()) != len(self._given()):
            raise InvalidValue(
                "give one target for each control",
                where="Move, to",
                value=f"{len(self._given())} controls, {len(self.targets())} targets",
                cause="a list of values that one control takes, or a control without a value",
                remedy="a step for each value; a list with one value for each control of a list",
            )
        if not isinstance(self.follow, Mapping):
            raise InvalidValue(
                "followers are controls with their tables",
                where="Move, follow",
                value=self.follow,
                cause="a list, or a control in place of a mapping",
                remedy="{hold: table}",
            )
        for control, law in self.follow.items():
            _check_law(control, law)
        if len(set(self.moved())) < len(self.moved()) or (self.follow and not self._given()):
            raise InvalidValue(
                "a step moves a control once, and a control follows another one",
                where="Move, follow" if self.follow else "Move",
                value=", ".join(control.name for control in self.moved()),
                cause="a control that is named twice, or nothing moves that it could follow",
                remedy="name it once: under control with a target, or under follow with a table",
            )

    @property
    def pace(self) -> Pace | None:
        """Limits of the increments; None if they are equal."""
        return Pace() if self.steps is None else self.steps if isinstance(self.steps, Pace) else None

    @property
    def nominal(self) -> float:
        """First increment, as a fraction of the step."""
        return self.pace.first if self.pace is not None else 1.0 / self.steps  # type: ignore[operator]

    def moved(self) -> list[Control]:
        """The controls of the step: the given ones, then the followers of the first one."""
        return [*self._given(), *self.follow]

    def _given(self) -> list[Control]:
        return [self.control] if isinstance(self.control, Control) else list(self.control)

    def targets(self) -> list[float | Callable[[float], float]]:
        """Their targets."""
        to: Any = self.to.tolist() if isinstance(self.to, np.ndarray) else self.to
        return list(to) if isinstance(to, list | tuple) else [to]

    def values(self, fraction: float, starts: Sequence[float]) -> list[float]:
        """Values of the controls within the step.

        Parameters
        ----------
        fraction : float
            Completed fraction of the step, 0 to 1.
        starts : sequence of float
            Values at its beginning.

        Returns
        -------
        list of float
            One value for each control, followers included.
        """
        given = [
            _called(target, fraction, control) if callable(target) else start + fraction * (target - start)
            for start, target, control in zip(starts, self.targets(), self._given(), strict=False)
        ]
        given += [_at(law, _number(given[0]), control) for control, law in self.follow.items()]
        values = [_number(value) for value in given]
        for control, value, found in zip(self.moved(), values, given, strict=True):
            if not math.isfinite(value):
                raise NotFinite(
                    f"the function that moves {control.name} is not finite",
                    where=f"fraction {fraction:g} of the step",
                    value=found,
                    cause="a division by zero, or a function that returns no number",
                    remedy="look at the function",
                )
        return values


def _called(function: Callable[[float], float], value: float, control: Control) -> Any:
    """Value of a function; an exception in it names the control."""
    try:
        return function(value)
    except Exception as error:
        error.add_note(f"in the function that moves {control.name}, called as function({value:g})")
        raise


def _at(law: Law, value: float, control: Control) -> Any:
    """Value of a follower for the value of the first control."""
    if callable(law):
        return _called(law, value, control)
    places, values = np.array(sorted(law), dtype=float).T
    return np.interp(value, places, values)


def _number(value: Any) -> float:
    """The value of a function; NaN if it is no number."""
    try:
        return float(value)
    except (TypeError, ValueError):
        return math.nan


def _check_law(control: Control, law: Law) -> None:
    """Reject a follower that is no control, or has neither a function nor a table."""
    if not isinstance(control, Control):
        raise InvalidValue(
            "followers are controls with their tables",
            where="Move, follow",
            value=control,
            cause="the name of a control, or a tool",
            remedy="{hold: table}, with what press(), drive() or prescribe() returned",
        )
    if callable(law):
        return
    try:
        table = np.asarray(law, dtype=float)
    except (TypeError, ValueError):
        table = np.empty(0)
    pairs = table.ndim == 2 and table.shape[1:] == (2,)
    if not pairs or not (np.abs(table) <= FARTHEST).all() or len(set(table[:, 0])) < len(table):
        raise InvalidValue(
            "a control follows another one by a function or a table of pairs",
            where=f"Move, follow {control.name}",
            value=law,
            cause="not pairs (value of the first control, value of this one), one value given twice, no number, "
            f"or one beyond {FARTHEST:g}",
            remedy="[(0.0, -35.0), (-20.0, -60.0)] for instance",
        )

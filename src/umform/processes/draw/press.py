"""The press: a holder on distance blocks, a stroke, and the opening of all tools."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from umform.analysis.steps import Free, Pace, Step

#: Stiffness of the distance blocks: that of the force on them over the thickness, times this.
_BLOCKS = 200.0
#: Travel of the holder, over the thickness, at which the blocks begin to carry load.
_AT_ONCE = 1e-5
#: Increments in which tools open.
_OPENING = 6


@dataclass(frozen=True)
class Press:
    """The steps of a press.

    Attributes
    ----------
    closing : tuple of Step
        From the open tools to the end of the stroke.
    opening : tuple of Step
        The tools open, so that the part springs back; the gauge holds it from the first of them.
    """

    closing: tuple[Step, ...]
    opening: tuple[Step, ...]

    @classmethod
    def of(cls, steps: Sequence[Step]) -> Press:
        """The steps of a problem, whose tools open from its first step of the kind free."""
        opens = next(number for number, step in enumerate(steps) if isinstance(step, Free))
        return cls(tuple(steps[:opens]), tuple(steps[opens:]))


def pressed(contact: str, force: float | None, *, blocks_for: float | None = None) -> dict[str, Any]:
    """Table of the control of a holder under a force; distance blocks for a sheet of a thickness, if it is given, keep
    it from coming nearer than it is at first.

    Empty without a force: the holder keeps its distance.
    """
    if force is None:
        return {}
    stops: list[dict[str, Any]] = []
    if blocks_for is not None:
        stops = [{"at": _AT_ONCE * blocks_for, "stiffness": _BLOCKS * force / blocks_for, "below": True}]
    return {"hold": {"kind": "press", "contact": contact, "direction": "z", "stops": stops}}


def press_steps(
    force: float | None, way: float, pace: Pace, opened: Sequence[Sequence[str]], *, blocks: bool = True
) -> list[dict[str, Any]]:
    """Tables of the steps: the holder presses, the punch draws, the tools open.

    Parameters
    ----------
    force : float, optional
        Force of the holder; None for one that keeps its distance.
    way : float
        Stroke of the punch.
    pace : Pace
        Increments of the stroke.
    opened : sequence of sequences of str
        Contacts whose tools open; those of one sequence open in one step.
    blocks : bool
        Whether the holder rests on distance blocks at the start, or has to be closed.
    """
    hold: list[dict[str, Any]] = []
    if force is not None:
        on_blocks = {"kind": "move", "to": {"hold": -force}, "increments": 1}
        hold = [on_blocks if blocks else {"kind": "close", "control": "hold", "force": -force}]
    draw = {"kind": "move", "to": {"stroke": way}, "pace": asdict(pace)}
    first, *rest = ({"kind": "free", "contacts": list(names), "increments": _OPENING} for names in opened)
    return [*hold, draw, first | {"on": "gauge"}, *rest]

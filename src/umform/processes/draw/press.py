"""The press: a holder on distance blocks, a stroke, and the opening of all tools."""

from __future__ import annotations

from dataclasses import dataclass

from umform.errors import InvalidValue
from umform.model import Model, Tool
from umform.model.support import Support
from umform.model.tool_controls import ToolForce, ToolMotion
from umform.solution.options import NewtonOptions
from umform.steps import Close, Free, Move, Pace, Step

#: Tolerances of drawing: what one increment leaves over is a force of the next. Tighter ones change no number.
OPTIONS = NewtonOptions(residual=1e-3, increment=1e-2, keep=True)
#: Stiffness of the distance blocks relative to the force on them, per mm.
_BLOCKS = 200.0
#: Travel of the holder at which the blocks begin to carry load, mm.
_AT_ONCE = 1e-5


@dataclass(frozen=True)
class Hold:
    """A holder under a force.

    Attributes
    ----------
    control : ToolForce
        Control of the force.
    force : float
        The force.
    on_blocks : bool
        Whether it rests on distance blocks at the start, or has to be closed.
    """

    control: ToolForce
    force: float
    on_blocks: bool

    def step(self) -> Step:
        """The step that applies the force."""
        if self.on_blocks:
            return Move(self.control, to=-self.force, steps=1)
        return Close(self.control, force=-self.force)


@dataclass(frozen=True)
class Press:
    """The operations of a press: hold, draw, open.

    Attributes
    ----------
    hold : Hold, optional
        Holder force; None for a holder at a fixed distance.
    stroke : ToolMotion
        Motion of the punch.
    way : float
        Its stroke.
    gauge : Support
        Support of the part after the tools have opened.
    order : tuple of tuples of str
        Names of the tools that open; those of one tuple open in one step.
    pace : Pace
        Increments of the stroke.
    """

    hold: Hold | None
    stroke: ToolMotion
    way: float
    gauge: Support
    order: tuple[tuple[str, ...], ...] = (("die", "holder", "punch"),)
    pace: Pace = Pace()

    def closing(self) -> list[Step]:
        """Steps from the open tools to the end of the stroke."""
        return [*([] if self.hold is None else [self.hold.step()]), Move(self.stroke, to=self.way, steps=self.pace)]

    def opening(self, model: Model) -> list[Step]:
        """Steps that open the tools, so that the part springs back; the gauge holds it from the first of them."""
        tools = {tool.name: tool for tool in model.tools}
        first, *rest = ([tools[name] for name in names] for names in self.order)
        return [Free(first, steps=6, on=self.gauge), *(Free(group, steps=6) for group in rest)]


def held_by(model: Model, holder: Tool, force: float | None, *, blocks: bool = True) -> Hold | None:
    """Press a holder with a force; distance blocks keep it from coming nearer than it is now."""
    if force is None:
        return None
    if not force > 0.0:
        raise InvalidValue("the force of the holder must be positive", where="holder_force", value=force)
    control = model.press(holder, "z", name="hold")
    if blocks:
        model.stop(control, at=_AT_ONCE, stiffness=_BLOCKS * force, below=True)
    return Hold(control, force, blocks)

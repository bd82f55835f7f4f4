"""Close a force-controlled tool: displacement control until the force is reached, then force control."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from umform.analysis.steps.increment import no_convergence, take_increment
from umform.analysis.steps.run_state import Run, Take
from umform.analysis.steps.saved_state import Saved, tightened
from umform.errors import InvalidValue, NoConvergence
from umform.model import Model
from umform.model.tools.press import Press
from umform.model.tools.tool_controls import ToolForce, ToolTurn
from umform.results.records import Failed
from umform.spec import check_fields, names_its_words
from umform.spec.types import Duration, Positive

#: Largest residual of the last increment relative to the force.
_EXACT = 1e-10
#: Penetration at first contact relative to the thickness of the sheet.
_HAIR = 1e-4
#: Failed or too large increments before the run fails.
_MOST = 60
#: Distance from a rigid stop that counts as contact, relative to the largest travel.
_AT_STOP = 1e-12
#: An increment of the force is undone if the tool travels farther in it than this times the largest increment.
_LONGER = 1.0 + 1e-9
#: Number of iterations up to which an increment counts as easy.
_EASY = 8
#: Following runs have the force or the gap of the leading one, up to this part of the force or of the largest travel;
#: the most solutions for it.
_SAME, _CLOSER = 1e-13, 5


@names_its_words
@dataclass(frozen=True)
class Close:
    """Close a force-driven tool that need not touch the sheet yet: displacement control, then force control.

    The first increments bring the tool to the sheet with a negligible overshoot; the next ones grow while Newton
    converges easily. The last one prescribes the force, with the displacement as an unknown, and meets it exactly.
    Under displacement control the column of the control has the required force.

    Examples
    --------
    >>> import umform as uf
    >>> model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=210e3, nu=0.3))
    >>> support = model.fix("lower", "z")
    >>> side = model.symmetry("x0", "x"), model.symmetry("y0", "y")
    >>> plate = model.tool("plate", uf.Plane((0, 0, 0.3), (0, 0, -1)))
    >>> pair = model.contact("upper", plate, penalty=1e4)
    >>> press = model.press(plate, "z", "press")
    >>> result = uf.solve(model, uf.Close(press, force=-5.0))
    >>> round(float(result["press"][-1]), 6)
    -5.0
    """

    control: ToolForce
    """What ``press``, ``press_turn`` or ``spring`` of the model returned."""
    force: float
    """Closing force (or moment) on the tool, in the direction of the control."""
    way: Positive | None = None
    """Largest way (or angle); default: its distance from the sheet and the largest extent of the sheet."""
    time: Duration = 1.0
    """Duration of the step: for rate-dependent metals, and for motions of tools in time."""
    increment: Positive | None = None
    """Largest increment of the way (or angle) in contact; default: any in which Newton converges easily. A sheet that
    touches itself needs one below half of its thickness."""

    def __post_init__(self) -> None:
        if not isinstance(self.control, ToolForce):
            raise InvalidValue(
                "a step Close takes the control of a pressed tool",
                where="Close",
                value=self.control,
                cause="the control of a tool that is driven, or a tool",
                remedy="what press(), press_turn() or spring() of the model returned; Move for a tool that is driven",
            )
        number = isinstance(self.force, int | float | np.number)
        if not number or not np.isfinite(self.force) or self.force == 0.0:
            raise InvalidValue(
                "a tool is closed with a finite force that is not zero",
                where=f"Close, {self.control.name}",
                value=self.force,
                cause="no force holds a tool where it is",
                remedy="the force of the holder along its direction, with its sign",
            )
        check_fields(self)

    def moved(self) -> list[ToolForce]:
        """The control of the step."""
        return [self.control]


@dataclass
class Closing:
    """Increments of the travel, then one of the force. docs/theory, 4.18

    Attributes
    ----------
    start_time, start_way, start_force : float
        Time, travel, and force on the tool at the beginning.
    limit : float
        Largest travel.
    hair : float
        Travel beyond first contact to aim at.
    size : float
        Next increment of the travel, in contact.
    before : tuple of float, optional
        Travel and force of the previous state, if the tool was in contact there.
    taken : float, optional
        The last increment of the travel, for the extrapolation.
    bound : float, optional
        A travel at which the force exceeds the target.
    failures : int
        Increments that did not converge or were too large.
    done : bool
        Whether the force is applied.
    """

    start_time: float
    start_way: float
    start_force: float
    limit: float
    hair: float
    size: float
    before: tuple[float, float] | None = None
    taken: float | None = None
    bound: float | None = None
    failures: int = 0
    done: bool = False

    @classmethod
    def begin(cls, run: Run, step: Close) -> Self:
        """The loop at the beginning of the step."""
        model = run.model
        press = model.tools.press_of(step.control)
        hair = _as_way(run, press, _HAIR * model.system.thickness)
        far = max(_gap(run, press), 0.0) + model.system.extent
        limit = _as_way(run, press, far) if step.way is None else step.way
        return cls(model.system.time, press.way.value, _takes(run, press), limit, hair, hair)

    @classmethod
    def recall(cls, run: Run, step: Close, memory: dict[str, Any]) -> Self:
        """The restored loop."""
        before = memory["before"]
        return cls(**{**memory, "before": None if before is None else (float(before[0]), float(before[1]))})

    def memory(self) -> dict[str, Any]:
        """State of the loop, for checkpoints."""
        return dict(vars(self))

    def advance(self, run: Run, step: Close) -> None:
        """Try one increment: of the travel, or the last one of the force."""
        press = run.model.tools.press_of(step.control)
        force, touches = _takes(run, press), _touches(run, press)
        if touches and abs(step.force - force) <= _EXACT * abs(
            step.force
        ):  # an earlier step has closed it with this force
            self._land(run, step, press)
            return
        sense = math.copysign(1.0, step.force - self.start_force)
        ahead = self._ahead(press, force, step.force)
        size = self.size if touches else self._short_of_the_sheet(_as_way(run, press, _gap(run, press)))
        room = press.room(sense)
        if room <= _AT_STOP * max(self.limit, self.size):
            self._land(run, step, press)
            return
        size = min(size, room)
        near = ahead is not None and 0.0 <= sense * ahead <= (2.0 if touches and step.increment is None else 1.0) * size
        beyond = touches and self.failures == 0 and abs(step.force) <= abs(force)
        if (near or beyond) and self._land(run, step, press):
            return
        left = self.limit - sense * (press.way.value - self.start_way)
        if left <= 1e-12 * self.limit:
            raise self._no_answer(run, step, force)
        if self.bound is not None:
            left = 0.5 * abs(self.bound - press.way.value)
        self._go(run, step, press, force, sense * min(size, left))

    def follow(self, run: Run, step: Close, lead: Run, take: Take) -> None:
        """Repeat the last accepted increment of the loop of a leading run: to the same force, or the same gap.

        The travel to it is the unknown of an equation, eq. (5.167); at the end the own force is applied.
        """
        assert isinstance(lead.loop, Closing)
        press, self.done = run.model.tools.press_of(step.control), lead.loop.done
        if self.done:
            step.control.value = _takes(run, press)
            take([step.force], [step.control], self.start_time + step.time)
            return
        led = next(one for tool in lead.model.tools for one in tool.presses if one.way.name == press.way.name)
        sense, scale = math.copysign(1.0, step.force - self.start_force), abs(step.force - self.start_force)
        touching, start, saved = _touches(lead, led), press.way.value, Saved.of(run.model, run.evaluation)
        wanted, slope = _level(lead, led, sense, touching=touching), 1.0
        if lead.loop.before is not None:  # in contact before
            slope = (wanted - lead.loop.before[1]) / (led.way.value - lead.loop.before[0])
            target = led.way.value + start - lead.loop.before[0] + (lead.loop.before[1] - _takes(run, press)) / slope
        else:
            target = start + sense * _as_way(run, press, 1.0) * (_gap(run, press) - _gap(lead, led))
            slope = abs(wanted) / lead.loop.hair if touching else slope
        stands = led.room(sense) <= _AT_STOP * max(self.limit, self.size)
        if stands:  # each on its own stops, whatever the sheet answers there
            target = start + sense * press.room(sense)
        before: tuple[float, float] | None = None
        for left in reversed(range(_CLOSER)):
            with press.driven():
                take([target], [press.way], self._time_at(step, target))
            found = _level(run, press, sense, touching=touching)
            if before is not None and before[0] != target and before[1] != found:
                slope = (found - before[1]) / (target - before[0])
            near = abs(found - wanted) <= _SAME * (scale if touching else self.limit)
            if left == 0 or near or stands or slope == 0.0 or press.room(sense) <= 0.0:
                break
            closer = target + (wanted - found) / slope
            if closer == target:
                break
            before, target = (target, found), closer
            saved.restore(run)
            run.model.system.evaluate(run.model.state)  # the blocks for the recovery of enhanced parameters
        step.control.value = _takes(run, press)

    def _time_at(self, step: Close, way: float) -> float:
        return self.start_time + 0.99 * step.time * (abs(way - self.start_way) / self.limit)

    def _short_of_the_sheet(self, gap: float) -> float:
        """Travel to just before the sheet, then to just beyond: free travel does no work."""
        return gap - self.hair if gap > 2.0 * self.hair else max(gap, 0.0) + self.hair

    def _ahead(self, press: Press, force: float, target: float) -> float | None:
        """Travel to the force along the last secant, or along springs; None if neither is known. eq. (4.64)"""
        slope = press.takes(press.way.value, 0.0)[1]
        if self.before is not None and self.before[0] != press.way.value:
            slope = (force - self.before[1]) / (press.way.value - self.before[0])
        return (target - force) / slope if slope > 0.0 else None

    def _go(self, run: Run, step: Close, press: Press, force: float, way: float) -> None:
        """One increment of the travel; one beyond the force is undone."""
        model, value, touched = run.model, press.way.value, _touches(run, press)
        saved, attempts = Saved.of(model, run.evaluation), run.newton.timing.attempts
        mark = attempts.mark()
        extrapolation = None if self.taken is None else way / self.taken
        try:
            with press.driven():
                time = self._time_at(step, value + way)
                converged = take_increment(run, [value + way], [press.way], time, extrapolation)
        except Failed as failure:
            self._shorten(run, step, 0.25, touched, failure)
            return
        found = _takes(run, press)
        if (found - step.force) * (step.force - self.start_force) > 0.0:
            attempts.take_back(mark, "closed beyond the force")
            saved.restore(run)
            self.bound = value + way
            part = 0.5 * abs((step.force - force) / (found - force))
            self._shorten(run, step, min(max(part, 1e-3), 0.5), touched, Failed("the force jumps over its value", []))
            return
        step.control.value = found
        self.taken, self.before = way, (value, force) if touched else None
        if touched and len(converged.iterations) <= _EASY:
            self.size = min(4.0 * self.size, step.increment or math.inf)
        done = abs(found - self.start_force) / abs(step.force - self.start_force)
        run.keep(converged, [step.control], name=f"step {run.number}: close", fraction=min(done, 1.0), frame=False)

    def _land(self, run: Run, step: Close, press: Press) -> bool:
        """The increment of the force, with the travel as an unknown; False if it is undone: longer than the largest."""
        value, saved, attempts = press.way.value, Saved.of(run.model, run.evaluation), run.newton.timing.attempts
        run.trail, mark = None, attempts.mark()
        step.control.value = _takes(run, press)
        try:
            newton, end = tightened(run, _EXACT * abs(step.force)), self.start_time + step.time
            converged = take_increment(run, [step.force], [step.control], end, None, newton=newton)
        except Failed as failure:
            self._shorten(run, step, 0.25, _touches(run, press), failure)
            return True
        if step.increment is not None and abs(press.way.value - value) > _LONGER * step.increment:
            attempts.take_back(mark, "closed farther than the largest increment")
            saved.restore(run)
            step.control.value, self.taken = _takes(run, press), None
            return False
        self.done = True
        held = f"pressed with {step.control.name} = {step.force:.6g}, stands at {press.way.name}"
        run.result.note(f"step {run.number}: tool {press.way.tool.name}, {held} = {press.way.value:.6g}")
        name = f"step {run.number}: close"
        run.keep(converged, [step.control], name=name, fraction=1.0, frame=run.frames > 0)
        return True

    def _shorten(self, run: Run, step: Close, part: float, touched: bool, failure: Failed) -> None:
        """Reduce the next increment, or end the run."""
        self.failures, self.taken = self.failures + 1, None
        if touched:
            self.size *= part
        else:
            self.hair *= part
            self.size = self.hair
        if self.failures > _MOST:
            raise no_convergence(run, failure, [step.control], [step.force]) from None

    def _no_answer(self, run: Run, step: Close, force: float) -> NoConvergence:
        press = run.model.tools.press_of(step.control)
        found = _touches(run, press)
        return NoConvergence(
            "nothing answers the force that a tool is closed with",
            where=f"step {run.number}, tool {press.way.tool.name}",
            value=f"{step.control.name} = {force:.6g} after a way of {self.limit:.6g}, wanted {step.force:.6g}",
            cause="the sheet gives way" if found else "the tool does not meet the sheet",
            remedy="put a die or a support behind the sheet, less force, a larger way"
            if found
            else "look at the sign of the force and at where the tool stands, or allow a larger way",
        )


def _takes(run: Run, press: Press) -> float:
    """Force of the press for equilibrium of its tool in the present position."""
    return press.takes(press.way.value, press.way.of_sheet(run.evaluation, run.model.system.ranks))[0]


def _level(run: Run, press: Press, sense: float, *, touching: bool) -> float:
    """The force of the press in contact, else minus the gap in the sense of the travel: both grow with it."""
    return _takes(run, press) if touching else -sense * _gap(run, press)


def _touches(run: Run, press: Press) -> bool:
    """Whether one of its tools touches the sheet."""
    found = run.evaluation.found
    return run.model.system.ranks.any(
        any(bool(found[pair].active.any()) for tool in press.way.tools for pair in tool.pairs)
    )


def _gap(run: Run, press: Press) -> float:
    """Smallest distance of its tools from the sheet."""
    found = run.evaluation.found
    gaps = [float(found[pair].gap.min(initial=np.inf)) for tool in press.way.tools for pair in tool.pairs]
    least = -run.model.system.ranks.max(-min(gaps, default=math.inf))
    return least if math.isfinite(least) else 0.0


def _as_way(run: Run, press: Press, length: float) -> float:
    """Travel in which no point of the tools moves farther than a length; an angle for a rotation."""
    if not isinstance(press.way, ToolTurn):
        return length
    axis, point = press.way.tool.axis_of(press.way, run.evaluation.controls, run.evaluation.time)
    farthest = 0.0
    for tool in press.way.tools:
        for pair in tool.pairs:
            arms = np.cross(axis, run.evaluation.found[pair].x - point)
            farthest = max(farthest, float(np.linalg.norm(arms, axis=1).max(initial=0.0)))
    farthest = run.model.system.ranks.max(farthest)
    return length / farthest if farthest > 0.0 else length


def way_is_found(model: Model, control: object) -> Press | None:
    """The press that determines this travel; None if it is prescribed."""
    presses = (press for tool in model.tools for press in tool.presses)
    return next((press for press in presses if press.way is control), None)

"""Move a control back until its force is zero or contact is lost."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Self

from umform.analysis.steps.increment import no_convergence, take_increment
from umform.analysis.steps.run_state import Run, Take
from umform.analysis.steps.saved_state import Saved, tightened
from umform.errors import InvalidValue
from umform.model import Evaluation
from umform.model.terms.control import Control
from umform.model.tools.tool_controls import ToolForce, ToolWay
from umform.results.records import Converged, Failed
from umform.spec import check_fields, names_its_words
from umform.spec.types import Duration, Increments, Positive

#: Part of the zero-force tolerance that the residual of an increment may reach.
_PART = 0.1
#: An increment shorter than this part of the distance to the bound is round-off.
_SHORT = 1.0 - 1e-9
#: Following runs have the force of the leading one, up to this part of the force at the beginning, once it is below the
#: second part; the most solutions for it.
_CLOSE, _NEAR_END, _CLOSER = 1e-13, 1e-2, 5
#: Below this part of the force at the beginning it says nothing of where contact is lost. Where the force falls to this
#: part of the last one, that of a tool to the second part, contact is lost; following runs then go back farther, by the
#: third part of the value.
_LEFT, _SNAPPED, _AWAY = 1e-6, 1e-3, 1e-3
#: Force of a tool, relative to that at the beginning, above which the sheet stays in its tools at the end.
_CLAMPED = 1e-3


@names_its_words
@dataclass(frozen=True)
class Release:
    """Retract a displacement or a tool until its force is zero (or contact is lost).

    A force-controlled tool retracts under displacement control; a step :class:`umform.Close` presses it again. The
    column of its control has the required force, zero at the end.

    The increments of a release are solved until the error of the force is a part of the tolerance, even if the
    tolerance of the residual in :class:`umform.NewtonOptions` is looser.

    Examples
    --------
    >>> import umform as uf
    >>> model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=210e3, nu=0.3))
    >>> clamp = model.fix("x0")
    >>> tip = model.prescribe("x1_lower", "z", name="tip")
    >>> result = uf.solve(model, [uf.Move(tip, to=-0.1, steps=2), uf.Release(tip)])
    >>> bool(abs(result["tip_force"][-1]) < 1e-5 * abs(result["tip_force"]).max())
    True
    """

    control: Control
    """A prescribed displacement or a tool motion, or the force on a tool."""
    increment: Positive | None = None
    """First increment; default: 1/1000 of the present value. It doubles while Newton converges easily, up to a
    twentieth of the value."""
    tolerance: Positive = 1e-6
    """Force that counts as zero, relative to the force at the beginning."""
    time: Duration = 1.0
    """Time for the full way back to zero: for rate-dependent metals, and for motions of tools in time."""
    steps: Increments | None = None
    """Number of equal increments of the whole way back to zero, instead of the increment: none is longer, and the last
    ones before zero force are as short as they must be."""

    def __post_init__(self) -> None:
        check_fields(self)
        if self.increment is not None and self.steps is not None:
            raise InvalidValue(
                "a release takes a first increment or a number of steps, and not both",
                where="Release",
                value=f"increment {self.increment:g}, steps {self.steps}",
                cause="both set the first increment",
                remedy="leave one of them out",
            )

    def first(self, value: float) -> float:
        """The first increment of a control with a value."""
        return self.increment or abs(value) / (self.steps or 1000.0)

    def largest(self, value: float) -> float:
        """The largest increment of a control that began with a value."""
        return abs(value) / (self.steps or 20.0)


@dataclass
class Releasing:
    """Secant on force against displacement with saved states; loss of contact is bracketed to 1e-6 of the value. eq.
    (5.14)

    Attributes
    ----------
    start_time, start_value, scale : float
        Time, value of the control and magnitude of its force at the beginning.
    force, size : float
        Present force, and the next increment while the zero is not bracketed.
    before : pair of float, optional
        Value and force of the previous state.
    bound : float, optional
        A value at which the force is zero or has changed its sign.
    finest : float
        Resolution of the distance to the bound: where the force changes sign, only its zero counts.
    taken : float, optional
        The last increment, for the extrapolation.
    failures, attempts : int
        Increments that did not converge, and those beyond zero.
    done : bool
        Whether the force is zero.
    """

    start_time: float
    start_value: float
    scale: float
    force: float
    size: float
    finest: float
    before: Sequence[float] | None = None
    bound: float | None = None
    taken: float | None = None
    failures: int = 0
    attempts: int = 0
    done: bool = False

    @classmethod
    def begin(cls, run: Run, step: Release) -> Self:
        """The loop at the beginning of the step; done if there is nothing to release."""
        if isinstance(step.control, ToolForce):
            run.model.tools.press_of(step.control).held = True
        model, control = run.model, _retracted(run, step)
        evaluation, value = run.evaluation, control.value
        force = control.force(evaluation, model.system.ranks)
        size = -math.copysign(step.first(value), value)
        loop = cls(model.system.time, value, abs(force), force, size, finest=1e-6 * abs(value))
        if value == 0.0 or loop.scale <= 1e-9 * evaluation.force_scale:
            run.result.note(f"step {run.number}: nothing to release, the force of {control.name} is zero")
            loop.done = True
        return loop

    @classmethod
    def recall(cls, run: Run, step: Release, memory: dict[str, Any]) -> Self:
        """The restored loop."""
        return cls(**memory)

    def memory(self) -> dict[str, Any]:
        """State of the loop, for checkpoints."""
        return dict(vars(self))

    def advance(self, run: Run, step: Release) -> None:
        """Try one increment."""
        model, control = run.model, _retracted(run, step)
        before, value = run.evaluation, control.value
        saved, touching = Saved.of(model, before), before.touching(model.system.ranks)
        attempts = run.newton.timing.attempts
        mark = attempts.mark()
        target = _next_release(value, self.force, self.before, self.bound, self.size, self.finest)
        if self.failures and self.bound is None and target != value:
            target = _short_of_zero(value, self.force, self.before, target)
        if target * self.start_value < 0.0:
            target = 0.0
        if target == value or self.attempts > 50:  # the force jumps across zero
            jump = Failed("the zero of the force cannot be closed in", [])
            raise no_convergence(run, jump, [control], [target])
        time = self.start_time + step.time * (1.0 - target / self.start_value)
        extrapolation = None if self.taken is None else (target - value) / self.taken
        try:
            newton = tightened(run, _PART * step.tolerance * self.scale)
            converged = take_increment(run, [target], [control], time, extrapolation, keep=False, newton=newton)
        except Failed as failure:
            self.size, self.taken, self.failures = 0.25 * self.size, None, self.failures + 1
            if self.failures > 20:
                raise no_convergence(run, failure, [control], [target]) from None
            return
        force = control.force(converged.evaluation, model.system.ranks)
        zero = abs(force) <= step.tolerance * self.scale
        lifted = touching and not converged.evaluation.touching(model.system.ranks)
        if lifted:
            lifted = zero = zero or abs(force) <= _hidden(run, before, converged, target - value)
        resolution = 1e-6 * abs(self.start_value)
        if (force * self.force < 0.0 and not zero) or (lifted and abs(target - value) > 2.5 * resolution):
            attempts.take_back(mark, "release beyond zero force")
            self._go_back(run, saved, target, resolution if lifted else 0.0)
            if not lifted:
                self.size, self.before = (target - value) * self.force / (self.force - force), None
            return
        self.before, self.taken, self.force = (value, self.force), target - value, force
        if isinstance(step.control, ToolForce):
            step.control.value = model.tools.press_of(step.control).takes(target, -force)[0]
        self.done = zero or target == 0.0
        if self.bound is None and abs(2.0 * self.size) <= step.largest(self.start_value) and _at_ease(converged):
            self.size *= 2.0
        if self.done:
            how = "contact has lifted off" if lifted else "the force is zero" if zero else "the way back is complete"
            run.result.note(f"step {run.number}: {how} at {control.name} = {control.value:.6g}")
        part = 1.0 if self.done else 1.0 - min(1.0, abs(force) / self.scale)
        name = f"step {run.number}: release"
        run.keep(converged, [control], name=name, fraction=part, frame=run.frames > 0 and self.done)

    def follow(self, run: Run, step: Release, lead: Run, take: Take) -> None:
        """Repeat the last accepted increment of the loop of a leading run: the same part of the way.

        Near the end the force is an equation, eq. (5.163). Where contact is about to be lost it determines no value any
        more: the distance from the leading run then stays. A sheet that other forces keep in its tools loses no
        contact.
        """
        assert isinstance(lead.loop, Releasing)
        model, control, led = run.model, _retracted(run, step), lead.loop
        ranks, led_to, wanted = model.system.ranks, lead.model.controls.named(control.name).value, led.force
        assert led.before is not None
        before, saved = (control.value, self.force), Saved.of(model, run.evaluation)
        way = led_to - led.before[0]
        target, slope = before[0] + way * self.start_value / led.start_value, (wanted - led.before[1]) / way
        held = abs(wanted) > _LEFT * led.scale or not run.evaluation.touching(ranks) or _clamped(run, led.scale)
        held = (held or (led.done and lead.evaluation.touching(ranks))) and slope != 0.0 and led_to != 0.0
        if led.done and led_to == 0.0:  # the way back is complete, in any run
            target = 0.0
        lost = led.done and run.evaluation.touching(ranks) and not _clamped(lead, led.scale)
        retracts = isinstance(control, ToolWay)
        lost = lost and (retracts or not lead.evaluation.touching(ranks))
        part = _SNAPPED if retracts else _LEFT
        if lost and abs(wanted) <= part * abs(led.before[1]):  # it snaps off: no tool near it any more
            held, target = False, target + math.copysign(_AWAY * led.start_value, way)
        near = held and (led.done or abs(wanted) < _NEAR_END * led.scale)
        if near:
            target += (led.before[1] - self.force) / slope
        start = control.value
        for left in reversed(range(_CLOSER if near else 1)):
            try:
                take([target], [control], self.start_time + step.time * (1.0 - target / self.start_value))
                force = control.force(run.evaluation, ranks)
                closer = _secant(before, (target, force), wanted, target)
                if left == 0 or abs(force - wanted) <= _CLOSE * self.scale or closer == target:
                    break
                before, target = (target, force), closer
            except Failed:  # beyond the last contact, perhaps
                if left == 0:
                    raise
                target = 0.5 * (start + target)
            saved.restore(run)
            model.system.evaluate(model.state)  # the blocks for the recovery of enhanced parameters
        self.before, self.force, self.done = before, force, led.done
        if isinstance(step.control, ToolForce):
            step.control.value = model.tools.press_of(step.control).takes(target, -force)[0]

    def _go_back(self, run: Run, saved: Saved, target: float, finest: float) -> None:
        """Restore the state before an increment beyond zero; its end is the new bound."""
        self.bound, self.finest, self.attempts = target, finest, self.attempts + 1
        saved.restore(run)
        self.taken = None


def _retracted(run: Run, step: Release) -> Control:
    """The control to retract: for a force-driven tool its travel, which the step prescribes."""
    control = step.control
    return run.model.tools.press_of(control).way if isinstance(control, ToolForce) else control


def _clamped(run: Run, scale: float) -> bool:
    found, ranks = run.evaluation.found, run.model.system.ranks
    forces = (tool.resultant(found, ranks)[0] for tool in run.model.tools)
    return any(math.hypot(*force) > _CLAMPED * scale for force in forces)


def _secant(one: tuple[float, float], other: tuple[float, float], wanted: float, default: float) -> float:
    """Value with a wanted force on the line through two pairs of value and force; a default for equal forces."""
    slope = other[1] - one[1]
    return other[0] + (wanted - other[1]) * (other[0] - one[0]) / slope if slope != 0.0 else default


def _hidden(run: Run, before: Evaluation, converged: Converged, way: float) -> float:
    """Largest error of the force due to the residual of the increment. docs/theory, 5.7

    Parameters
    ----------
    run : Run
        The run.
    before : Evaluation
        Evaluation of the previous state.
    converged : Converged
        The increment.
    way : float
        Change of the control in the increment.
    """
    model = run.model
    r, dx = model.system.restrict(converged.residual), model.system.coefficients(converged.x - before.x)
    return math.sqrt(model.system.ranks.dot(r, r) * model.system.ranks.dot(dx, dx)) / abs(way)


def _short_of_zero(value: float, force: float, before: Sequence[float] | None, target: float) -> float:
    """The target, or a value just short of the zero of the secant: beyond it contact may be lost."""
    if before is None or before[0] == value or force == before[1]:
        return target
    to_zero = -force * (value - before[0]) / (force - before[1])
    return value + 0.99 * to_zero if 0.0 < to_zero / (target - value) < 1.0 else target


def _at_ease(converged: Converged) -> bool:
    return len(converged.iterations) <= 8


def _next_release(
    value: float, force: float, before: Sequence[float] | None, bound: float | None, size: float, resolution: float
) -> float:
    """Next value of a control on its way to zero force; with a bound, approach the zero from the loaded side."""
    if bound is None:
        return value + size
    sign = 1.0 if bound > value else -1.0
    if abs(bound - value) <= 2.5 * resolution:
        return bound
    if before is None or before[0] == value:  # beyond zero: the size is that of the secant
        return value + size if abs(size) < _SHORT * abs(bound - value) else 0.5 * (value + bound)
    slope = (force - before[1]) / (value - before[0])
    zero = value - force / slope if slope != 0.0 else bound
    if sign * (zero - value) <= 0.0 or sign * (bound - zero) < 0.0:
        zero = 0.5 * (value + bound)
    if abs(zero - value) <= 1.5 * resolution:
        return value + sign * 2.0 * resolution
    return value + 0.99 * (zero - value)

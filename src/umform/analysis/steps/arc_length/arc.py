"""Arc-length continuation through limit points: the load parameter is an unknown, the arc length an equation.

docs/theory, 5.12
"""

from __future__ import annotations

import logging
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal, Self

import numpy as np

from umform.analysis.steps.arc_length.critical import CriticalPoints
from umform.analysis.steps.arc_length.equation import Line
from umform.analysis.steps.arc_length.path import Path
from umform.analysis.steps.increment import last_residuals
from umform.analysis.steps.move import Moved
from umform.analysis.steps.run_state import Run, Take
from umform.analysis.steps.thinned import thinned
from umform.errors import InvalidValue, NoConvergence
from umform.model import Model
from umform.model.terms.control import Control
from umform.results.records import Cause, Failed
from umform.spec import check_fields, names_its_words
from umform.spec.types import Count, Cuts, Duration, Growth, Increments, Share

log = logging.getLogger("umform.arc")


@names_its_words
@dataclass(frozen=True)
class Arc:
    """Follow the equilibrium path while controls move along straight lines, through maxima and minima of the load.

    The load parameter is an unknown. It goes from 0, at the present values of the controls, to 1 at ``to``. It
    decreases where the load does (snap-through), and displacements decrease where they must (snap-back). The step ends
    exactly at the load parameter 1; or after ``most`` increments, or when ``until`` returns True. Time is proportional
    to the length of the path, with ``increment * time`` in the first increment. Limit points and bifurcation points are
    listed in ``result.events``.

    Notes
    -----
    The first increment moves towards ``to``, each later one continues the previous direction: a step that starts beyond
    a limit point may lead back over it. The line search of :class:`umform.NewtonOptions` is not used, because on an arc
    the residual is no measure of an increment.

    Examples
    --------
    A shallow arch, hinged on its mid-line, snaps through under a force that goes down on the way:

    >>> from umform import SVK, Arc, Model, solve
    >>> from umform.mesh import strip
    >>> mesh = strip(10.0, 1.0, 0.2, (8, 1)).transformed(lambda x: x + [0.0, 0.0, 0.5] * (1 - (x[:, :1] / 10.0) ** 2))
    >>> model = Model(mesh, material=SVK(E=1000.0, nu=0.0))
    >>> _ = model.symmetry("x0", "x")
    >>> _ = model.hinge("x1", "xz")
    >>> _ = model.fix(lambda x, y, z: y < y.min() + 1e-9, "y")
    >>> load = model.force("x0", (0.0, 0.0, -0.25), "load")
    >>> result = solve(model, Arc(load, to=1.0, increment=0.002))
    >>> float(result["load"][-1])
    1.0
    """

    control: Moved
    """Loads, pressures, prescribed displacements or tools to move, one or several."""
    to: float | Sequence[float]
    """End value for each control."""
    increment: Share = 0.05
    """First increment of the load parameter, which goes from 0 to 1, along the tangent. It sets the first arc
    length."""
    kind: Literal["cylindrical", "spherical"] = "cylindrical"
    """Length of an increment: of the displacements, or of displacements and load parameter (which weighs as much as the
    displacements in the first increment). eq. (5.22)"""
    iterations: Count = 6
    """Number of iterations to which the arc length is adapted."""
    grow: Growth = 4.0
    """Ratio of the largest arc length to the first."""
    cuts: Cuts = 10
    """How often the first arc length may be halved before the run fails."""
    most: Increments = 200
    """Number of increments at which the step ends with a warning."""
    until: Callable[[Model], bool] | None = None
    """Called with the model after each converged increment; True ends the step."""
    time: Duration = 1.0
    """Time for the path to ``to`` at the rate of the first increment, for rate-dependent metals: the path is followed
    at constant arc-length speed. Near a limit point a control slows down, and moves back behind it."""

    def __post_init__(self) -> None:
        check_fields(self)
        if len(self.targets()) != len(self.moved()) or len(set(self.moved())) != len(self.moved()):
            raise InvalidValue(
                "give one target for each control, and each control once",
                where="Arc, to",
                value=f"{len(self.moved())} controls, {len(self.targets())} targets",
                cause="a list of values that one control takes, or a control that is named twice",
                remedy="a step for each value; a list with one value for each control of a list",
            )
        for target in self.targets():
            if not (np.isscalar(target) and np.isrealobj(target) and np.isfinite(target)):
                raise InvalidValue(
                    "a control is moved to a finite number",
                    where="Arc, to",
                    value=target,
                    cause="a missing value, or a division by zero",
                    remedy="to=1.0",
                )

    def moved(self) -> list[Control]:
        """The controls of the step."""
        return [self.control] if isinstance(self.control, Control) else list(self.control)

    def targets(self) -> list[float]:
        """Their targets."""
        return list(self.to) if isinstance(self.to, Sequence) else [self.to]


@dataclass
class Following:
    """Follow the path with arc lengths that adapt to the iterations. eq. (5.26)

    Attributes
    ----------
    path : Path
        Line of the controls, and the last state on the path.
    critical : CriticalPoints
        Detected limit and bifurcation points.
    length : float
        The next arc length.
    count : int
        Increments so far.
    done : bool
        Whether the step is at its end.
    """

    path: Path
    critical: CriticalPoints
    length: float
    count: int = 0
    done: bool = False

    @classmethod
    def begin(cls, run: Run, step: Arc) -> Self:
        """The loop at the beginning of the step."""
        path = _started(run, step)
        critical = CriticalPoints(run.result, path.line.text, f"step {run.number}")
        critical.advance(path.state)
        return cls(path, critical, path.first)

    @classmethod
    def recall(cls, run: Run, step: Arc, memory: dict[str, Any]) -> Self:
        """The restored loop."""
        line = Line(step.moved(), memory["path"]["starts"], step.targets())
        path = Path.recall(run, line, step.increment, step.time, memory["path"])
        critical = CriticalPoints(run.result, path.line.text, f"step {run.number}")
        critical.recall(path.state, memory["critical"])
        return cls(path, critical, memory["length"], memory["count"], memory["done"])

    def memory(self) -> dict[str, Any]:
        """State of the loop, for checkpoints."""
        return {
            "path": self.path.memory(),
            "critical": self.critical.memory(),
            "length": self.length,
            "count": self.count,
            "done": self.done,
        }

    def advance(self, run: Run, step: Arc) -> None:
        """Try one increment."""
        path = self.path
        tried = path.shortened(self.length)
        try:
            converged = path.advance(tried, run.statistics.yields)
        except Failed as failure:
            run.statistics.count_penetration(kept=False)
            self._cut(run, step, failure, tried)
            return
        if not run.model.system.too_deep(converged.evaluation):
            run.statistics.count_penetration(kept=True)
        run.evaluation = converged.evaluation
        self.count += 1
        fraction = path.state.fraction
        adapted = self.length * min(max(math.sqrt(step.iterations / len(converged.iterations)), 0.5), 2.0)
        self.length = min(adapted, step.grow * path.first)
        self.critical.advance(path.state)
        ended, failed = True, True
        try:
            ended, failed = step.until is not None and step.until(run.model), False
        finally:  # the state counts even if the user's function fails
            self.done = fraction == 1.0 or ended or self.count == step.most
            if self.done and not failed:
                _say_how_it_ended(run, step, run.number, path, ended)
            every = max(1, step.most // run.frames) if run.frames > 0 else 0
            frame = bool(every) and (self.count % every == 0 or self.done)
            part = min(max(fraction, 0.0), 1.0)
            run.keep(converged, step.moved(), name=f"step {run.number}", fraction=part, frame=frame)

    def follow(self, run: Run, step: Arc, lead: Run, take: Take) -> None:
        """Repeat the last accepted increment of the loop of a leading run: on the plane across its path, at its end at
        the same load.
        """
        assert isinstance(lead.loop, Following)
        state, path = lead.loop.path.state, self.path
        self.done, self.count = lead.loop.done, lead.loop.count
        if state.fraction == 1.0:
            path.equation.hold(1.0)
        else:
            path.equation.cross(lead.model.u, state.fraction, state.tangent, state.slope)
        with run.model.system.with_term(path.equation):
            take([], [], lead.model.system.time)
        path.state = replace(state, fraction=path.line.value)

    def _cut(self, run: Run, step: Arc, failure: Failed, tried: float) -> None:
        """Halve an arc length that failed, or end the run."""
        number, path = run.number, self.path
        self.length = 0.5 * tried
        if failure.cause is Cause.CYCLE:
            run.result.warn(f"step {number}, time {run.model.system.time:.4f}: {failure.reason}; the arc length is cut")
        log.info("step %d: %s; arc length cut to %.3g of the first", number, failure.reason, self.length / path.first)
        if self.length < path.first / 2**step.cuts:
            at = path.line.text(path.state.fraction)
            raise _no_convergence(run, failure, f"step {number}, at {at}", path.line) from None


def _say_how_it_ended(run: Run, step: Arc, number: int, path: Path, ended: bool) -> None:
    fraction = path.state.fraction
    if fraction == 1.0:
        return
    at = f"step {number}: the path ends at {path.line.text(fraction)}"
    if ended:
        run.result.note(f"{at}, as asked")
    else:
        run.result.warn(f"{at}, short of its target, after {step.most} increments")


def _started(run: Run, step: Arc) -> Path:
    line = Line(step.moved(), [control.value for control in step.moved()], step.targets())
    try:
        return Path.begin(run, line, step.increment, time=step.time, spherical=step.kind == "spherical")
    except Failed as failure:
        raise _no_convergence(run, failure, f"step {run.number}, at its beginning", line) from None


def _no_convergence(run: Run, failure: Failed, where: str, line: Line) -> NoConvergence:
    cause, remedy = (
        failure.reason,
        (
            "look at the last converged state (it is kept): a path that ends or branches, folded elements, contact "
            "that jumps; else a smaller increment or grow, more iterations in NewtonOptions, more cuts"
        ),
    )
    burst = thinned(run)
    if burst is not None:
        cause, remedy = f"{cause}; {burst[0]}", burst[1]
    largest = _passed(run, line)
    if largest:
        cause = f"{cause}; the path had passed the maximum of the load near {largest}, which is a result"
    return NoConvergence(
        "the path cannot be followed further, not even with the smallest arc length",
        where=where,
        value=last_residuals(failure.iterations),
        cause=cause,
        remedy=remedy,
    )


def _passed(run: Run, line: Line) -> str:
    """The largest load of the step, if the path went back from there; empty otherwise."""
    control, (start, end) = next((one, ends) for one, ends in line.ends.items() if ends[0] != ends[1])
    fractions = [(row[control.name] - start) / (end - start) for row in run.result.rows if row["step"] == run.number]
    largest = max(fractions, default=0.0)
    return line.text(largest) if fractions and fractions[-1] < largest else ""

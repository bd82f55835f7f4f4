"""The path of equilibria along a line of controls: corrections with the load among the unknowns, increments, the end.

docs/theory, 5.12
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.model import Model
from umform.model.control import Control
from umform.solution.bordered import Bordered
from umform.solution.newton import Newton
from umform.solution.records import Converged, Failed
from umform.solution.system import Evaluation
from umform.steps.arc_length.critical import PathState
from umform.steps.loop import Run

Floats = NDArray[np.float64]


class Line:
    """Straight line of the controls; the load parameter says where on it they stand. eq. (5.20)"""

    def __init__(self, controls: Sequence[Control], targets: Sequence[float]) -> None:
        self.ends = {control: (control.value, float(end)) for control, end in zip(controls, targets, strict=True)}
        self.rates = {control: end - start for control, (start, end) in self.ends.items()}
        if not any(self.rates.values()):
            raise InvalidValue(
                "an arc needs a control that moves", value=controls, cause="it stands at its target already"
            )
        self.fraction = 0.0

    def at(self, fraction: float) -> dict[Control, float]:
        """Values of the controls; at 1 they are the targets to the last bit."""
        return {
            c: start + fraction * (end - start) if fraction != 1.0 else end for c, (start, end) in self.ends.items()
        }

    def move(self, fraction: float) -> None:
        """Set the controls."""
        self.fraction = fraction
        for control, value in self.at(fraction).items():
            control.value = value

    def text(self, fraction: float) -> str:
        """The loads in words."""
        return ", ".join(f"{control.name} = {value:.6g}" for control, value in self.at(fraction).items())


class OnArc:
    """The corrector with the load parameter among the unknowns. eqs. (5.23), (5.24)

    Parameters
    ----------
    newton : Newton
        Method and system.
    line : Line
        Controls, at the load parameter of the iteration.
    load_weight : float
        Weight of the load parameter in the arc length, psi^2.
    length : float or None
        Arc length from the converged state; None holds the load parameter.
    """

    line_search = False
    reuses = False  # near a limit point the tangent changes by more than the residual tells

    def __init__(self, newton: Newton, model: Model, line: Line, load_weight: float, length: float | None) -> None:
        self.newton, self.model, self.line = newton, model, line
        self.load_weight, self.length, self.start = load_weight, length, line.fraction
        self.mixed = newton.mixed

    def evaluate(self, u: Floats, *, tangent: bool = True) -> Evaluation:
        """Residual, tangent and rate of the residual with the load parameter. eq. (5.21)"""
        return self.model.evaluate(u, rates=self.line.rates, tangent=tangent)

    def direction(self, solver: Bordered, u: Floats, evaluation: Evaluation) -> Floats:
        """Increment of the displacement; the load parameter takes its own at once. eq. (5.24)"""
        model, line = self.model, self.line
        sides = np.stack([model.restrict(evaluation.residual), model.restrict(evaluation.predictor)], axis=1)
        at_load, along = -solver.solve(sides).T
        change = 0.0
        if self.length is not None:
            since, gone = u - model.u, line.fraction - self.start
            tangent = model.extend(along) + model.displacement_of_supports(line.rates)
            excess = 0.5 * (float(since @ since) + self.load_weight * gone**2 - self.length**2)
            slope = float(since @ tangent) + self.load_weight * gone
            if slope == 0.0:
                raise Failed("the controls do not move the sheet any more; a tool may have lifted off", [])
            change = -(excess + float(since @ model.extend(at_load))) / slope
            line.move(line.fraction + change)
        return model.extend(at_load + change * along) + self.newton.prescribed_increment(u)


class Path:
    """The path from the present state: its last converged state, its first arc length, and how to go on.

    Parameters
    ----------
    run : Run
        Model and method.
    line : Line
        Controls.
    increment : float
        First increment of the load parameter along the tangent.
    spherical : bool
        Whether the load parameter counts in the arc length. eq. (5.22)
    """

    def __init__(self, run: Run, line: Line, increment: float, *, spherical: bool) -> None:
        self.model, self.newton, self.line = run.model, run.newton, line
        self.load_weight = 0.0
        self.start_time, self.increment = run.model.time, increment
        evaluation = self.newton.guarded(lambda: self.model.evaluate(self.model.u, rates=self.line.rates))
        tangent, pivots = self.newton.guarded(lambda: self._tangent(evaluation))
        if spherical:
            self.load_weight = float(tangent @ tangent)
        speed = self._speed(tangent)
        if speed == 0.0:
            raise InvalidValue(
                "the controls of an arc do not move the sheet",
                value=list(line.rates),
                cause="a tool that does not touch it yet, or a load on supports",
                remedy="bring the tool into touch with a Move",
            )
        self.first = increment * speed
        self.state = PathState(0.0, 0.0, tangent, 1.0 / speed, pivots)

    def _speed(self, tangent: Floats) -> float:
        return math.sqrt(float(tangent @ tangent) + self.load_weight)

    def _tangent(self, evaluation: Evaluation) -> tuple[Floats, int | None]:
        """Rate of the displacement with the load parameter, and the negative pivots. eq. (5.25)"""
        self.newton.check_domain(evaluation, [])
        solver = self.newton.ready_solver()
        pivots = solver.factor(evaluation).negative_pivots
        along = -solver.solve(self.model.restrict(evaluation.predictor))
        return self.model.extend(along) + self.model.displacement_of_supports(self.line.rates), pivots

    def shortened(self, length: float) -> float:
        """Length that does not lead far beyond the end of the line."""
        to_end = (1.0 - self.state.fraction) / self.state.slope
        return min(length, 1.05 * to_end) if to_end > 0.0 else length

    def advance(self, length: float) -> Converged:
        """Make an increment of this length and commit it; on failure everything stands as before."""
        model, state, time_before = self.model, self.state, self.model.time
        try:
            converged, new = self.newton.guarded(lambda: self._correct(length))
        except BaseException:  # no convergence, Ctrl-C, a user's function: the last converged state stands
            self.line.move(state.fraction)
            model.time = time_before
            model.revert()
            model.prepare()
            raise
        model.commit(converged.evaluation)
        self.state = new
        return converged

    def _correct(self, length: float) -> tuple[Converged, PathState]:
        """Predict along the tangent (5.25), correct on the arc, and correct at the end if it was passed. eq. (5.23)"""
        model, state, line = self.model, self.state, self.line
        predicted = length * state.slope
        self._set_time(state.arc + length)
        corrector = OnArc(self.newton, model, line, self.load_weight, length)
        line.move(state.fraction + predicted)
        along = model.extend(model.restrict(predicted * state.tangent))
        converged = self.newton.correct(model.u, along + self.newton.prescribed_increment(model.u), corrector)
        if (
            float((converged.x - model.u) @ state.tangent) * predicted
            + self.load_weight * predicted * (line.fraction - state.fraction)
            <= 0.0
        ):
            raise Failed("the path turns back within one increment", converged.iterations)
        if line.fraction >= 1.0:
            converged = self._land(converged, length)
        tangent, pivots = self._tangent(converged.evaluation)
        du, change = converged.x - model.u, line.fraction - state.fraction
        ahead = float(du @ tangent) + self.load_weight * change
        arc = math.sqrt(float(du @ du) + self.load_weight * change**2)
        slope = math.copysign(1.0 / self._speed(tangent), ahead)
        return converged, PathState(line.fraction, state.arc + arc, tangent, slope, pivots)

    def _land(self, beyond: Converged, length: float) -> Converged:
        """Go back from a state beyond the end of the line to the end, at a fixed load."""
        model, state, line = self.model, self.state, self.line
        part = (1.0 - state.fraction) / (line.fraction - state.fraction)
        self._set_time(state.arc + part * length)
        line.move(1.0)
        back = model.extend(model.restrict((part - 1.0) * (beyond.x - model.u)))
        corrector = OnArc(self.newton, model, line, self.load_weight, None)
        landed = self.newton.correct(beyond.x, back + self.newton.prescribed_increment(beyond.x), corrector)
        if float(np.linalg.norm(landed.x - model.u)) > 1.5 * length:
            raise Failed("the last increment jumps off the path", landed.iterations)
        return Converged(landed.evaluation, beyond.iterations + landed.iterations)

    def _set_time(self, arc: float) -> None:
        self.model.time = self.start_time + self.increment * arc / self.first

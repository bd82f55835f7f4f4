"""The equilibrium path along a line of controls: increments of a given arc length, and the end of the line.

docs/theory, 5.12
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from umform.analysis.newton.growing_penalties import within_allowed
from umform.analysis.newton.newton import Newton
from umform.analysis.newton.options import IterationMode
from umform.analysis.newton.system import Evaluation
from umform.analysis.steps.arc_length.critical import PathState
from umform.analysis.steps.arc_length.equation import ArcLength, Line
from umform.analysis.steps.run_state import Run
from umform.errors import InvalidValue
from umform.model import Model
from umform.model.terms.state import State
from umform.results.records import Converged, Failed
from umform.solvers import Factorisation

Floats = NDArray[np.float64]


@dataclass
class Path:
    """The path from the present state: its last converged state, its first arc length, and the next increments.

    The load parameter is an unknown of the model only while an increment is corrected.

    Attributes
    ----------
    model, newton
        The model and the method.
    equation : ArcLength
        Equation of the load parameter.
    increment : float
        First increment of the load parameter along the tangent.
    start_time : float
        Time at the beginning of the step.
    time : float
        Time for the path to the end of the line at the rate of the first increment.
    first : float
        First arc length.
    state : PathState
        The last converged state.
    """

    model: Model
    newton: Newton
    equation: ArcLength
    increment: float
    start_time: float
    time: float
    first: float
    state: PathState

    @classmethod
    def begin(cls, run: Run, line: Line, increment: float, *, time: float, spherical: bool) -> Self:
        """The path from the present state.

        Parameters
        ----------
        run : Run
            Model and method.
        line : Line
            The load parameter and what it moves.
        increment : float
            First increment of the load parameter along the tangent.
        time : float
            Time for the path to the end of the line at the rate of the first increment.
        spherical : bool
            Whether the load parameter counts in the arc length. eq. (5.22)
        """
        model, nothing = run.model, PathState(0.0, 0.0, np.empty(0), 0.0, None)
        path = cls(model, run.newton, ArcLength(line), increment, model.system.time, time, 0.0, nothing)
        with model.system.with_term(path.equation):
            evaluation = path.newton.guarded(lambda: model.system.evaluate(model.system.x))
            tangent, found = path.newton.guarded(lambda: path._tangent(evaluation))
        rate = tangent / tangent[-1]
        if spherical:
            path.equation.load_weight = path._product(rate, rate)
        speed = math.sqrt(path._product(rate, rate))
        if speed == 0.0:
            raise InvalidValue(
                "the controls of an arc do not move the sheet",
                value=list(line.rates),
                cause="a tool that does not touch it yet, or a load on supports",
                remedy="bring the tool into touch with a Move",
            )
        path.first = increment * speed
        path.state = PathState(0.0, 0.0, rate[:-1] / speed, 1.0 / speed, found.negative_pivots, found.odd)
        return path

    @classmethod
    def recall(cls, run: Run, line: Line, increment: float, time: float, memory: dict[str, Any]) -> Self:
        """The restored path."""
        state = PathState(**memory["state"])
        line.value = state.fraction
        starts = memory["start_time"], time, memory["first"]
        path = cls(run.model, run.newton, ArcLength(line), increment, *starts, state)
        path.equation.load_weight = memory["load_weight"]
        return path

    def memory(self) -> dict[str, Any]:
        """State of the path, for checkpoints."""
        return {
            "starts": [start for start, _ in self.line.ends.values()],
            "load_weight": self.equation.load_weight,
            "start_time": self.start_time,
            "first": self.first,
            "state": vars(self.state),
        }

    @property
    def line(self) -> Line:
        """The load parameter and what it moves."""
        return self.equation.line

    def shortened(self, length: float) -> float:
        """Arc length limited to a little beyond the end of the line."""
        to_end = (1.0 - self.state.fraction) / self.state.slope
        return min(length, 1.05 * to_end) if to_end > 0.0 else length

    def advance(self, length: float, yields: bool) -> Converged:
        """Make an increment of this length and commit it; after a failure the previous state is restored.

        ``yields``: whether it may exceed the allowed penetration rather than fail.
        """
        model = self.model
        penalties = model.system.penalties
        try:
            with model.system.with_term(self.equation):
                with self.newton.timing.attempts.trying("arc"):
                    converged, state = self.newton.guarded(lambda: self._correct(length, yields))
                model.system.commit(converged.evaluation)
        except BaseException:  # no convergence, Ctrl-C, an error of a user's function: restore the last converged state
            model.system.use_penalties(penalties)
            model.system.revert()
            model.system.prepare()
            raise
        self.state = state
        return converged

    def _correct(self, length: float, yields: bool) -> tuple[Converged, PathState]:
        """Correct on the arc, and at the end of the line if it was passed. eq. (5.23)"""
        x, state = self.model.system.x, self.state
        keeping = partial(within_allowed, self.model, self.newton, yields=yields, mode=self._mode)
        converged = keeping(self._on_arc(length), lambda: self._on_arc(length))
        if converged.x[-1] >= 1.0:
            converged = keeping(self._land(converged, length), lambda: self._land(self._on_arc(length), length))
        dx, fraction = converged.x - x, float(converged.x[-1])
        tangent, found = self._tangent(converged.evaluation)
        tangent *= math.copysign(1.0 / math.sqrt(self._product(tangent, tangent)), self._product(dx, tangent))
        arc = state.arc + math.sqrt(self._product(dx, dx))
        signs = found.negative_pivots, found.odd
        return converged, PathState(fraction, arc, tangent[:-1], float(tangent[-1]), *signs)

    def _on_arc(self, length: float) -> Converged:
        """Predict along the tangent (5.25), and correct on the arc."""
        x, state = self.model.system.x, self.state
        goal = self._goal(state.arc + length)
        self.equation.ask(length, self.model.u)
        ahead = np.append(state.tangent, state.slope)
        dx = self.model.system.extend(
            self.model.system.coefficients(length * ahead)
        ) + self.newton.prescribed_increment(goal, x)
        converged = self.newton.correct(goal, x, dx, self._mode)
        if self._product(converged.x - x, ahead) <= 0.0:
            raise Failed("the path turns back within one increment", converged.iterations)
        return converged

    def _land(self, beyond: Converged, length: float) -> Converged:
        """Go back from a state beyond the end of the line to the end, at a fixed load."""
        x, state = self.model.system.x, self.state
        part = (1.0 - state.fraction) / float(beyond.x[-1] - state.fraction)
        goal = self._goal(state.arc + part * length)
        self.equation.hold(1.0)
        back = (part - 1.0) * (beyond.x - x)
        back[-1] = 1.0 - beyond.x[-1]
        back, at_end = self.model.system.extend(self.model.system.coefficients(back)), beyond.x.copy()
        at_end[-1], back[-1] = 1.0, 0.0  # to the last bit
        landed = self.newton.correct(goal, at_end, back, self._mode)
        if float(np.linalg.norm((landed.x - x)[: self.model.u.size])) > 1.5 * length:
            raise Failed("the last increment jumps off the path", landed.iterations)
        return replace(landed, iterations=beyond.iterations + landed.iterations, passes=beyond.passes)

    def _tangent(self, evaluation: Evaluation) -> tuple[Floats, Factorisation]:
        """Tangent of the path, the load parameter last, and the signs of the pivots. eq. (5.25)"""
        self.newton.check_domain(evaluation, [])
        solver, along = self.newton.ready_solver(), np.zeros_like(evaluation.x)
        found = solver.factor(evaluation)
        along[-1] = 1.0
        return self.model.system.extend(solver.solve(self.model.system.restrict(along))), found

    def _product(self, one: Floats, other: Floats) -> float:
        """Inner product of displacements and load parameters that defines the arc length. eq. (5.22)"""
        dofs = self.model.u.size
        return float(one[:dofs] @ other[:dofs]) + self.equation.load_weight * float(one[-1] * other[-1])

    @property
    def _mode(self) -> IterationMode:
        """Near a limit point the residual is no measure of an increment, and the tangent changes strongly."""
        return IterationMode(line_search=False, mixed=self.newton.mixed)

    def _goal(self, arc: float) -> State:
        """The converged state at the time of another length of the path."""
        return self.model.state.toward({}, self.start_time + self.time * self.increment * arc / self.first)

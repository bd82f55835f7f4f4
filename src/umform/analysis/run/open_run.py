"""A run with interactive steps and branches: it may return to an earlier state."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from umform.analysis.newton.options import NewtonOptions
from umform.analysis.newton.strategy_statistics import StrategyStatistics
from umform.analysis.run.checked import checked, needs_model
from umform.analysis.run.execute import OnIncrement
from umform.analysis.run.result import Result
from umform.analysis.run.run_steps import begun, taken
from umform.analysis.steps import Step
from umform.analysis.steps.trail import Trail
from umform.errors import InvalidValue
from umform.model import Evaluation, Model
from umform.model.terms.state import Snapshot
from umform.progress import Tick, silent
from umform.results.drift import warn_of_drift
from umform.results.history import FRAMES
from umform.results.history import Mark as HistoryMark
from umform.results.imbalance import warn_of_imbalance
from umform.results.penetration import warn_of_contact
from umform.results.records import Iteration
from umform.results.untouched import warn_of_untouched
from umform.results.volume_warning import warn_of_volume
from umform.solvers.protocol import Remembering
from umform.timing import new_timing

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Mark:
    """A state between two steps to which a run can return.

    Attributes
    ----------
    snapshot : Snapshot
        State of the model.
    before : dict of str to ndarray
        Input histories of the evaluation there.
    steps : list of Step
        Steps up to this state.
    trail : Trail or None
        Last increments, for the extrapolation.
    history : HistoryMark
        The corresponding part of the result.
    factors : int or None
        State of the sparse solver.
    statistics : StrategyStatistics
        Statistics of earlier increments that select the first strategy.
    result : Result
        Result of the run.
    """

    snapshot: Snapshot
    before: dict[str, Floats]
    steps: list[Step]
    trail: Trail | None
    history: HistoryMark
    factors: int | None
    statistics: StrategyStatistics
    result: Result


class OpenRun:
    """A run whose steps are chosen as it proceeds: take a step, mark a state, go back to it.

    Its result equals that of `umform.solve` with its steps to the last bit. docs/open-run.md

    Parameters
    ----------
    model : Model
        The model.
    solver : str
        Sparse solver of one process.
    options : NewtonOptions, optional
        Tolerances, line search, predictor.
    frames : int
        Approximate number of states kept for pictures in each step.
    on_increment : callable, optional
        As that of :func:`umform.solve`.

    Attributes
    ----------
    result : Result
        History and frames of the steps up to the present state.
    steps : list of Step
        These steps.
    iterations : int
        Newton iterations of all steps, including those of other branches.

    Examples
    --------
    Loads of two directions from one state:

    >>> import umform as uf
    >>> model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=210e3, nu=0.3))
    >>> clamp = model.fix("x0")
    >>> tip = model.prescribe("x1_lower", "z", name="tip")
    >>> run = uf.OpenRun(model)
    >>> run.take(uf.Move(tip, to=-0.1, steps=2))
    >>> bent = run.mark()
    >>> run.take(uf.Move(tip, to=-0.2, steps=2))
    >>> run.go_back(bent)
    >>> run.take(uf.Move(tip, to=0.0, steps=2))
    >>> [round(float(value), 3) for value in run.close()["tip"]]
    [0.0, -0.05, -0.1, -0.05, 0.0]
    """

    def __init__(
        self,
        model: Model,
        *,
        solver: str = "auto",
        options: NewtonOptions | None = None,
        frames: int = FRAMES,
        on_increment: OnIncrement | None = None,
    ) -> None:
        needs_model(model)
        timing = new_timing()
        with timing.run:
            self.result = Result(model, timing)
            self._run = begun(self.result, solver, options, frames)
            self._run.call(on_increment)
        self.steps: list[Step] = []
        self.iterations = 0
        self._run.newton.callbacks.append(self._count)

    def _count(self, iteration: Iteration) -> None:
        self.iterations += 1

    @property
    def evaluation(self) -> Evaluation:
        """The evaluation of the present state."""
        return self._run.evaluation

    def take(self, *steps: Step, tick: Tick = silent) -> None:
        """Execute more steps from the present state.

        Raises
        ------
        NoConvergence
            If an increment fails at its smallest size; like any exception that ends a step, it has the results so far
            as its attribute ``result``.
        """
        run = self._run
        self.steps += checked(run.model, list(steps))
        self.result.complete()
        whole = self.result.timing.run
        with whole:
            taken(run, self.steps, tick)
        whole.calls = 1  # all steps form one run

    def mark(self) -> Mark:
        """The present state, to which the run can return."""
        run, solver = self._run, self._run.newton.ready_solver().solver.solver
        factors = solver.memory() if isinstance(solver, Remembering) else None
        before = {term.key: term.before for term in run.model.system.terms if term.before.size > 0}
        return Mark(
            run.model.system.snapshot(),
            before,
            list(self.steps),
            run.trail,
            self.result.mark(),
            factors,
            replace(run.statistics),
            self.result,
        )

    def go_back(self, mark: Mark) -> None:
        """Return to a state of any branch, with its steps and result.

        Raises
        ------
        InvalidValue
            The mark is none of this run.
        """
        if not isinstance(mark, Mark) or mark.result is not self.result:
            raise InvalidValue(
                "a run goes back to a mark of its own",
                where="go_back",
                value=type(mark).__name__,
                cause="it belongs to another run, or is none",
                remedy="what mark() of this run returned",
            )
        run, solver = self._run, self._run.newton.ready_solver().solver.solver
        run.model.system.restore(mark.snapshot)
        run.evaluation = run.model.system.repeat(mark.before)
        run.trail, run.loop, run.number = mark.trail, None, len(mark.steps) + 1
        if isinstance(solver, Remembering) and mark.factors is not None:
            solver.recall(mark.factors)
        run.statistics = replace(mark.statistics)
        self.result.go_back(mark.history)
        self.result.complete()
        self.steps = list(mark.steps)

    def close(self) -> Result:
        """The result of the steps, with the warnings of the end of a run."""
        warn_of_contact(self._run.model, self.result)
        warn_of_untouched(self._run.model, self.result)
        warn_of_drift(self._run.model, self.result)
        warn_of_imbalance(self.result, self._run.newton.options.residual)
        warn_of_volume(self._run.model, self.result)
        return self.result

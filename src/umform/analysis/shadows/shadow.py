"""A shadow: a run of a slightly different problem that repeats the increments of another run. docs/theory, 5.17"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.analysis.newton.bordered import Bordered
from umform.analysis.newton.criteria import EPS
from umform.analysis.newton.shift import Shift
from umform.analysis.newton.strategies import Increment, equilibrium
from umform.analysis.run.checkpoint import memory_of, recall
from umform.analysis.run.run_steps import loop_for
from umform.analysis.steps import Step
from umform.analysis.steps.run_state import Run
from umform.errors import NotFinite, SingularMatrix, UmformError
from umform.model import Evaluation, Model, State
from umform.model.equations.changed_forces import changed_residual
from umform.model.terms.control import Control, OnDofs
from umform.model.tools.tool_controls import ToolWay
from umform.results.records import Converged, Failed

Floats = NDArray[np.float64]

#: Error of the displacement of a shadow relative to its distance from the reference: that of a derivative.
TOLERANCE = 1e-6
#: Largest residual of a shadow relative to the forces.
_SMALL = 1e-9
#: Residual relative to the difference of driving forces from those of the reference; and the residual relative to the
#: forces below which it is not asked for.
_OF_DIFFERENCE, _ENOUGH = 1e-6, 1e-12
#: Residual relative to the forces that is round-off; below another one, a residual that hardly falls is.
_EXACT, _ROUND_OFF, _STAYS = 1e-13, 1e-9, 0.3
#: Corrections with the factors of the reference; all corrections after which the same points touch and slide.
_CORRECTIONS, _MOST = 5, 20
#: Relative difference of residuals two corrections apart below which they alternate between two states.
_CYCLE = 1e-6
#: Residual, relative to the forces, up to which a run that fails is solved with a line search; a shadow is then at most
#: this part of the thickness from the reference.
_NEAR, _FAR = 1e-6, 0.01
#: Largest number of passes of multipliers.
_PASSES = 10


@dataclass(frozen=True)
class Factors:
    """Factors of the tangent of the reference at the end of an increment; its model, and its unknowns and residual."""

    solver: Bordered
    model: Model
    x: Floats
    residual: float
    forces: Floats

    def suffice(self, norms: Sequence[float], x: Floats, du: Floats, forces: Floats, scale: float) -> bool:
        """Whether residual and next correction of a shadow are small parts of its distance from the reference.

        Parameters
        ----------
        norms : sequence of float
            Residuals so far, relative to the scale; each correction reduces the next one like the residual.
        x, du : ndarray, shape (3 n + k,)
            Unknowns, and the last correction.
        forces : ndarray
            Forces that drive supports and tools: a residual changes them by its own size.
        scale : float
            Scale of the forces.
        """
        if norms[-1] <= 2.0 * self.residual:
            return True
        difference = float(np.abs(forces - self.forces).max(initial=0.0)) / scale
        if len(norms) < 2 or norms[-1] > min(norms[-2], _SMALL, max(_OF_DIFFERENCE * difference, _ENOUGH)):
            return False
        following = float(np.abs(du).max()) * norms[-1] / norms[-2]
        return following <= TOLERANCE * float(np.abs(x - self.x).max())


@dataclass(frozen=True)
class Guess:
    """Predicted increment: displacement, scalar unknowns by name, and enhanced parameters of each body."""

    u: Floats
    scalars: dict[str, float]
    enhanced: list[Floats]

    def x(self, model: Model) -> Floats:
        """The increment of the present unknowns of a model; zero for those that were none before."""
        return np.concatenate([self.u, [self.scalars.get(one.name, 0.0) for one in model.system.unknowns]])


@dataclass
class Kept:
    """Results that a shadow has stored so far.

    Attributes
    ----------
    residual : float
        Largest residual of an increment, relative to the forces.
    switched : list of int
        For each row of the history: points of the metal and of contacts in another state than in the reference.
    own : int
        Increments with factors of its own.
    lost : str
        Why its numbers are unknown from a row on; empty if they are known.
    from_row : int
        That row.
    """

    residual: float = 0.0
    switched: list[int] = field(default_factory=lambda: [0])
    own: int = 0
    lost: str = ""
    from_row: int = -1


class Shadow:
    """A run that repeats the accepted increments of a leading run.

    Parameters
    ----------
    run : Run
        The run at its first state.
    steps : sequence of Step
        Its steps, of the same kinds as those of the leading run.

    Attributes
    ----------
    kept : Kept
        Residuals, points that switched.
    """

    def __init__(self, run: Run, steps: Sequence[Step]) -> None:
        self.run, self.steps, self.kept = run, steps, Kept()
        run.number, run.loop = 0, None
        self.evaluation, self.residual = run.evaluation, 0.0
        #: Its last increment less that of the reference.
        self.ahead: Guess | None = None
        system = run.model.system
        first = system.evaluate(system.state)  # with blocks for the recovery of enhanced parameters
        round_off = EPS * system.largest_entry(first.values) * system.extent * math.sqrt(system.pattern.n)
        #: Largest forces so far, or those whose smallest part is the round-off of positions.
        self.scale = max(round_off / _ROUND_OFF, first.force_scale)

    def memory(self) -> dict[str, Any]:
        """Its state, for checkpoints."""
        ahead = None if self.ahead is None else vars(self.ahead)
        return {"run": memory_of(self.run), "kept": vars(self.kept), "ahead": ahead, "scale": self.scale}

    def recall(self, memory: Mapping[str, Any]) -> None:
        """Restore its state."""
        kept, run = memory["kept"], self.run
        loop, self.scale = recall(run, memory["run"]), memory["scale"]
        self.kept = Kept(**{**kept, "switched": [int(count) for count in kept["switched"]]})
        self.ahead = None if memory["ahead"] is None else Guess(**memory["ahead"])
        self.evaluation = run.evaluation = run.evaluation.without_tangent()
        if loop is not None and not self.kept.lost:
            step = self.steps[run.number - 1]
            run.loop = loop_for(step).recall(run, step, loop)

    def at_step(self, number: int) -> Step:
        """Begin the steps up to the present one."""
        while self.run.number < number:
            self.run.number += 1
            step = self.steps[self.run.number - 1]
            self.run.loop = loop_for(step).begin(self.run, step)
        return self.steps[number - 1]

    def stiffen_like(self, growth: Sequence[float]) -> None:
        """Penalties that have grown like those of the leading run."""
        for contact, factor in zip(self.run.model.system.penalised, growth, strict=True):
            contact.use_penalty(factor * contact.initial_penalty)

    def lose(self, why: str, row: int) -> None:
        """Its numbers are unknown from a row of the history on."""
        self.kept.lost, self.kept.from_row = why, row

    def increment(
        self,
        values: Sequence[float],
        controls: Sequence[Control],
        time: float,
        guess: Guess,
        factors: Factors | None,
        passes: int | None,
    ) -> int:
        """One increment to new values of the controls; returns the number of passes of the multipliers.

        Parameters
        ----------
        values, controls, time
            The end of the increment.
        guess : Guess
            Predicted increment.
        factors : Factors, optional
            Those of the reference; without them the run has its own in each iteration.
        passes : int, optional
            Passes of the multipliers; default: as many as the allowed penetration needs.

        Raises
        ------
        Failed
            If it does not converge; the previous state is restored.
        """
        run, system = self.run, self.run.model.system
        targets = {control.name: float(value) for control, value in zip(controls, values, strict=True)}
        goal = system.state.toward(targets, time)
        u = goal.x.copy()
        du = run.newton.prescribed_increment(goal, u) + system.extend(system.coefficients(guess.x(run.model)))
        try:
            evaluation = self._solved(goal, u, du, factors, guess)
            done = 0
            for done in range(_PASSES if passes is None else passes):
                if passes is None and not self._loose(evaluation, first=done == 0):
                    break
                evaluation = self._augmented(goal, evaluation, factors)
            else:
                done = _PASSES if passes is None else passes
        except (SingularMatrix, NotFinite) as error:
            system.revert()
            raise Failed(str(error), []) from error
        except BaseException as error:
            system.revert()
            if passes and factors is not None and isinstance(error, Failed):  # as the reference does
                self.kept.own += 1
                return self.increment(values, controls, time, guess, None, passes)
            raise
        system.commit(evaluation)
        self.evaluation, run.evaluation = evaluation, evaluation.without_tangent()
        return done

    def _solved(self, goal: State, u: Floats, du: Floats, factors: Factors | None, guess: Guess) -> Evaluation:
        """Equilibrium from ``u + du``.

        A run that does not get there by the factors of the reference takes its own: where the reference is free of its
        tools, and this run not yet, they are those of a sheet that nothing holds. Then it begins with a line search,
        and at last like the run.
        """
        system, newton = self.run.model.system, self.run.newton
        missed: Failed | None = None
        for given in [None] if factors is None else [factors, None]:
            try:
                found = self._correct(goal, u, du, given, guess)
            except Failed as failure:
                missed = missed or failure
                system.revert()
            else:
                self.kept.own += missed is not None
                return found
        assert missed is not None
        system.prepare(goal)
        rough = newton.but(residual=_NEAR)
        try:
            near = rough.solve(goal, du, newton.mode(friction=True))
        except Failed:
            run, controls = self.run, tuple(self.run.model.controls)
            system.prepare(goal)
            last = run.evaluation
            near = equilibrium(Increment(run.model, rough, run.statistics, goal, controls, None, last, grows=False))
        found = self._correct(goal, near.x, np.zeros_like(u), None)
        if factors is not None:
            if float(np.abs(found.x - factors.x).max()) > _FAR * system.thickness:  # on another branch
                raise missed
            self.kept.own += 1
        return found

    def _augmented(self, goal: State, evaluation: Evaluation, factors: Factors | None) -> Evaluation:
        """Equilibrium after a pass of the multipliers; without factors of the reference with a line search first."""
        model, newton = self.run.model, self.run.newton
        parts = {contact: np.zeros(model.u.size) for contact in model.system.multiplied}
        for contact, part in parts.items():
            contact.augment(evaluation.found[contact], part)
        if factors is None:
            change = changed_residual(model.system, evaluation, parts)
            evaluation = newton.but(residual=_NEAR).go_on(Converged(evaluation, [], goal), change).evaluation
        return self._correct(goal, evaluation.x, np.zeros_like(evaluation.x), factors)

    def _loose(self, evaluation: Evaluation, *, first: bool) -> bool:
        pairs = [one for one in self.run.model.system.multiplied if evaluation.found[one].active.any()]
        return bool(pairs) and (first or any(one.loose(evaluation.found[one]) for one in pairs))

    def _correct(
        self, goal: State, u: Floats, du: Floats, given: Factors | None, guess: Guess | None = None
    ) -> Evaluation:
        """Equilibrium from ``u + du``, to round-off; or nearly so, with the factors of the reference. eq. (5.162)"""
        run, system = self.run, self.run.model.system
        norms: list[float] = []
        before: NDArray[np.uint8] | None = None
        fronts = 0  # corrections after which other points touch or slide
        while True:
            forces = given is not None and len(norms) < _CORRECTIONS and not system.unknowns
            if guess is not None and not norms:
                system.recover_by(guess.enhanced)
            else:
                system.recover(du)
            if given is not None and forces and not norms:
                system.take_blocks(given.model.system)
            evaluation = system.evaluate(system.state_at(u + du, goal), tangent=not forces)
            if forces:
                system.follow()
            run.newton.check_domain(evaluation, [])
            r = system.restrict(evaluation.residual)
            scale = max(self.scale, evaluation.force_scale)
            norms.append(math.sqrt(system.ranks.dot(r, r)) / scale)
            if _exact(norms) or (
                given is not None and given.suffice(norms, evaluation.x, du, forces_of(run.model, evaluation), scale)
            ):
                self.scale = scale
                self.residual = norms[-1]
                self.kept.residual = max(self.kept.residual, norms[-1])
                return evaluation
            now = evaluation.status
            switching = np.zeros(now.shape, dtype=bool) if before is None else now != before
            fronts, before = fronts + int(switching.any()), now
            if len(norms) - min(fronts, now.size) > _MOST or not math.isfinite(norms[-1]) or _cycles(norms):
                raise Failed(_not_solved(norms, evaluation.at_points(switching)), [])
            if given is not None and len(norms) <= _CORRECTIONS:
                solver = given.solver
            else:
                self.kept.own += given is not None and len(norms) == _CORRECTIONS + 1
                solver = factored(run, evaluation)
            u, du = evaluation.x, system.extend(solver.solve(-r))


def factored(run: Run, evaluation: Evaluation) -> Bordered:
    """Factors of a tangent; of that of a sheet which no tool holds any more with small springs, eq. (5.54).

    Such a sheet is in equilibrium by itself, so that the springs have no force and change no solution.
    """
    solver = run.newton.ready_solver()
    try:
        solver.factor(evaluation)
    except SingularMatrix:
        Shift(run.model.system).factor(solver, evaluation)
    return solver


def reason(failure: Failed | UmformError) -> str:
    """Why an increment failed, in one line."""
    return failure.reason if isinstance(failure, Failed) else str(failure).splitlines()[0]


def forces_of(model: Model, evaluation: Evaluation) -> Floats:
    """Forces that drive supports and tools."""
    driven = (control for control in model.controls if isinstance(control, OnDofs | ToolWay))
    return np.array([control.force(evaluation, model.system.ranks) for control in driven])


def _cycles(norms: Sequence[float]) -> bool:
    """Whether corrections alternate between two states."""
    if len(norms) < 5:
        return False
    a, b, c, d = norms[-4:]
    return abs(a - c) <= _CYCLE * c and abs(b - d) <= _CYCLE * d and min(c, d) > _ROUND_OFF


def _not_solved(norms: Sequence[float], where: str) -> str:
    """Why corrections end, and where points still come into contact, or leave it, stick or slide, as text."""
    ended = "they alternate between two states" if _cycles(norms) else "no convergence"
    still = f"; contact still changes{where}" if where else ""
    return f"{ended} after {len(norms)} corrections, residual {norms[-1]:.1e}{still}"


def _exact(norms: Sequence[float]) -> bool:
    """Whether the last residual is that of round-off."""
    norm = norms[-1]
    return norm <= _EXACT or (len(norms) > 2 and norm <= _ROUND_OFF and norm > _STAYS * norms[-2])

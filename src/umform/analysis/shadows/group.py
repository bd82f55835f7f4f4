"""A run with its shadows: a reference that is solved to round-off, and one shadow a parameter. docs/theory, 5.17"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run.execute import prepared_steps, resume_followed, solve_followed
from umform.analysis.run.fingerprint import fingerprint, text
from umform.analysis.run.result import Result
from umform.analysis.run.run_steps import ready
from umform.analysis.shadows.shadow import Factors, Guess, Kept, Shadow, factored, forces_of, reason
from umform.analysis.shadows.structure import other_structure
from umform.analysis.steps import Step
from umform.analysis.steps.run_state import Run
from umform.errors import InvalidValue, UmformError
from umform.model import Model
from umform.model.terms.control import Control
from umform.results.history import FRAMES
from umform.results.records import Failed

Floats = NDArray[np.float64]
#: A model and its steps.
Built = tuple[Model, Sequence[Step]]


@dataclass(frozen=True)
class Shadowed:
    """A run and its shadows.

    Attributes
    ----------
    run : Result
        The run.
    reference : Result
        The same, solved to round-off on the increments of the run.
    shadows : dict of object to Result
        A run for each changed parameter.
    kept : dict of object to Kept
        What each of them has kept.
    missing : str
        Why the reference, and with it all shadows, are unknown from a row on; empty if they are known.
    """

    run: Result
    reference: Result
    shadows: dict[Any, Result]
    kept: dict[Any, Kept]
    missing: str = ""


class Shadows:
    """Shadows that follow a run, increment by increment; the reference comes first."""

    def __init__(self, lead: Run, reference: Shadow, others: Sequence[Shadow]) -> None:
        self.reference, self.others = reference, others
        self._lead = _Unknowns.of(lead.model)
        self._last: Guess | None = None
        self.level = True

    def mark(self) -> str:
        """Text that identifies their input."""
        runs = [(one.run, one.steps) for one in (self.reference, *self.others)]
        return text([fingerprint(run.model, steps, run.newton, run.frames) for run, steps in runs])

    def memory(self) -> dict[str, Any]:
        """Their state, for checkpoints."""
        last = None if self._last is None else vars(self._last)
        others = [one.memory() for one in self.others]
        return {"reference": self.reference.memory(), "others": others, "last": last}

    def recall(self, lead: Run, memory: dict[str, Any]) -> None:
        """Restore their state, beside a leading run that is restored already."""
        self._lead = _Unknowns.of(lead.model)
        self._last = None if memory["last"] is None else Guess(**memory["last"])
        for one, tree in zip((self.reference, *self.others), (memory["reference"], *memory["others"]), strict=True):
            one.recall(tree)

    def follow(self, lead: Run, *, frame: bool) -> None:
        """Repeat the increment that the leading run has accepted."""
        self.level = False
        before, self._lead = self._lead, _Unknowns.of(lead.model)
        if not self.reference.kept.lost:
            self._follow(lead, before, frame=frame)
        self.level = True

    def _follow(self, lead: Run, before: _Unknowns, *, frame: bool) -> None:
        growth = [contact.penalty / contact.initial_penalty for contact in lead.model.system.penalised]
        reference, model = self.reference, self.reference.run.model
        start, change = _Unknowns.of(model), self._lead.since(before)
        try:
            stay = any(contact.multipliers_stay for contact in lead.model.system.multiplied)
            passes = _repeat(reference, lead, growth, change, None, [0] if stay else None, frame=frame)
            solver = factored(reference.run, reference.evaluation)
        except (Failed, UmformError) as failure:
            for one in (reference, *self.others):
                one.lose(f"the run has no solution to round-off there, {reason(failure)}", len(lead.result) - 1)
            return
        forces = forces_of(model, reference.evaluation)
        factors = Factors(solver, model, reference.evaluation.x, reference.residual, forces)
        made = _Unknowns.of(model).since(start)
        ratio, self._last = _ratio(self._last, made), made
        for shadow in (one for one in self.others if not one.kept.lost):
            guess = made if ratio is None or shadow.ahead is None else _sum(made, ratio, shadow.ahead)
            start = _Unknowns.of(shadow.run.model)
            try:
                _repeat(shadow, lead, growth, guess, factors, passes, frame=frame)
            except (Failed, UmformError) as failure:
                shadow.lose(reason(failure), len(lead.result) - 1)
            else:
                shadow.kept.switched.append(_switched(shadow, reference))
                own = _Unknowns.of(shadow.run.model).since(start)
                shadow.ahead = _sum(own, -1.0, made)

    def end(self) -> None:
        """Begin the last steps, in which there was nothing to do."""
        for one in (self.reference, *self.others):
            if not one.kept.lost:
                one.at_step(len(one.steps))


@dataclass(frozen=True)
class _Unknowns:
    """Displacement, scalar unknowns by name, and enhanced parameters of a model."""

    u: Floats
    scalars: dict[str, float]
    enhanced: list[Floats]

    @classmethod
    def of(cls, model: Model) -> Self:
        """Those of the converged state."""
        scalars = {unknown.name: unknown.value for unknown in model.system.unknowns}
        return cls(model.u.copy(), scalars, model.system.enhanced)

    def since(self, before: Self) -> Guess:
        """Their change; zero for unknowns that were none before."""
        scalars = {name: value - before.scalars.get(name, value) for name, value in self.scalars.items()}
        enhanced = [one - other for one, other in zip(self.enhanced, before.enhanced, strict=True)]
        return Guess(self.u - before.u, scalars, enhanced)


def _sum(one: Guess, factor: float, other: Guess) -> Guess:
    scalars = {name: value + factor * other.scalars.get(name, 0.0) for name, value in one.scalars.items()}
    enhanced = [a + factor * b for a, b in zip(one.enhanced, other.enhanced, strict=True)]
    return Guess(one.u + factor * other.u, scalars, enhanced)


def _ratio(last: Guess | None, change: Guess) -> float | None:
    """An increment relative to the last one; None if their directions differ."""
    if last is None:
        return None
    size = float(last.u @ last.u)
    ratio = float(last.u @ change.u) / size if size > 0.0 else 0.0
    return ratio if ratio > 0.0 and ratio * ratio * size > 0.25 * float(change.u @ change.u) else None


def _repeat(
    shadow: Shadow,
    lead: Run,
    growth: Sequence[float],
    guess: Guess,
    factors: Factors | None,
    passes: Sequence[int] | None,
    *,
    frame: bool,
) -> list[int]:
    """One increment of a shadow, in several solutions if its end is an equation; passes of multipliers of each."""
    run, step = shadow.run, shadow.at_step(lead.number)
    shadow.stiffen_like(growth)
    counts: list[int] = []

    def take(values: Sequence[float], controls: Sequence[Control], time: float) -> None:
        given = None if passes is None else passes[min(len(counts), len(passes) - 1)]
        counts.append(shadow.increment(values, controls, time, guess, factors, given))

    assert run.loop is not None
    run.loop.follow(run, step, lead, take)
    run.result.add(run.evaluation, [], step=lead.number, frame=frame)
    return counts


def _switched(shadow: Shadow, reference: Shadow) -> int:
    """Points of the metal and of contacts that are in another state than in the reference."""
    one, other = shadow.run.evaluation, reference.run.evaluation
    return int((one.status != other.status).sum() + (one.flowing != other.flowing).sum())


def solve_with_shadows(
    lead: Built,
    reference: Built,
    shadows: Mapping[Any, Built],
    *,
    solver: str = "auto",
    options: NewtonOptions | None = None,
    frames: int = FRAMES,
    **rest: Any,
) -> Shadowed:
    """Solve a model, and beside it the same model to round-off and slightly different ones.

    Parameters
    ----------
    lead, reference : tuple of Model and steps
        The run, and the same built once more.
    shadows : mapping of object to tuple of Model and steps
        The problem with one parameter changed a little, each with the same mesh topology, tools and steps.
    solver, options, frames, **rest
        See :func:`umform.solve`; the checkpoint has the state of all runs.

    Raises
    ------
    InvalidValue
        If the solver is that of many ranks.
    """
    group = _Group(reference, shadows, solver, options, frames)
    return group.ended(solve_followed(*lead, group, solver=solver, options=options, frames=frames, **rest))


def resume_with_shadows(
    path: str | PathLike[str],
    lead: Built,
    reference: Built,
    shadows: Mapping[Any, Built],
    *,
    solver: str = "auto",
    options: NewtonOptions | None = None,
    frames: int = FRAMES,
    **rest: Any,
) -> Shadowed:
    """Continue a run and its shadows from their checkpoint; the results have the bits of uninterrupted ones.

    Parameters
    ----------
    path : str or PathLike
        The checkpoint.
    lead, reference, shadows, solver, options, frames
        Those of :func:`solve_with_shadows`, built again.
    **rest
        See :func:`umform.resume`.
    """
    group = _Group(reference, shadows, solver, options, frames)
    return group.ended(resume_followed(path, *lead, group, solver=solver, options=options, frames=frames, **rest))


class _Group:
    """Makes the shadows of a run when it is ready, and collects what they have found."""

    def __init__(
        self,
        reference: Built,
        shadows: Mapping[Any, Built],
        solver: str,
        options: NewtonOptions | None,
        frames: int,
    ) -> None:
        if solver == "petsc":
            raise InvalidValue(
                "shadows run in one process",
                where="solver",
                value=solver,
                cause="the shadows of a run on many ranks are not written",
                remedy="solver='auto', without mpiexec",
            )
        self._builds, self._names = [reference, *shadows.values()], list(shadows)
        self._options: tuple[str, NewtonOptions | None, int] = (solver, options, frames)
        self._made: list[Shadow] = []
        self._results: list[Result] = []
        self._shadows: Shadows | None = None

    def __call__(self, run: Run) -> Shadows:
        """The shadows of a run."""
        frames = self._options[-1]
        for name, (model, steps) in zip(("reference", *self._names), self._builds, strict=True):
            sequence, result = prepared_steps(model, steps), Result(model)
            cause = "" if not self._made else other_structure(run.model, self._made[0].steps, model, sequence)
            _refuse_another(name, run.model, model, cause)
            own = ready(result, *self._options, sequence)
            result.add(own.evaluation, [], frame=frames > 0)
            self._made.append(Shadow(own, sequence))
            self._results.append(result)
        self._shadows = Shadows(run, self._made[0], self._made[1:])
        return self._shadows

    def ended(self, run: Result) -> Shadowed:
        """All results after the run."""
        assert self._shadows is not None
        self._shadows.end()
        kept = dict(zip(self._names, (one.kept for one in self._made[1:]), strict=True))
        shadows = dict(zip(self._names, self._results[1:], strict=True))
        return Shadowed(run, self._results[0], shadows, kept, self._made[0].kept.lost)


def _refuse_another(name: Any, lead: Model, model: Model, cause: str) -> None:
    """Refuse a shadow of another structure, or one whose model is that of the run."""
    if model is lead or cause:
        raise InvalidValue(
            "a shadow needs the elements, controls, contacts and steps of its run, in a model of its own",
            where=f"shadow {name}",
            value=cause or "the model of the run",
            cause="their number follows from the changed parameter" if cause else "one model for several runs",
            remedy="give the numbers of elements and steps; a new model in each call",
        )

"""A run with its shadows: a reference that is solved to round-off, and one shadow a parameter. docs/theory, 5.17"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run.execute import prepared_steps, solve_followed
from umform.analysis.run.going import ready
from umform.analysis.run.result import Result
from umform.analysis.shadows.shadow import Factors, Guess, Kept, Shadow
from umform.analysis.steps import Step
from umform.analysis.steps.loop import Run
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
    """

    run: Result
    reference: Result
    shadows: dict[Any, Result]
    kept: dict[Any, Kept]


class Shadows:
    """Shadows that follow a run, increment by increment; the reference comes first."""

    def __init__(self, lead: Run, reference: Shadow, others: Sequence[Shadow]) -> None:
        self.reference, self.others = reference, others
        self._first = [contact.penalty for contact in lead.model.contacts]
        self._lead = _Unknowns.of(lead.model)
        self._last: Guess | None = None

    def follow(self, lead: Run, *, frame: bool) -> None:
        """Repeat the increment that the leading run has accepted."""
        reference, before = self.reference, self._lead
        self._lead = _Unknowns.of(lead.model)
        penalties = zip(lead.model.contacts, self._first, strict=True)
        growth = [contact.penalty / first if first else 1.0 for contact, first in penalties]
        model, change = reference.run.model, partial(self._lead.since, before)
        before = _Unknowns.of(model)
        passes = _repeat(reference, lead, growth, change, None, None, frame=frame)
        solver = reference.run.newton.ready_solver()
        solver.factor(reference.evaluation)
        factors = Factors(solver, reference.evaluation.x, reference.residual)
        made = _Unknowns.of(model).since(before, model)
        ratio, self._last = _ratio(self._last, made), made
        for shadow in (one for one in self.others if not one.kept.lost):
            guess = made if ratio is None or shadow.ahead is None else _sum(made, ratio, shadow.ahead)
            start = _Unknowns.of(shadow.run.model)
            try:
                _repeat(shadow, lead, growth, guess, factors, passes, frame=frame)
            except Failed as failure:
                shadow.kept.lost, shadow.kept.from_row = failure.reason, len(reference.run.result) - 1
            else:
                shadow.kept.switched.append(_switched(shadow, reference))
                own = _Unknowns.of(shadow.run.model).since(start, shadow.run.model)
                shadow.ahead = _sum(own, -1.0, made)


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

    def since(self, before: Self, model: Model) -> Guess:
        """Their change, in the order of the unknowns of a model; zero for unknowns that were none before."""
        names = [unknown.name for unknown in model.system.unknowns]
        scalars = [self.scalars.get(n, 0.0) - before.scalars.get(n, self.scalars.get(n, 0.0)) for n in names]
        enhanced = [one - other for one, other in zip(self.enhanced, before.enhanced, strict=True)]
        return Guess(np.concatenate([self.u - before.u, scalars]), enhanced)


def _sum(one: Guess, factor: float, other: Guess) -> Guess:
    enhanced = [a + factor * b for a, b in zip(one.enhanced, other.enhanced, strict=True)]
    return Guess(one.x + factor * other.x, enhanced)


def _ratio(last: Guess | None, change: Guess) -> float | None:
    """An increment relative to the last one; None if their unknowns differ, or their directions."""
    if last is None or last.x.shape != change.x.shape:
        return None
    size = float(last.x @ last.x)
    ratio = float(last.x @ change.x) / size if size > 0.0 else 0.0
    return ratio if ratio > 0.0 and ratio * ratio * size > 0.25 * float(change.x @ change.x) else None


def _repeat(
    shadow: Shadow,
    lead: Run,
    growth: Sequence[float],
    guess: Guess | Callable[[Model], Guess],
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
        counts.append(
            shadow.increment(
                values, controls, time, guess if isinstance(guess, Guess) else guess(run.model), factors, given
            )
        )

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
        See :func:`umform.solve`.
    """
    made: list[Shadow] = []
    results: list[Result] = []

    def follower(run: Run) -> Shadows:
        for model, steps in (reference, *shadows.values()):
            sequence = prepared_steps(model, steps)
            own_result = Result(model)
            own = ready(own_result, solver, options, frames, sequence)
            own_result.add(own.evaluation, [], frame=frames > 0)
            made.append(Shadow(own, sequence))
            results.append(own_result)
        return Shadows(run, made[0], made[1:])

    result = solve_followed(lead[0], lead[1], follower, solver=solver, options=options, frames=frames, **rest)
    for one in made:
        one.at_step(len(one.steps))
    kept = dict(zip(shadows, (one.kept for one in made[1:]), strict=True))
    return Shadowed(result, results[0], dict(zip(shadows, results[1:], strict=True)), kept)

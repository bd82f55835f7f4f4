"""Where Newton's method starts an increment from, and what is tried in turn when it fails."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from umform.model import Model
from umform.model.control import Control
from umform.solution.newton import Newton
from umform.solution.records import Converged, Failed
from umform.solution.softening import softened

Floats = NDArray[np.float64]


def equilibrium(
    model: Model, newton: Newton, before: Mapping[Control, float], time: float, guess: Floats | None
) -> Converged:
    """Equilibrium at the present values of the controls, from the first start that leads there. docs/theory, 4.13

    The extrapolation, then the tangent, then the consistent tangent throughout, which may cross a sudden change of
    shape where the mixed one of (5.39) does not; with contact a line search, for where one row of points holds the
    sheet a full step may lose it; and softer penalties, for a stiff tool may come to where nothing touched before.
    """
    touches = bool(model.contacts)
    if guess is not None and newton.options.extrapolate:
        try:
            return newton.solve(guess)
        except Failed:  # it may have gone too far
            pass
    ways = [(False, False)]  # whether the tangent is consistent, and whether a line is searched
    if newton.mixed:
        ways.append((True, False))
    if touches and not newton.options.line_search:
        ways.append((True, True))
    failures = []
    for consistent, search in ways:
        try:
            start = _tangent(model, newton, before, time) if touches else None
            return newton.solve(start, line_search=search, consistent=consistent)
        except Failed as failure:
            failures.append(failure)
    failures[-1].singular = any(failure.singular for failure in failures)
    if not touches:
        raise failures[-1]
    try:
        return softened(model, newton, _tangent(model, newton, before, time))
    except Failed:
        raise failures[-1] from None  # what fails is the increment with the penalty of the user


def _tangent(model: Model, newton: Newton, before: Mapping[Control, float], time: float) -> Floats | None:
    """Increment along the tangent of the last converged state: the sheet follows the tools that touch it. eq. (4.36)

    None where nothing holds the sheet there but a tool that is still to come.
    """
    after, time_after = {control: control.value for control in before}, model.time
    rates = {control: after[control] - value for control, value in before.items()}

    def increment() -> Floats:
        evaluation = model.evaluate(model.x, rates=rates, until=time_after)
        newton.check_domain(evaluation, [])
        solver = newton.ready_solver()
        solver.factor(evaluation)
        return model.extend(solver.solve(-model.restrict(evaluation.residual + evaluation.predictor)))

    _put(before, time, model)
    try:
        return newton.guarded(increment)
    except Failed:
        return None
    finally:
        _put(after, time_after, model)


def _put(values: Mapping[Control, float], time: float, model: Model) -> None:
    for control, value in values.items():
        control.value = value
    model.time = time

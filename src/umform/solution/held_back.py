"""Equilibrium by way of a sheet that is held back by springs: for increments behind which equilibrium jumps.

Where the last point of contact of a piece of the sheet lets go, the path of equilibria may end, and the next one is a
finite way off. Springs that hold the sheet where it has got to make that way one of many short ones.
docs/theory, 4.14
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.model import Evaluation, Model
from umform.solution.newton import Newton
from umform.solution.records import Converged, Failed

Floats = NDArray[np.float64]
log = logging.getLogger("umform.contact")

#: Stiffness of the springs at first, over the largest entry of the tangent.
_FIRST = 1e-5
#: Springs that were too weak are made stiffer by this factor; where the ways get shorter, weaker by that one.
_STIFFER, _WEAKER = 10.0, 0.5
#: Times that the springs may fail, and ways from one place to the next.
_FAILURES, _WAYS = 4, 60
#: Springs are never weaker than this part of what they were at first.
_LEAST = 1e-2
#: The sheet has arrived where it moves by less than this part of its thickness.
_ARRIVED = 1e-3


class HeldBack:
    """A model with springs at all nodes, as Newton's method sees it; all else is that of the model.

    Parameters
    ----------
    model : Model
        The model.

    Attributes
    ----------
    stiffness : float
        Of the spring of each unknown.
    origin : ndarray, shape (3 n,)
        Displacement at which the springs have no force.
    """

    def __init__(self, model: Model) -> None:
        self.model, self.stiffness, self.origin = model, 0.0, model.u.copy()

    def __getattr__(self, name: str) -> Any:
        return getattr(self.model, name)

    def evaluate(self, x: Floats, *given: Any, **how: Any) -> Evaluation:
        """Residual and tangent of the model with those of the springs."""
        evaluation = self.model.evaluate(x, *given, **how)
        residual = evaluation.residual.copy()
        residual[: self.origin.size] += self.forces(evaluation.u)
        values = evaluation.values
        if values.size:
            values = values.copy()
            values[self.model.own_diagonal] += self.stiffness
        return replace(evaluation, residual=residual, values=values)

    def forces(self, u: Floats) -> Floats:
        """Forces of the springs, shape (3 n,); of a node that several ranks have, on its owner."""
        forces, owned = np.zeros((u.size // 3, 3)), self.model.owned
        forces[owned] = self.stiffness * (u - self.origin).reshape(-1, 3)[owned]
        return forces.ravel()


def held_back(
    model: Model, newton: Newton, start: Callable[[], Floats | None], accept: Callable[[Converged], Converged]
) -> Converged:
    """Find the equilibrium with springs, let them follow the sheet until it rests, and take them away.

    Parameters
    ----------
    model : Model
        With the controls and the time of the increment.
    newton : Newton
        Method.
    start : callable
        Guess of the increment, or None.
    accept : callable
        Returns an equilibrium, or raises Failed.

    Raises
    ------
    Failed
        If it does not lead to an equilibrium; the model is reverted.
    """
    springs = HeldBack(model)
    stiffness = _FIRST * model.largest_entry(model.evaluate(model.x).values)
    for again in reversed(range(_FAILURES)):
        springs.stiffness = stiffness
        try:
            converged, change = _followed(springs, newton, start())
            break
        except Failed:
            if not again:
                raise
            stiffness *= _STIFFER
            model.prepare()
    return accept(_joined(converged, newton.go_on(converged, change)))


def _followed(springs: HeldBack, newton: Newton, start: Floats | None) -> tuple[Converged, Floats]:
    """Where the sheet comes to rest, and what the residual changes by as the springs go. eqs. (4.150), (4.151)"""
    model, before, first = springs.model, np.inf, springs.stiffness
    springs.origin = model.u.copy()
    with _through(newton, springs):
        converged = newton.solve(start)
        for ways in range(1, _WAYS + 1):
            u = converged.evaluation.u
            change = np.concatenate([-springs.forces(u), np.zeros(len(model.unknowns))])
            far = model.ranks.max(float(np.abs(u - springs.origin).max()))
            if far <= _ARRIVED * model.thickness:
                log.info("equilibrium jumps: springs hold the sheet back on %d ways", ways)
                return converged, change
            springs.origin = u.copy()
            springs.stiffness *= _WEAKER if far < before and springs.stiffness > _LEAST * first else 1.0
            before = far
            converged = _joined(converged, newton.go_on(converged, change))
    raise Failed("the sheet does not come to rest on springs that follow it", converged.iterations)


def _joined(before: Converged, now: Converged) -> Converged:
    return replace(now, iterations=before.iterations + now.iterations)


@contextmanager
def _through(newton: Newton, springs: HeldBack) -> Iterator[None]:
    """Let Newton's method see the springs."""
    newton.system = springs
    try:
        yield
    finally:
        newton.system = springs.model

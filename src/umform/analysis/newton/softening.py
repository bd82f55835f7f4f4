"""Continuation in the penalty, from a soft to the full one, for increments that fail otherwise."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace

import numpy as np

from umform.analysis.newton.newton import Newton
from umform.analysis.newton.options import IterationMode
from umform.model import Model
from umform.model.contact import Contact
from umform.model.contact.sheets import SheetContact
from umform.model.equations.changed_forces import changed_residual
from umform.model.terms.state import State
from umform.results.records import Cause, Converged, Failed

log = logging.getLogger("umform.contact")

#: Powers of ten by which the penalty is reduced at first: the second if the first is still too stiff.
_SOFTER = (3, 6)


def softened(
    model: Model,
    newton: Newton,
    goal: State,
    start: Callable[[], Converged],
    accept: Callable[[Converged], Converged],
    mode: IterationMode | None = None,
    *,
    touched: bool = False,
) -> Converged:
    """Find the equilibrium with a reduced penalty, and increase it tenfold at a time. docs/theory, 4.14

    Parameters
    ----------
    model : Model
        With contacts.
    newton : Newton
        Method.
    goal : State
        The goal of the increment.
    start : callable
        Finds the equilibrium with the present penalties of the contacts.
    accept : callable
        Returns an equilibrium, or raises Failed: with a soft tool the sheet may pass through it.
    mode : IterationMode, optional
        Mode of the iterations; default: from the options.
    touched : bool
        Whether the sheet touches a tool in the converged state. If so, the first penalty is soft enough, and the second
        is tried only if contact was lost.

    Returns
    -------
    Converged
        With the iterations for all penalties.

    Raises
    ------
    Failed
        If no softer penalty leads to the equilibrium; the model and its penalties are restored.
    """
    soft, softest = _SOFTER
    try:
        return accept(_stiffened(model, newton, start, soft, mode))
    except Failed as failure:
        if touched and failure.cause is not Cause.SINGULAR:
            raise
        model.system.prepare(goal)
        return accept(_stiffened(model, newton, start, softest, mode))


def _stiffened(
    model: Model, newton: Newton, start: Callable[[], Converged], powers: int, mode: IterationMode | None
) -> Converged:
    """Equilibrium with 10^-powers of the penalty, then with ten times as much, up to the full one. eq. (4.39)"""
    with _own_penalties(model) as penalties:
        for contact, penalty in penalties.items():
            contact.use_penalty(10.0**-powers * penalty)
        converged = start()
        for power in range(powers - 1, -1, -1):
            evaluation = converged.evaluation
            parts = {contact: np.zeros(model.u.size) for contact in penalties}
            for contact, penalty in penalties.items():
                contact.stiffen(evaluation.found[contact], 10.0**-power * penalty, parts[contact])
            change = changed_residual(model.system, evaluation, parts)
            again = newton.go_on(converged, change, mode)
            converged = replace(again, iterations=converged.iterations + again.iterations)
    log.debug("    by way of softer penalties, %d iterations", len(converged.iterations))
    return converged


@contextmanager
def _own_penalties(model: Model) -> Iterator[dict[Contact | SheetContact, float]]:
    """The penalties of the contacts, restored at the end in any case."""
    penalties = model.system.penalties
    try:
        yield penalties
    finally:
        model.system.use_penalties(penalties)

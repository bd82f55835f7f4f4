"""Equilibrium with a stiff penalty by way of softer ones, for increments that Newton's method does not make at once."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace

import numpy as np

from umform.model import Model
from umform.model.changed_forces import changed_residual
from umform.model.contact import Contact
from umform.solution.newton import Newton
from umform.solution.options import Manner
from umform.solution.records import Cause, Converged, Failed

log = logging.getLogger("umform.contact")

#: Powers of ten by which the penalty is softened at first: the second where the first is still too stiff.
_SOFTER = (3, 6)


def softened(
    model: Model,
    newton: Newton,
    start: Callable[[], Converged],
    accept: Callable[[Converged], Converged],
    manner: Manner | None = None,
    *,
    touched: bool = False,
) -> Converged:
    """Find the equilibrium with a part of the penalty, and stiffen it tenfold at a time. docs/theory, 4.14

    Parameters
    ----------
    model : Model
        With the controls and the time of the increment, and contacts.
    newton : Newton
        Method.
    start : callable
        The equilibrium with the penalties that the contacts have when it is asked.
    accept : callable
        Returns an equilibrium, or raises Failed: while a tool is soft the sheet may go through it.
    manner : Manner, optional
        How to iterate; default: as the options say.
    touched : bool
        Whether the sheet touches a tool in the converged state. If so, the first penalty is hardly too stiff, and the
        second is tried only where the contact was lost.

    Returns
    -------
    Converged
        With the iterations of all penalties.

    Raises
    ------
    Failed
        If no softer penalty leads to the equilibrium; the model is reverted, with its penalties.
    """
    soft, softest = _SOFTER
    try:
        return accept(_stiffened(model, newton, start, soft, manner))
    except Failed as failure:
        if touched and failure.cause is not Cause.SINGULAR:
            raise
        model.prepare()
        return accept(_stiffened(model, newton, start, softest, manner))


def _stiffened(
    model: Model, newton: Newton, start: Callable[[], Converged], powers: int, manner: Manner | None
) -> Converged:
    """Equilibrium with 10^-powers of the penalty, then with ten times as much, up to all of it. eq. (4.39)"""
    with _own_penalties(model) as penalties:
        for contact, penalty in penalties.items():
            contact.penalty = 10.0**-powers * penalty
        converged = start()
        for power in range(powers - 1, -1, -1):
            evaluation = converged.evaluation
            parts = {contact: np.zeros(model.u.size) for contact in penalties}
            for contact, penalty in penalties.items():
                contact.stiffen(evaluation.found[contact], 10.0**-power * penalty, parts[contact])
            change = changed_residual(model, evaluation, parts)
            again = newton.go_on(converged, change, manner)
            converged = replace(again, iterations=converged.iterations + again.iterations)
    log.debug("    by way of softer penalties, %d iterations", len(converged.iterations))
    return converged


@contextmanager
def _own_penalties(model: Model) -> Iterator[dict[Contact, float]]:
    """The penalties of the contacts, which they have again at the end, whatever happens."""
    penalties = {contact: contact.penalty for contact in model.contacts}
    try:
        yield penalties
    finally:
        for contact, penalty in penalties.items():
            contact.penalty = penalty

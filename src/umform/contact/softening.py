"""Equilibrium with a stiff penalty by way of softer ones, for increments that Newton's method does not make at once."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from umform.newton import Converged, Newton

if TYPE_CHECKING:
    from umform.model import Model

log = logging.getLogger("umform.contact")

#: Parts of the penalty that come before it.
_SOFTER = (1e-3, 1e-2, 1e-1)


def softened(model: Model, newton: Newton, start: NDArray[np.float64] | None) -> Converged:
    """Find the equilibrium with a thousandth of the penalty, then stiffen it tenfold at a time. eq. (4.38)

    Parameters
    ----------
    model : Model
        At its last converged state, with controls and time of the increment.
    newton : Newton
        Method.
    start : ndarray, shape (3 n,), optional
        Guess of the increment.

    Raises
    ------
    Failed
        If a penalty on the way does not converge; the model is reverted.
    """
    with _own_penalties(model) as penalties:
        _set(model, _SOFTER[0], penalties)
        converged = newton.solve(start)
        for part in (*_SOFTER[1:], 1.0):
            change = np.zeros_like(converged.u)
            for contact, penalty in zip(model.contacts, penalties, strict=True):
                contact.stiffen(part * penalty, change)
            again = newton.go_on(converged, change)
            converged = replace(again, iterations=converged.iterations + again.iterations)
    log.debug("    by way of softer penalties, %d iterations", len(converged.iterations))
    return converged


def _set(model: Model, part: float, penalties: list[float]) -> None:
    for contact, penalty in zip(model.contacts, penalties, strict=True):
        contact.penalty = part * penalty


@contextmanager
def _own_penalties(model: Model) -> Iterator[list[float]]:
    """The penalties of the contacts, which they have again at the end, whatever happens."""
    penalties = [contact.penalty for contact in model.contacts]
    try:
        yield penalties
    finally:
        _set(model, 1.0, penalties)

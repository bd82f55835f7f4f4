"""Equilibrium with a stiff penalty by way of softer ones, for increments that Newton's method does not make at once."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from umform.model import Model
from umform.model.contact import Contact
from umform.solution.newton import Converged, Failed, Newton

log = logging.getLogger("umform.contact")

#: Powers of ten by which the penalty is softened at first: the second where the first is still too stiff.
_SOFTER = (3, 6)


def softened(model: Model, newton: Newton, start: NDArray[np.float64] | None) -> Converged:
    """Find the equilibrium with a part of the penalty, and stiffen it tenfold at a time. docs/theory, 4.14

    Parameters
    ----------
    model : Model
        With the controls and the time of the increment, and contacts; its last evaluation was at ``model.u``.
    newton : Newton
        Method.
    start : ndarray, shape (3 n,), optional
        Guess of the increment; without it that of the tangent.

    Returns
    -------
    Converged
        With the iterations of all penalties.

    Raises
    ------
    Failed
        If no softer penalty leads to the equilibrium, or the sheet went through a tool on the way; the model is
        reverted, with its penalties.
    """
    soft, softest = _SOFTER
    before = [contact.block.normals.copy() for contact in model.contacts]
    try:
        return _same_side(model, before, _stiffened(model, newton, start, soft))
    except Failed:
        model.evaluate(model.u)  # the enhanced parameters of the next try are recovered with the blocks of this state
    return _same_side(model, before, _stiffened(model, newton, start, softest))


def _same_side(model: Model, before: list[NDArray[np.float64]], converged: Converged) -> Converged:
    """Refuse an equilibrium for which the sheet went through a tool while that was soft: normals have turned round."""
    pairs = zip(before, model.contacts, strict=True)
    if model.ranks.any(any((np.einsum("qk,qk->q", old, contact.block.normals) < 0.0).any() for old, contact in pairs)):
        model.revert()
        raise Failed("with a softer penalty the sheet goes through a tool", converged.iterations)
    return converged


def _stiffened(model: Model, newton: Newton, start: NDArray[np.float64] | None, powers: int) -> Converged:
    """Equilibrium with 10^-powers of the penalty, then with ten times as much, up to all of it. eq. (4.39)"""
    with _own_penalties(model) as penalties:
        for contact, penalty in penalties.items():
            contact.penalty = 10.0**-powers * penalty
        converged = newton.solve(start)
        for power in range(powers - 1, -1, -1):
            change = np.zeros_like(converged.u)
            for contact, penalty in penalties.items():
                contact.stiffen(10.0**-power * penalty, change)
            again = newton.go_on(converged, change)
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

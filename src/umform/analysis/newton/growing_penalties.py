"""Penalties that grow in a run, so that every result keeps the allowed penetration. docs/theory, 4.11"""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from umform.analysis.newton.newton import Newton
from umform.analysis.newton.options import IterationMode
from umform.model import Model
from umform.model.equations.changed_forces import changed_residual
from umform.results.records import Converged, Failed

log = logging.getLogger("umform.contact")

#: Largest number of passes; the history has the remaining penetration.
_PASSES = 10
#: Part of the allowed penetration that a larger penalty aims at; its largest growth in a pass, tried in this order.
_AIM, _GROWTHS = 0.85, (30.0, 2.0)


def within_allowed(
    model: Model,
    newton: Newton,
    converged: Converged,
    again: Callable[[], Converged],
    yields: bool,
    mode: IterationMode | None = None,
) -> Converged:
    """Equilibrium with penalties that keep the allowed penetration.

    Parameters
    ----------
    model : Model
        At ``converged``, not yet committed.
    newton : Newton
        The method, converged.
    converged : Converged
        Equilibrium with the present penalties.
    again : callable
        Finds it again from the state before the increment.
    yields : bool
        Whether the increment may exceed the allowed penetration rather than fail.
    mode : IterationMode, optional
        Mode of the iterations; default: from the options.

    Raises
    ------
    Failed
        If a pass does not converge, and the increment may not exceed the allowed penetration.
    """
    penalties = model.system.penalties
    for growth in _GROWTHS:
        if not model.system.too_deep(converged.evaluation):
            break
        try:
            with newton.timing.attempts.trying("stiffer penalties"):
                return _grown(model, newton, converged, growth, mode)
        except Failed:
            model.system.use_penalties(penalties)
            if not yields:  # a smaller increment is nearer to its pressures
                raise
            model.system.prepare(converged.goal)
            converged = again()
    return converged


def _grown(model: Model, newton: Newton, converged: Converged, growth: float, mode: IterationMode | None) -> Converged:
    """Increase the penalties of contacts beyond their allowed penetration, and iterate, until none is. eq. (4.200)

    Parameters
    ----------
    model : Model
        At ``converged``, not yet committed.
    newton : Newton
        The method, converged.
    converged : Converged
        Equilibrium with the present penalties.
    growth : float
        Largest growth of a penalty in a pass.
    mode : IterationMode, optional
        Mode of the iterations.

    Raises
    ------
    Failed
        If a pass does not converge; the model is reverted, but not its penalties.
    """
    mode = mode or newton.mode()
    for number in range(1, _PASSES + 1):
        found = converged.evaluation.found
        excess = model.system.too_deep(converged.evaluation)
        if not excess:
            break
        parts = {contact: np.zeros(model.u.size) for contact in excess}
        for contact, part in parts.items():
            grown = min(excess[contact] / _AIM, growth) * contact.penalty
            contact.stiffen(found[contact], min(grown, contact.largest_penalty), part)
        change = converged.evaluation.residual + changed_residual(model.system, converged.evaluation, parts)
        again = newton.go_on(converged, change, replace(mode, grows=number < _PASSES))
        converged = replace(converged, evaluation=again.evaluation, passes=converged.passes + again.iterations)
        log.debug("    pass %d of the penalties, %d iterations", number, len(again.iterations))
    return converged


def relaxed(model: Model) -> bool:
    """Reset grown penalties, also those that have grown in a stage before; whether there were any."""
    grown = [
        contact for contact in model.system.penalised if contact.penalty > contact.softest_penalty and contact.adapts
    ]
    for contact in grown:
        contact.use_penalty(contact.softest_penalty)
    return bool(grown)

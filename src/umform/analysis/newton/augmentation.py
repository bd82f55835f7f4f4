"""Augmented Lagrangian method (Uzawa): multipliers remove the penetration of a penalty solution."""

from __future__ import annotations

import logging
from dataclasses import replace

import numpy as np

from umform.analysis.newton.newton import Newton
from umform.model import Model
from umform.model.equations.changed_forces import changed_residual
from umform.results.records import Converged

log = logging.getLogger("umform.contact")

#: Largest number of passes; the history has the remaining penetration.
_PASSES = 10


def augmented(model: Model, newton: Newton, converged: Converged) -> Converged:
    """Update the multipliers and iterate until no point exceeds the allowed penetration. eq. (4.34)

    Parameters
    ----------
    model : Model
        At ``converged``, not yet committed.
    newton : Newton
        The method, converged.
    converged : Converged
        Equilibrium with the present multipliers.

    Raises
    ------
    Failed
        If a pass does not converge; the model is reverted, with its multipliers.
    """
    for number in range(1, _PASSES + 1):
        found = converged.evaluation.found
        pairs = [contact for contact in model.system.multiplied if _anywhere(model, found[contact].active.any())]
        if not pairs or (number > 1 and not _anywhere(model, any(contact.loose(found[contact]) for contact in pairs))):
            break
        parts = {contact: np.zeros(model.u.size) for contact in pairs}
        for contact, part in parts.items():
            contact.augment(found[contact], part)
        change = changed_residual(model.system, converged.evaluation, parts)
        again = newton.go_on(converged, change)
        converged = replace(converged, evaluation=again.evaluation, passes=converged.passes + again.iterations)
        log.debug("    pass %d of the multipliers, %d iterations", number, len(again.iterations))
    return converged


def _anywhere(model: Model, flag: bool | np.bool_) -> bool:
    return model.system.ranks.any(bool(flag))

"""Reject an equilibrium in which the sheet has passed through a tool, or through another sheet."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.model import Evaluation, Model
from umform.model.contact.found import ContactFound
from umform.model.contact.sheets import SheetContact
from umform.results.records import Cause, Converged, Failed

#: Largest distance, relative to the thickness, by which a point slides over a sharp edge in one increment.
_OVER_AN_EDGE = 0.5


def same_side(model: Model, last: Evaluation, converged: Converged) -> Converged:
    """The equilibrium, if no contact point has passed through a tool or a sheet. docs/theory, 4.15, 4.21

    A point has passed through if its normal has reversed while its displacement was at least the sum of its distances
    from the tool before and after, and more than half the thickness of the sheet.

    Parameters
    ----------
    model : Model
        At ``converged``, not yet committed.
    last : Evaluation
        Evaluation at the last converged state.
    converged : Converged
        The increment.

    Raises
    ------
    Failed
        If a point has; the model is reverted.
    """
    found, least = converged.evaluation.found, _OVER_AN_EDGE * model.system.thickness
    pairs = [contact for contact in model.contacts if not contact.tool.open]
    if model.system.ranks.any(any(_through(last.found[contact], found[contact], least) for contact in pairs)):
        model.system.revert()
        raise Failed("the sheet goes through a tool", converged.iterations, Cause.PASSAGE)
    for contact in model.system.penalised:
        if isinstance(contact, SheetContact) and (found_at := contact.through((model.u, converged.x[: model.u.size]))):
            model.system.revert()
            where, depth = found_at
            near = ", ".join(f"{x:.4g}" for x in where)
            reason = f"contact {contact.name}: a sheet goes through the other, {depth:.3g} deep near ({near})"
            raise Failed(reason, converged.iterations, Cause.PASSAGE)
    return converged


def _through(before: ContactFound, now: ContactFound, least: float) -> bool:
    """Whether a point has passed through."""
    turned: NDArray[np.bool_] = np.einsum("qk,qk->q", before.normal, now.normal) < 0.0
    if not turned.any():
        return False
    moved = np.linalg.norm(now.x - before.x, axis=1)
    apart = np.maximum(before.gap, 0.0) + np.maximum(now.gap, 0.0)
    return bool((turned & (moved >= apart) & (moved > least)).any())

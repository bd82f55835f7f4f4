"""Change of the residual due to a change of contact forces: at the nodes, and in the balance of pressed tools."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from umform.model.contact.pair import Contact
from umform.model.contact.sheets import SheetContact
from umform.model.equations.assembled import Assembled
from umform.model.equations.evaluation import Evaluation
from umform.model.terms.term import At

Floats = NDArray[np.float64]


def changed_residual(
    model: Assembled, evaluation: Evaluation, parts: Mapping[Contact, Floats] | Mapping[Contact | SheetContact, Floats]
) -> Floats:
    """Change of the residual due to nodal forces of contacts. eqs. (4.35), (4.39), (4.61)

    Parameters
    ----------
    model : Assembled
        The model.
    evaluation : Evaluation
        Evaluation at the current state.
    parts : mapping of Contact to ndarray, shape (3 n,)
        Change of the nodal forces of each contact.

    Returns
    -------
    ndarray, shape (3 n + k,)
    """
    dofs = model.u.size
    change = np.zeros(evaluation.x.size)
    for part in parts.values():
        change[:dofs] += part
    at = At(evaluation.u, evaluation.time, evaluation.controls)
    places = model.mesh.displaced(evaluation.u)
    for number, unknown in enumerate(evaluation.border.unknowns):
        for way in (press.way for tool in model.tools for press in tool.presses if press.unknown is unknown):
            share = sum(
                float((part.reshape(-1, 3) * way.velocity(places, contact.tool, at)).sum())
                for contact, part in parts.items()
                if contact.tool in way.tools
            )
            change[dofs + number] -= model.ranks.sum(share)
    return change

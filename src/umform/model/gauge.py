"""A support that holds the sheet as a rigid body and no more: six degrees of freedom, or those that others leave free.

Where external forces balance, its reactions are zero: a part that is held by it is free of them. docs/theory, 4.18
"""

from __future__ import annotations

import numpy as np

from umform.errors import InvalidValue
from umform.mesh import Ids
from umform.model.checks import left_free, middle
from umform.model.evaluated import Evaluated
from umform.model.forces import rigid_body_modes


def gauge_dofs(model: Evaluated, nodes: Ids) -> Ids:
    """Degrees of freedom of nodes that hold what the supports leave free, as far apart as can be.

    Parameters
    ----------
    model : Model
        The model.
    nodes : ndarray of int
        Nodes that may be held.

    Raises
    ------
    InvalidValue
        If the supports leave nothing free, or these nodes cannot hold it.
    """
    from scipy.linalg import qr  # slow to import

    modes = rigid_body_modes(model.mesh.points, *middle(model))
    free = left_free(model, modes)
    if len(free) == 0:
        raise InvalidValue(
            "the supports hold the sheet already",
            where="hold_rigid()",
            cause="fix(), symmetry() or prescribe() leave no rigid motion free",
            remedy="release a support with Free, or do without it",
        )
    dofs = (3 * np.asarray(nodes)[:, None] + np.arange(3)).ravel()
    dofs = dofs[~model.constrained()[dofs]]
    held = free @ modes[:, dofs]
    _, r, order = qr(held, mode="economic", pivoting=True)
    sizes = np.abs(np.diag(r))
    if len(dofs) < len(free) or sizes[len(free) - 1] < 1e-6 * sizes[0]:
        raise InvalidValue(
            "these nodes cannot hold the sheet",
            where="hold_rigid()",
            value=f"{len(nodes)} nodes for {len(free)} motions",
            cause="too few nodes, or nodes on a line",
            remedy="three nodes that are far apart and not on a line",
        )
    return np.sort(dofs[order[: len(free)]]).astype(np.int32)

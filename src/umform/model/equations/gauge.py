"""A statically determinate support: it holds the rigid-body modes that other supports leave free.

If external forces balance, its reactions are zero: it does not load the part. docs/theory, 4.18
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import numpy as np

from umform.errors import InvalidValue
from umform.mesh import Ids
from umform.model.equations.checks import left_free, middle
from umform.model.equations.evaluated import Evaluated
from umform.model.supports.support import Support
from umform.model.terms.forces import rigid_body_modes


def gauge_dofs(model: Evaluated, nodes: Ids, gone: Sequence[Support] = ()) -> Ids:
    """Degrees of freedom of nodes that hold the free rigid-body modes, as far apart as possible.

    Parameters
    ----------
    model : Model
        The model.
    nodes : ndarray of int
        Nodes that may be held.
    gone : sequence of Support
        Supports that will be removed.

    Raises
    ------
    InvalidValue
        If the supports leave no mode free, these nodes cannot hold it, or a support to remove is inactive.
    """
    with _without(model, gone):
        return _dofs(model, nodes)


@contextmanager
def _without(model: Evaluated, gone: Sequence[Support]) -> Iterator[None]:
    """The model with some of its supports inactive."""
    for support in gone:
        if support not in model.supports:
            raise InvalidValue(
                "hold_rigid() takes the place of supports that act",
                where="hold_rigid(), instead_of",
                value=support,
                cause="it is removed already, waits itself, or belongs to another model",
                remedy="what fix(), symmetry(), hinge() or hold_director() of this model returned",
            )
    for support in gone:
        support.removed = True
    try:
        model.supports.hold_again()
        yield
    finally:
        for support in gone:
            support.removed = False
        model.supports.hold_again()


def _dofs(model: Evaluated, nodes: Ids) -> Ids:
    from scipy.linalg import qr  # slow to import

    points = model.mesh.displaced(model.u)
    modes = rigid_body_modes(points, *middle(model, points))
    free = left_free(model, modes)
    if len(free) == 0:
        raise InvalidValue(
            "the supports hold the sheet already",
            where="hold_rigid()",
            cause="fix(), symmetry() or prescribe() leave no rigid motion free",
            remedy="instead_of=... with the supports that the step Free takes away, or do without it",
        )
    dofs = (3 * np.asarray(nodes)[:, None] + np.arange(3)).ravel()
    dofs = dofs[~model.supports.constrained()[dofs]]
    held = free @ modes[:, dofs]
    _, r, order = qr(held, mode="economic", pivoting=True)
    sizes = np.abs(np.diag(r))
    if len(dofs) < len(free) or sizes[len(free) - 1] < 1e-6 * sizes[0]:
        raise InvalidValue(
            "these nodes cannot hold the sheet",
            where="hold_rigid()",
            value=f"{len(nodes)} nodes, of which {len(dofs)} degrees of freedom are not held yet, for {len(free)} "
            f"motion{'s' if len(free) > 1 else ''}",
            cause="too few nodes, nodes on a line, or nodes that a support holds which the step Free takes away",
            remedy="three nodes that are far apart and not on a line; instead_of=... with the supports that go",
        )
    return np.sort(dofs[order[: len(free)]]).astype(np.int32)

"""Reject bodies in plane strain that may move across, or whose cells do not lie across an axis."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.errors import ModelError
from umform.mesh.numbers import unique
from umform.model.bodies.body import Body
from umform.model.equations.evaluated import Evaluated

#: Deviation of a direction that is round-off of a mesh.
_ROUND_OFF = 1e-6
#: Corners of the lower face of a cell at s = -1 and, in the same order, at s = 1.
_FROM, _TO = (0, 1), (3, 2)


def check_plane_strain(model: Evaluated) -> None:
    """Check the bodies whose element has fewer Gauss points across. docs/theory, 2.11

    Raises
    ------
    ModelError
        If their cells do not have s along one axis, a node is free along it, or the law couples the directions.
    """
    problem = None
    try:
        held = model.supports.constrained().reshape(-1, 3)
        for body in model.bodies:
            if body.element.plane_strain and len(body.cells):
                _check_body(body, held)
    except ModelError as error:
        problem = error
    model.ranks.agree(problem)


def _check_body(body: Body, held: NDArray[np.bool_]) -> None:
    nodes = body.connectivity
    half = nodes.shape[1] // 2
    x = body.mesh.points[nodes]
    across = np.concatenate(
        [x[:, upper + to] - x[:, upper + start] for start, to in zip(_FROM, _TO, strict=True) for upper in (0, half)]
    )
    axis = int(np.abs(across[0]).argmax())
    even = across[0, axis] * np.eye(3)[axis]
    if np.abs(across - even).max() > _ROUND_OFF * abs(across[0, axis]):
        raise ModelError(
            "the cells of a body in plane strain are not equally wide along one axis",
            where=body.name,
            cause="plane_strain takes s, from the first to the fourth node of a cell, for the direction across",
            remedy="number the nodes so that s runs along x, y or z, or leave plane_strain out",
        )
    free = unique(nodes)
    free = free[~held[free, axis]]
    if len(free):
        name = "xyz"[axis]
        raise ModelError(
            f"a body in plane strain may move along {name}",
            where=f"node {free[0]} (one of {len(free)}) of {body.name}",
            cause=f"plane_strain needs supports in {name} at all nodes of the body",
            remedy=f"fix(nodes, '{name}'), or leave plane_strain out",
        )
    if getattr(body.material, "directional", False) and not _aligned(body, axis):
        raise ModelError(
            "a rolling direction at an angle lets a strip shear across",
            where=body.name,
            cause="plane_strain needs the rolling direction along the strip or across it",
            remedy="leave plane_strain out",
        )


def _aligned(body: Body, axis: int) -> bool:
    """Whether the rolling direction lies along an axis or normal to it."""
    assert body.rolling is not None
    rolling = np.atleast_2d(body.rolling)
    part = np.abs(rolling[:, axis]) / np.linalg.norm(rolling, axis=1)
    return bool((np.minimum(part, 1.0 - part) < _ROUND_OFF).all())

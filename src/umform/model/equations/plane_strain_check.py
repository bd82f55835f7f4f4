"""Reject bodies in plane strain that may move across, or whose cells do not lie across an axis."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.errors import ModelError
from umform.mesh import Ids
from umform.mesh.numbers import unique
from umform.model.bodies.body import Body
from umform.model.equations.evaluated import Evaluated

Floats = NDArray[np.float64]

#: Deviation of a direction that is round-off of a mesh.
_ROUND_OFF = 1e-6
#: Deviation of the direction across from an axis in a formed part, whose two edges are equal within its tolerances.
_TURNED = 1e-3
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
                _check_body(body, held, model.mesh.displaced(model.u))
    except ModelError as error:
        problem = error
    model.ranks.agree(problem)


def _check_body(body: Body, held: NDArray[np.bool_], places: Floats) -> None:
    nodes = body.connectivity
    across = _across(nodes, body.mesh.points)
    axis = int(np.abs(across[0]).argmax())
    even = across[0, axis] * np.eye(3)[axis]
    if np.abs(across - even).max() > _ROUND_OFF * abs(across[0, axis]):
        raise ModelError(
            "the cells of a body in plane strain are not equally wide along one axis",
            where=body.name,
            cause="plane_strain takes s, from the first to the fourth node of a cell, for the direction across",
            remedy="number the nodes so that s runs along x, y or z, or leave plane_strain out",
        )
    way = _across(nodes, places).mean(axis=0)
    here = int(np.abs(way).argmax())
    if np.abs(np.delete(way, here)).max() > _TURNED * abs(way[here]):
        raise ModelError(
            "a body in plane strain does not lie along an axis",
            where=body.name,
            value=f"across is ({', '.join(f'{part:.4g}' for part in way / np.linalg.norm(way) + 0.0)})",
            cause="a part that was turned before this operation",
            remedy="turn it so that its width lies along x, y or z, or leave plane_strain out from the start",
        )
    free = unique(nodes)
    free = free[~held[free, here]]
    if len(free):
        name = "xyz"[here]
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


def _across(nodes: Ids, x: Floats) -> Floats:
    """Vectors (n, 3) from s = -1 to s = 1 along the sides of cells."""
    corners, half = x[nodes], nodes.shape[1] // 2
    return np.concatenate(
        [corners[:, up + to] - corners[:, up + start] for start, to in zip(_FROM, _TO, strict=True) for up in (0, half)]
    )


def _aligned(body: Body, axis: int) -> bool:
    """Whether the rolling direction lies along an axis or normal to it."""
    assert body.rolling is not None
    rolling = np.atleast_2d(body.rolling)
    part = np.abs(rolling[:, axis]) / np.linalg.norm(rolling, axis=1)
    return bool((np.minimum(part, 1.0 - part) < _ROUND_OFF).all())

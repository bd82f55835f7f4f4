"""Describe a displacement that the tangent does not resist: which nodes move, and in which direction."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.model.equations.evaluated import Evaluated

Floats = NDArray[np.float64]

#: A node counts as moving beyond this part of the largest displacement.
_MOVES = 1e-3


def loose_part(model: Evaluated, motion: Floats) -> str:
    """Describe a displacement of the nodal unknowns: "27 of 66 nodes can move, most of all node 12 ...".

    Parameters
    ----------
    model : Model
        The model.
    motion : ndarray, shape (n,)
        Displacement of the unknowns, of any magnitude.
    """
    everything = np.concatenate([motion, np.zeros(len(model.unknowns))])
    ways = model.extend(everything)[: model.u.size].reshape(-1, 3)
    sizes = np.linalg.norm(ways, axis=1)
    most = int(np.argmax(sizes))
    if not 0.0 < sizes[most] < np.inf:
        return "no node"
    count = int((sizes > _MOVES * sizes[most]).sum())
    place = model.mesh.points[most] + model.u.reshape(-1, 3)[most]
    along, number = ways[most] / sizes[most], model.whole.node_number(most)
    return (
        f"{count} of {len(sizes)} nodes can move, most of all node {number} at ({_three(place)}) "
        f"along ({_three(along)})"
    )


def _three(values: Floats) -> str:
    return ", ".join(f"{value:.4g}" for value in np.where(np.abs(values) < 5e-4, 0.0, values))

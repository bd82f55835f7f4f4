"""Connected groups of linked things, and points that coincide."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]


def groups(one: NDArray[np.integer], other: NDArray[np.integer], count: int) -> tuple[int, Ids]:
    """Number of groups of ``count`` things, of which ``one`` and ``other`` are linked, and the group of each."""
    from scipy.sparse import coo_matrix  # slow to import
    from scipy.sparse.csgraph import connected_components

    graph = coo_matrix((np.ones(len(one)), (one, other)), shape=(count, count))
    found, label = connected_components(graph, directed=False)
    return int(found), label.astype(np.int64)


def merged(points: Floats, near: float) -> tuple[Floats, Ids]:
    """Merge points nearer than a distance to their mean; returns them and the new number of each old point.

    Parameters
    ----------
    points : ndarray, shape (n, 2 or 3)
        Points.
    near : float
        Distance; chains of near points become one point too.
    """
    from scipy.spatial import cKDTree  # slow to import

    pairs = cKDTree(points).query_pairs(near, output_type="ndarray")
    count, label = groups(pairs[:, 0], pairs[:, 1], len(points))
    times = np.bincount(label, minlength=count)
    means = np.stack([np.bincount(label, column, count) / times for column in points.T], axis=1)
    return means, label

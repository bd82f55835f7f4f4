"""What hangs together: groups of linked things, and points that are one. SciPy is loaded when it is needed."""

from __future__ import annotations

import numpy as np

from umform.surfaces.segments import Floats, Ids


def linked(one: Ids, other: Ids, count: int) -> tuple[int, Ids]:
    """Groups of things that pairs link.

    Parameters
    ----------
    one, other : ndarray of int, shape (pairs,)
        Numbers of the linked things.
    count : int
        Number of things.

    Returns
    -------
    groups : int
        Number of groups.
    label : ndarray of int, shape (count,)
        Number of the group of each thing.
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    graph = coo_matrix((np.ones(len(one)), (one, other)), shape=(count, count))
    groups, label = connected_components(graph, directed=False)
    return int(groups), label.astype(np.int64)


def merged(points: Floats, near: float) -> tuple[Floats, Ids]:
    """Take points that are within a distance of each other for one, their mean.

    Parameters
    ----------
    points : ndarray, shape (n, k)
        Points.
    near : float
        Distance.

    Returns
    -------
    means : ndarray, shape (m, k)
        One point for each group.
    label : ndarray of int, shape (n,)
        Number of the group of each point.
    """
    from scipy.spatial import cKDTree

    pairs = cKDTree(points).query_pairs(near, output_type="ndarray")
    count, label = linked(pairs[:, 0], pairs[:, 1], len(points))
    times = np.bincount(label, minlength=count)
    means = [np.bincount(label, points[:, k], count) / times for k in range(points.shape[1])]
    return np.stack(means, axis=1), label

"""A measure of hourglass patterns in a structured mesh of one layer."""

from __future__ import annotations

import numpy as np

from umform.model import Model


def alternation(model: Model, cells: tuple[int, int]) -> float:
    """Share of the hourglass deformation of the cells that changes its sign from cell to cell.

    The hourglass vector x1 - x2 + x3 - x4 of the corners of a cell is of the size of a second derivative for a smooth
    displacement, and neighbours agree; in a pattern neighbours are opposite, along one direction or both.

    Parameters
    ----------
    model : Model
        A model on a mesh of :func:`umform.mesh.strip`.
    cells : tuple of int
        Its numbers of cells.

    Returns
    -------
    float
        Sum with alternating signs over the sum of sizes, the largest over both components and the three patterns: 0 for
        a smooth field, 1 for a pure pattern.
    """
    u = model.u.reshape(-1, 3)[model.mesh.connectivity]
    half = u.shape[1] // 2
    corners = 0.5 * (u[:, :4, :2] + u[:, half : half + 4, :2])
    gamma = np.einsum("i,cid->cd", [1.0, -1.0, 1.0, -1.0], corners).reshape(*cells, 2)
    size = float(np.linalg.norm(gamma, axis=-1).sum())
    i, j = np.indices(cells)
    patterns = [(-1.0) ** i, (-1.0) ** j, (-1.0) ** (i + j)]
    sums = [float(np.abs(np.einsum("ij,ijd->d", pattern, gamma)).max()) for pattern in patterns]
    return max(sums) / size if size > 0.0 else 0.0

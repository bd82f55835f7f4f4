"""Meshes from files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from umform.mesh.mesh import Ids, Mesh


def read(path: str | Path) -> Mesh:
    """Read a mesh of hexahedra from any file that meshio knows, or from a VTKHDF file written by umform.

    Named groups of nodes become node sets. The outer lower and upper faces become the sets ``lower`` and ``upper``;
    choose others by a predicate, for instance ``lambda x, y, z: x < 1e-9``.
    """
    from umform.io.meshes import read_mesh_arrays  # meshio is slow to import

    points, cells, point_sets, _ = read_mesh_arrays(path)
    connectivity = next(iter(cells.values()), np.empty((0, 8), dtype=np.int32))
    return Mesh(points, cells, point_sets, _outer_faces(connectivity))


def _outer_faces(cells: NDArray[np.integer]) -> dict[str, Ids]:
    """Lower and upper faces that no other cell shares."""
    half = cells.shape[1] // 2
    lower, upper = np.sort(cells[:, :half], axis=1), np.sort(cells[:, half:], axis=1)
    outer = {}
    for name, number, mine, others in (("lower", 0, lower, upper), ("upper", 1, upper, lower)):
        shared = {row.tobytes() for row in others}
        ids = np.array([k for k, row in enumerate(mine) if row.tobytes() not in shared], dtype=np.int32)
        outer[name] = np.stack([ids, np.full(len(ids), number, dtype=np.int32)], axis=1)
    return outer

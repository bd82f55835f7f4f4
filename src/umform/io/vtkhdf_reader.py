"""Mesh and fields of a VTKHDF file, as `umform.io.VtkHdfSeries` writes it."""

from __future__ import annotations

import os
from typing import Any

import h5py
import numpy as np

from umform.errors import FileProblem, WrongCellType
from umform.io.cells import CELL_TYPES, LAGRANGE_TYPES, from_vtk
from umform.io.checks import FloatArray, IntArray, check_ids, check_points
from umform.io.vtkhdf import DEGREES

BY_VTK = {kind.vtk_type: kind for kind in (*CELL_TYPES.values(), *LAGRANGE_TYPES.values())}


def read_vtkhdf(path: str | os.PathLike[str]) -> tuple[FloatArray, dict[str, IntArray]]:
    """Read the mesh of a VTKHDF file with hexahedra.

    Parameters
    ----------
    path : str or os.PathLike
        A file of type ``UnstructuredGrid`` in one part, such as `VtkHdfSeries` writes.

    Returns
    -------
    points : ndarray of float, shape (n, 3)
        Positions of all the points of the file, with those of middle layers.
    cells : dict of str to ndarray of int, shape (m, k)
        For each cell type of umform the points of its cells, in the order of umform.

    Raises
    ------
    WrongCellType
        There are cells that are not hexahedra with 8 or 27 nodes or Lagrange hexahedra of the degrees
        (2, 2, 1), or some with 27 nodes cannot become ``hex18``.
    NotFinite
        A coordinate is NaN or infinite.
    InvalidValue
        A cell names a point that does not exist.
    FileProblem
        The file cannot be read.
    """
    place = os.fspath(path)
    try:
        with h5py.File(path, "r") as file:
            root = file["VTKHDF"]
            if root.attrs["Type"] != b"UnstructuredGrid" or len(root["NumberOfPoints"]) != 1:
                raise ValueError("it is not an UnstructuredGrid in one part")
            X = np.asarray(root["Points"], dtype=np.float64)
            nodes = np.asarray(root["Connectivity"], dtype=np.int64)
            offsets = np.asarray(root["Offsets"], dtype=np.int64)
            types = np.asarray(root["Types"])
            data = root.get(f"CellData/{DEGREES}", np.zeros((len(types), 3)))
            degrees = np.asarray(data[: len(types)], dtype=np.float64)  # the same in all steps
    except (OSError, KeyError, ValueError) as error:
        raise FileProblem(
            "the file cannot be read as VTKHDF",
            where=place,
            cause=str(error),
            remedy="give a file that umform has written",
        ) from error
    found = np.unique(types).tolist()
    if not found or not BY_VTK.keys() >= set(found):
        raise WrongCellType(
            "umform reads hexahedra with 8, 18 or 27 nodes only",
            where=place,
            value=f"VTK cell types {found}",
            remedy="write the hexahedra alone to the file",
        )
    check_points(X, place)
    cells: dict[str, IntArray] = {}
    for number in found:
        kind, chosen = BY_VTK[number], types == number
        if kind.degrees:
            _check_degrees(kind.degrees, degrees[chosen], place)
        ids = nodes[offsets[:-1][chosen][:, None] + np.arange(len(kind.vtk_nodes))]
        check_ids(ids, len(X), place)
        ids = from_vtk(kind, X, ids)
        cells[kind.name] = np.vstack([cells[kind.name], ids]) if kind.name in cells else ids
    return X, cells


def frames_in(path: str | os.PathLike[str]) -> int:
    """Number of frames of a file of fields."""
    with h5py.File(path, "r") as file:
        return int(file["VTKHDF/Steps"].attrs["NSteps"])


def read_fields(root: Any, frame: int) -> tuple[dict[str, FloatArray], dict[str, FloatArray]]:
    """Read the fields of a frame.

    Parameters
    ----------
    root : h5py.Group
        The group ``VTKHDF`` of the open file.
    frame : int
        The frame, from 0.

    Returns
    -------
    points, cells : dict of str to ndarray of float
        Fields at all points of the file, with those of middle layers, and in the cells.
    """
    found = []
    for kind, count in (("PointData", len(root["Points"])), ("CellData", len(root["Types"]))):
        starts = {name: int(offsets[frame]) for name, offsets in root[f"Steps/{kind}Offsets"].items()}
        chosen = {name: start for name, start in starts.items() if (kind, name) != ("CellData", DEGREES)}
        found.append({name: root[f"{kind}/{name}"][start : start + count] for name, start in chosen.items()})
    return found[0], found[1]


def _check_degrees(expected: tuple[int, ...], degrees: FloatArray, where: str) -> None:
    """Reject Lagrange cells of other degrees, which have other nodes."""
    wrong = np.flatnonzero((degrees != expected).any(axis=1))
    if wrong.size:
        raise WrongCellType(
            f"umform reads Lagrange hexahedra of the degrees {expected} only",
            where=where,
            value=degrees[wrong[0]],
            cause="" if degrees[wrong[0]].any() else f"the file has no cell data {DEGREES}",
            remedy="let the first two natural directions lie in the sheet and the third through its thickness",
        )

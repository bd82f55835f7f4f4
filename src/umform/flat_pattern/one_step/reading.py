"""Formed mid-surfaces from files, arrays and formed meshes."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from umform.errors import FileProblem, InvalidValue
from umform.io.checks import check_ids, check_points
from umform.mesh import Mesh
from umform.spec import check_value
from umform.spec.types import Length, NotNegative, Positive
from umform.surfaces.cad.opencascade import IGES, STEP, Shape
from umform.surfaces.stl import read_stl, welded
from umform.surfaces.triangles import Triangles, halved

Floats = NDArray[np.float64]

#: Deviation of triangles from faces of CAD over the size, and the angle between them in degrees.
_ARROW, _ANGLE = 5e-4, 10.0
#: Size of a part over that of its triangles, and of coarse ones.
_FINE, _COARSE = 20.0, 10.0
#: Distance over the size within which corners of faces are one point.
_WELD = 1e-6
#: Largest number of triangles for a given size.
_MOST = 1_000_000


def surface_of(
    part: str | Path | Triangles | tuple[Floats, NDArray[np.integer]],
    *,
    scale: Positive = 1.0,
    weld: NotNegative = 0.0,
    size: Length | None = None,
) -> Triangles:
    """Triangles of a part.

    Parameters
    ----------
    part : str, Path, Triangles or (points, triangles)
        A file (STL; STEP or IGES; what meshio reads, with triangles or quadrilaterals), or the surface itself.
    scale : float
        Factor on coordinates of a file.
    weld : float
        Distance below which corners are one point; 0: 1e-6 of the size.
    size : float, optional
        Largest side of a triangle, mm: longer ones are halved; of CAD files 1/20 of the size of the part.

    Raises
    ------
    InvalidValue
        If a number is none, a triangle has a point that does not exist, or the size asks for far too many triangles.
    FileProblem
        If the file cannot be read, or has no triangles.
    """
    for name, value in (("scale", scale), ("weld", weld), ("size", size)):
        check_value(surface_of, name, value)
    if isinstance(part, Triangles):
        made = part
    elif isinstance(part, tuple):
        made = _of_arrays(np.asarray(part[0], dtype=float), np.asarray(part[1], dtype=np.int64), "part")
    else:
        path = Path(part)
        kind = path.suffix.lower()
        if kind == ".stl":
            made = read_stl(path, weld, scale)
        elif kind in STEP + IGES:
            made = _of_cad(path, scale, weld)
            size = size or float(np.ptp(made.points, axis=0).max()) / _FINE
        else:
            made = _of_mesh(path, scale, weld)
    if size is None:
        return made
    _refuse_many(made, size)
    return halved(made, size)


def _refuse_many(surface: Triangles, size: float) -> None:
    """Refuse a largest side that asks for far more triangles than an estimate can have."""
    x = surface.corners
    sides = np.linalg.norm(x - np.roll(x, 1, axis=1), axis=2).max(axis=1) / size
    areas = np.linalg.norm(surface.area_vectors, axis=1) / (0.25 * math.sqrt(3.0) * size) / size
    count = float(np.maximum(sides, areas).sum())
    if count > _MOST:
        raise InvalidValue(
            f"an estimate has at most {_MOST} triangles",
            where="size",
            value=size,
            cause=f"there would be {count:.2g} or more: another unit, or a slip of the decimal point",
            remedy=f"a length in mm, such as {float(np.ptp(surface.points, axis=0).max()) / _FINE:.3g}",
        )


def coarse_size(part: Path, scale: float) -> float | None:
    """Side of coarse triangles of a CAD file; None for other files."""
    check_value(surface_of, "scale", scale)
    if part.suffix.lower() not in STEP + IGES:
        return None
    return Shape(part, scale).size / _COARSE


def _of_cad(path: Path, scale: float, weld: float) -> Triangles:
    shape = Shape(path, scale)
    faces = shape.faces(_ARROW * shape.size, math.radians(_ANGLE))
    made = Triangles.all_of([Triangles(face.points, face.triangles) for face in faces])
    return welded(made.points, made.triangles, weld or _WELD * shape.size)[0]


def _of_mesh(path: Path, scale: float, weld: float) -> Triangles:
    from umform.io.meshes import read_by_meshio  # slow to import

    mesh = read_by_meshio(path)
    cells = [np.asarray(block.data) for block in mesh.cells if block.type in ("triangle", "quad")]
    if not cells:
        raise FileProblem(
            "there are no triangles and no quadrilaterals in the mesh",
            where=str(path),
            value=", ".join(sorted({block.type for block in mesh.cells})) or "no cells",
            cause="a mesh of solids",
            remedy="export the mid-surface",
        )
    points = np.zeros((len(mesh.points), 3))
    points[:, : mesh.points.shape[1]] = scale * mesh.points
    triangles = np.concatenate([_halves(block) for block in cells]).astype(np.int64)
    made = _of_arrays(points, triangles, str(path))
    size = float(np.ptp(made.points, axis=0).max())
    return welded(made.points, made.triangles, weld or _WELD * size)[0]


def _of_arrays(points: Floats, triangles: NDArray[np.int64], where: str) -> Triangles:
    """Triangles with their points, of which a file may have others, such as a node of reference far away."""
    check_ids(triangles, len(points), where)
    used, ids = np.unique(triangles, return_inverse=True)
    check_points(points[used], where)
    return Triangles(points[used], ids.reshape(triangles.shape).astype(np.int64))


def _halves(cells: NDArray[np.integer]) -> NDArray[np.integer]:
    return cells if cells.shape[1] == 3 else np.concatenate([cells[:, [0, 1, 2]], cells[:, [0, 2, 3]]])


def mid_surface(mesh: Mesh, u: Floats) -> Triangles:
    """The mid-surface of a formed sheet of one layer of cells, four triangles for each cell.

    Parameters
    ----------
    mesh : Mesh
        Undeformed sheet.
    u : ndarray, shape (n, 3) or (3 n,)
        Displacement of the nodes.

    Examples
    --------
    >>> import umform as uf
    >>> strip = uf.mesh.strip(10.0, 2.0, 1.0, (5, 1))
    >>> surface = uf.mid_surface(strip, 0.0 * strip.points)
    >>> len(surface.triangles), float(surface.points[:, 2].max())
    (20, 0.0)
    """
    half = mesh.connectivity.shape[1] // 2
    x = mesh.points + np.asarray(u).reshape(-1, 3)
    cells = mesh.connectivity[:, :4].astype(np.int64), mesh.connectivity[:, half : half + 4].astype(np.int64)
    lower, place = np.unique(cells[0], return_index=True)
    upper = cells[1].ravel()[place]
    middle = 0.5 * (x[lower] + x[upper])
    quads = np.searchsorted(lower, cells[0])
    centres = len(middle) + np.arange(len(quads))
    points = np.concatenate([middle, middle[quads].mean(axis=1)])
    sides = [np.stack([quads[:, k], quads[:, (k + 1) % 4], centres], axis=1) for k in range(4)]
    return Triangles(points, np.concatenate(sides))


def moved_along_normals(surface: Triangles, distance: float) -> Triangles:
    """A surface moved along its normals: from a skin to the mid-surface."""
    if not distance:
        return surface
    normals = np.zeros_like(surface.points)
    x = surface.corners
    for k in range(3):
        a, b = x[:, (k + 1) % 3] - x[:, k], x[:, (k + 2) % 3] - x[:, k]
        n = np.cross(a, b)
        size = np.linalg.norm(n, axis=1)
        angle = np.arctan2(size, np.einsum("mi,mi->m", a, b))
        np.add.at(normals, surface.triangles[:, k], n * (angle / np.maximum(size, 1e-300))[:, None])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return Triangles(surface.points + distance * normals, surface.triangles)

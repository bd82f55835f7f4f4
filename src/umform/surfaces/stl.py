"""Triangles of an STL file, welded."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from umform.errors import FileProblem, UnfitTriangles
from umform.surfaces.directions import not_negative
from umform.surfaces.joined import merged
from umform.surfaces.triangles import Floats, Ids, Triangles

#: Part of the size of a surface within which corners are one point: single precision keeps seven digits.
_WELD = 1e-6


def read_stl(path: str | Path, weld: float = 0.0, scale: float = 1.0) -> Triangles:
    """Triangles of a file, their corners welded.

    Parameters
    ----------
    path : str or Path
        The file, binary or text, read by meshio.
    weld : float
        Corners nearer than this are merged; 0 means 1e-6 of the size of the surface.
    scale : float
        Factor on all coordinates.

    Returns
    -------
    Triangles
        Triangles that are not degenerate after welding.

    Raises
    ------
    FileProblem
        If the file cannot be read.
    UnfitTriangles
        If there is no triangle in it.
    """
    path = Path(path)
    points, triangles = _read(path)
    points = points * scale
    if not np.isfinite(points).all():
        raise UnfitTriangles(
            "a coordinate is not finite",
            where=str(path),
            cause="a file that was cut off, or a program that has failed",
            remedy="export the surface again",
        )
    size = float(np.ptp(points, axis=0).max()) if len(points) else 0.0
    near = not_negative(weld, "from_stl", "weld distance") or _WELD * size
    surface = welded(points, triangles, near)[0] if len(triangles) else Triangles(points, triangles)
    if not len(surface.triangles):
        raise UnfitTriangles(
            "there is no triangle",
            where=str(path),
            value=f"{len(triangles)} before welding within {near:.3g}",
            cause="an empty file, or a weld distance above the size of the triangles",
            remedy="export the surface again, or a smaller weld distance",
        )
    return surface


def _read(path: Path) -> tuple[Floats, Ids]:
    import meshio  # slow to import

    from umform.io.meshes import quiet  # slow to import

    if not path.exists():
        raise FileProblem(
            "there is no such file",
            where=str(path),
            cause="another name or folder; in a deck the path begins at its folder",
            remedy="give the path of an STL file",
        )
    with np.errstate(over="ignore"), quiet() as said:
        try:
            made = meshio.read(path, file_format="stl")
            triangles = [block.data for block in made.cells if block.type == "triangle"]
        except (Exception, SystemExit) as error:  # meshio raises errors of any kind, and may exit
            raise FileProblem(
                "this is no STL file that can be read",
                where=str(path),
                cause=_not_whole(path)
                or " ".join(said.getvalue().split())
                or f"{type(error).__name__}: {' '.join(str(error).split())}",
                remedy="export the surface as binary STL again",
            ) from error
    ids = np.vstack(triangles).astype(np.int64) if triangles else np.empty((0, 3), dtype=np.int64)
    return np.asarray(made.points, dtype=float), ids


def _not_whole(path: Path) -> str:
    """What is wrong with the size of a binary file; nothing of a text, or where the size is right."""
    if not path.is_file() or (head := path.read_bytes()[:84]).lstrip()[:5].lower() == b"solid" or len(head) < 84:
        return ""
    count, size = int.from_bytes(head[80:], "little"), path.stat().st_size
    whole = 84 + 50 * count
    why = "it was cut off, or is of another kind" if size < whole else "there is more behind them"
    return "" if size == whole else f"it has {size} bytes, and its {count} triangles need {whole}: {why}"


def welded(points: Floats, triangles: Ids, near: float) -> tuple[Triangles, NDArray[np.bool_]]:
    """Merge points nearer to each other than a distance.

    Returns
    -------
    surface : Triangles
        The means of such points, and the triangles that still have three corners.
    kept : ndarray of bool, shape (m,)
        Mask of these triangles.
    """
    means, label = merged(points, near)
    ids = label[triangles]
    a, b, c = ids.T
    kept = (a != b) & (b != c) & (c != a)
    used, ids = np.unique(ids[kept], return_inverse=True)
    return Triangles(means[used], ids.reshape(-1, 3).astype(np.int64)), kept

"""Sections of the sheet: where a plane cuts the undeformed blank, and where these places are in the part."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.errors import InvalidValue
from umform.mesh import Ids, Mesh
from umform.surfaces.joined import groups

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Section:
    """A section of the sheet, from one end to the other; arrays of shape (n,) and (n, 3).

    Attributes
    ----------
    s : ndarray
        Way along the section in the undeformed sheet.
    lower, upper : ndarray
        Both skins now.
    gaps : ndarray of bool, shape (n - 1,)
        Whether a hole lies between a place and the next one.
    """

    s: Floats
    lower: Floats
    upper: Floats
    gaps: NDArray[np.bool_]

    @property
    def middle(self) -> Floats:
        """Half-way between the skins."""
        return 0.5 * (self.lower + self.upper)

    @property
    def length(self) -> float:
        """Length of the middle, without holes."""
        return float(np.linalg.norm(np.diff(self.middle, axis=0), axis=1)[~self.gaps].sum())

    def line(self, along: Floats) -> Floats:
        """Mid-surface, shape (n, 2): way along a horizontal direction, and z."""
        return np.stack([self.middle @ along, self.middle[:, 2]], axis=1)


def columns(cuts: Mapping[str, Section]) -> dict[str, Floats]:
    """Columns of a table: way along the undeformed section, and both skins in each state.

    Parameters
    ----------
    cuts : mapping of str to Section
        The same section in several states, by their names.
    """
    found = {"s": next(iter(cuts.values())).s}
    for name, cut in cuts.items():
        for side in ("lower", "upper"):
            found |= {f"{name}_{side}_{axis}": getattr(cut, side)[:, k] for k, axis in enumerate("xyz")}
    return found


def horizontal(normal: ArrayLike) -> Floats:
    """Unit vector in the plane of a section and normal to z; its largest component is positive."""
    n = np.asarray(normal, dtype=float)
    n = n / np.abs(n).max()
    along = np.array([-n[1], n[0], 0.0])
    size = float(np.linalg.norm(along))
    if not size > 1e-9:
        raise InvalidValue(
            "the plane of a section stands on the sheet",
            where="normal",
            value=f"normal {normal!r}",
            cause="a plane parallel to the blank, or no direction",
            remedy="a normal in the plane of the blank: (0, 1, 0) for a section along x",
        )
    unit: Floats = along * (np.sign(along[np.argmax(np.abs(along))]) / size)
    return unit


def section(mesh: Mesh, u: Floats, point: ArrayLike = (0.0, 0.0, 0.0), normal: ArrayLike = (0.0, 1.0, 0.0)) -> Section:
    """Cut the undeformed sheet by a plane, and follow the section into the part.

    Parameters
    ----------
    mesh : Mesh
        Undeformed mesh.
    u : ndarray, shape (n, 3) or (3 n,)
        Displacement of the nodes.
    point, normal : array_like, shape (3,)
        Plane of the section in the undeformed sheet; it cuts the sheet through its thickness.

    Returns
    -------
    Section

    Raises
    ------
    InvalidValue
        If the plane does not cut the sheet, or cuts several sheets.
    """
    n = np.asarray(normal, dtype=float)
    n = n / np.abs(n).max()  # the squares of large numbers overflow
    n = n / np.linalg.norm(n)
    X, x = mesh.points, mesh.displaced(u)
    cells = mesh.connectivity
    half = cells.shape[1] // 2
    ends = _edges(cells[:, :half]), _edges(cells[:, half:])
    scale = np.ptp(X, axis=0).max()
    height = (X - np.asarray(point, dtype=float)) @ n
    height[np.abs(height) < 1e-9 * scale] = 0.0
    a, b = (height[ends[0][:, k]] for k in (0, 1))
    cut = (a * b < 0.0) | (a == 0.0)
    if not cut.any():
        raise InvalidValue(
            "the plane of a section does not cut the sheet",
            where="section",
            value=f"point {point!r}, normal {normal!r}",
            cause="a point beside the sheet",
            remedy="a point of the undeformed sheet, and a normal in its plane",
        )
    facet = np.tile(np.arange(len(cells)), len(cut) // len(cells))[cut]
    _refuse_several(cells, np.unique(facet))
    part = np.where(a == b, 0.0, a / np.where(a == b, 1.0, a - b))[cut, None]
    lower, upper, start = (
        (1.0 - part) * y[of[cut, 0]] + part * y[of[cut, 1]] for y, of in ((x, ends[0]), (x, ends[1]), (X, ends[0]))
    )
    return _in_order(start, lower, upper, np.cross(n, _facing(start, n)), scale, facet)


def _refuse_several(cells: NDArray[np.int32], cut: Ids) -> None:
    """Refuse a cut through cells of sheets that have no nodes in common."""
    links = cells[:, 1:]
    _, sheet = groups(np.repeat(cells[:, 0], links.shape[1]), links.ravel(), int(cells.max()) + 1)
    count = len(np.unique(sheet[cells[cut, 0]]))
    if count > 1:
        raise InvalidValue(
            "a section is that of one sheet",
            where="section",
            value=f"{count} sheets are cut",
            cause="sheets that touch, or lie beside each other, in one mesh",
            remedy="a point beside the other sheets, or the fields of the run in place of this measure",
        )


def _edges(quads: NDArray[np.int32]) -> NDArray[np.int32]:
    """Ends of the straight pieces of the sides of facets of 4 or 9 nodes, both ways round."""
    if quads.shape[1] == 4:
        sides = [(0, 1), (1, 2), (2, 3), (3, 0)]
    else:
        sides = [(0, 4), (4, 1), (1, 5), (5, 2), (2, 6), (6, 3), (3, 7), (7, 0), (7, 8), (8, 5), (4, 8), (8, 6)]
    both = sides + [(b, a) for a, b in sides]
    return np.concatenate([quads[:, list(pair)] for pair in both])


def _facing(points: Floats, n: Floats) -> Floats:
    """Direction across a section: the least extent of its points that is normal to the plane's normal."""
    _, _, axes = np.linalg.svd(points - points.mean(axis=0), full_matrices=True)
    along = axes[0] - (axes[0] @ n) * n
    along /= np.linalg.norm(along)
    if along[np.argmax(np.abs(along))] < 0.0:
        along = -along
    facing: Floats = np.cross(along, n)
    return facing


def _in_order(start: Floats, lower: Floats, upper: Floats, along: Floats, scale: float, facet: Ids) -> Section:
    """Places in their order along the section, each once; of stacked layers the outermost skins. Facets span gaps."""
    s = start @ along
    rounded, first, same = np.unique(np.round(s / (1e-7 * scale)), return_index=True, return_inverse=True)
    order = np.argsort(start[:, 2], kind="stable")
    low, high = np.zeros(len(rounded), dtype=int), np.zeros(len(rounded), dtype=int)
    high[same.ravel()[order]] = order  # the last one stays: the highest layer
    low[same.ravel()[order[::-1]]] = order[::-1]
    begin, end = np.full(facet.max() + 1, len(rounded)), np.zeros(facet.max() + 1, dtype=int)
    np.minimum.at(begin, facet, same.ravel())
    np.maximum.at(end, facet, same.ravel())
    spanned = np.zeros(len(rounded) + 1, dtype=int)
    np.add.at(spanned, begin, 1)
    np.add.at(spanned, np.maximum(begin, end), -1)
    return Section(s[first] - s[first].min(), lower[low], upper[high], np.cumsum(spanned)[: len(rounded) - 1] == 0)

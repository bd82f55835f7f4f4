"""Meshes of solid-shells from surfaces of quadrilaterals."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal

import numpy as np
from annotated_types import Gt, Lt
from numpy.typing import ArrayLike

from umform.errors import FoldedElement, InvalidValue, WrongCellType
from umform.mesh.mesh import Floats, Mesh
from umform.mesh.neighbours import Whole, outer_faces, place, used_only, with_centres
from umform.mesh.quality import jacobians
from umform.mesh.surface import alike, directors
from umform.spec import About, check_arguments

#: Position of the given surface: parts of the thickness to the lower and to the upper face.
_SURFACES = {"middle": (-0.5, 0.5), "lower": (0.0, 1.0), "upper": (-1.0, 0.0)}


def thicken(
    points: ArrayLike,
    quads: ArrayLike,
    thickness: float | ArrayLike,
    sets: Mapping[str, ArrayLike] | None = None,
    *,
    surface: Literal["middle", "lower", "upper"] = "middle",
    kink: Annotated[float, Gt(0.0), Lt(180.0), About(cause="radians, or a sign")] = 100.0,
) -> Mesh:
    """Give a surface of quadrilaterals its thickness, along its normals.

    Quadrilaterals with 4 nodes become ``hex8``, with 9 nodes ``hex18``; those with 8 nodes get a centre on the surface
    of these 8 nodes and become ``hex18``. Neighbours are oriented so that they have the same side up: that of most
    quadrilaterals of each connected part. ``upper`` is the side of their normal.

    At a node the normals of its quadrilaterals are averaged, weighted by their angles. At a kink the nodes lie farther
    apart, so that the thickness along the normals of the faces is the same on both sides of it (a mitre).

    Parameters
    ----------
    points : array_like, shape (n, 3)
        Positions. Unused ones are removed.
    quads : array_like of int, shape (m, 4), (m, 8) or (m, 9)
        Node ids: corners, mid-sides, centre.
    thickness : float or array_like, shape (n,)
        The same for all nodes, or one value for each.
    sets : mapping of str to array_like of int, optional
        Named sets of nodes. Each one becomes a set of the nodes of both faces; ``name_lower`` and ``name_upper`` are
        its nodes on one face.
    surface : {"middle", "lower", "upper"}
        The given surface: the mid-surface, the lower or the upper face.
    kink : float
        Largest angle in degrees between the quadrilaterals at a node, measured as twice that from the mean normal.

    Returns
    -------
    Mesh
        With face sets ``lower`` and ``upper``.

    Raises
    ------
    WrongCellType, InvalidValue
        If the arrays are no valid surface, the thickness is not positive, or a kink is too sharp.
    MeshError
        If the surface branches or is one-sided.
    FoldedElement
        If the thickness reaches beyond the centre of curvature.
    """
    X, corners, t, named = _checked(points, quads, thickness, sets or {})
    check_arguments(thicken, surface=surface, kink=kink)
    if corners.shape[1] == 8:
        X, corners, named = with_centres(np.column_stack([X, t]), corners, named)
        X, t = X[:, :3], X[:, 3]
    X, corners, named = used_only(np.column_stack([X, t]), corners, named)
    X, t = np.ascontiguousarray(X[:, :3]), X[:, 3:]
    corners = alike(X, corners)
    offset = t * directors(X, corners, kink)
    below, above = _SURFACES[surface]
    count = len(X)
    nodes = np.concatenate([X + below * offset, X + above * offset])
    cells = np.concatenate([corners, corners + count], axis=1).astype(np.int32)
    _check_folds(nodes, cells, X, t)
    both = {name: np.concatenate([ids, ids + count]) for name, ids in named.items()}
    sides = {f"{name}_lower": ids for name, ids in named.items()}
    sides |= {f"{name}_upper": ids + count for name, ids in named.items()}
    return Mesh(nodes, {"hex8" if cells.shape[1] == 8 else "hex18": cells}, sides | both, outer_faces(cells))


def _checked(
    points: ArrayLike, quads: ArrayLike, thickness: float | ArrayLike, sets: Mapping[str, ArrayLike]
) -> tuple[Floats, Whole, Floats, dict[str, Whole]]:
    """Arrays of a surface, a thickness at each node, and sets."""
    X: Floats = np.asarray(points, dtype=float)
    corners = np.asarray(quads)
    if X.ndim != 2 or X.shape[1] != 3 or not np.isfinite(X).all():
        raise InvalidValue(
            "points must be finite and have shape (n, 3)",
            where="points",
            value=X.shape,
            cause="two coordinates, or NaN of a file that is not complete",
            remedy="a row of x, y, z for each point",
        )
    if corners.ndim != 2 or corners.shape[1] not in (4, 8, 9) or not np.issubdtype(corners.dtype, np.integer):
        raise WrongCellType(
            "quadrilaterals are whole numbers of shape (m, 4), (m, 8) or (m, 9)",
            where="quadrilaterals",
            value=corners.shape,
            cause="triangles or hexahedra, or a flat array",
            remedy="a row of 4, 8 or 9 point numbers for each; mesh triangles anew as quadrilaterals",
        )
    if not len(corners) or corners.min() < 0 or corners.max() >= len(X):
        raise InvalidValue(
            "there are no quadrilaterals, or one names a node that does not exist",
            where="quadrilaterals",
            value=f"{len(corners)} quadrilaterals, {len(X)} points",
            cause="node numbers that start at 1, or a cut file",
            remedy="numbers of points from 0",
        )
    t = np.asarray(thickness, dtype=float)
    if t.shape not in ((), (len(X),)) or not (np.isfinite(t).all() and (t > 0).all()):
        raise InvalidValue(
            "the thickness is a positive number, or one for each node",
            where="thickness",
            value=thickness if t.ndim == 0 else f"shape {t.shape}, least {t.min(initial=np.inf):.4g}",
            cause="a sign, or the thickness of each cell",
            remedy="one number, or one for each point",
        )
    named: dict[str, Whole] = {name: np.unique(np.asarray(ids, dtype=np.int64)) for name, ids in sets.items()}
    return X, corners.astype(np.int64), np.broadcast_to(t, len(X)), named


def _check_folds(nodes: Floats, cells: Whole, X: Floats, t: Floats) -> None:
    """Reject cells that are thicker than the surface allows."""
    J = jacobians(nodes, cells.astype(np.int32))
    bad = np.flatnonzero(J.min(axis=1) <= 1e-10 * np.abs(J).max(axis=1))
    if not bad.size:
        return
    corners = cells[bad[0], : cells.shape[1] // 2]
    raise FoldedElement(
        f"{bad.size} of {len(cells)} cells fold over themselves when they are thickened",
        where=f"quadrilateral {bad[0]}, {place(X[corners])}",
        value=f"thickness {t[corners].mean():.4g}",
        cause="the thickness on the hollow side is more than the radius of curvature, or the quadrilateral is folded",
        remedy="a smaller thickness or a larger radius; check which side is meant: surface = middle, lower or upper",
    )

"""Principal strains of the sheet in its plane, on both skins and in the middle."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.mesh import FACE_NODES, Ids, Mesh
from umform.results.forming.limits import FormingLimit, limit_margin

if TYPE_CHECKING:
    from umform.results.history import History

Floats = NDArray[np.float64]

#: Surfaces of the sheet, with their natural coordinate through the thickness.
SURFACES = {"lower": -1.0, "middle": 0.0, "upper": 1.0}


@dataclass(frozen=True)
class SheetStrains:
    """Logarithmic principal strains in the middle of each cell, arrays of shape (cells,).

    Attributes
    ----------
    major, minor : dict of str to ndarray
        Larger and smaller strain in the surface, for ``lower``, ``middle`` and ``upper``. Of stacked cells the outer
        ones have the skins of the sheet.
    thickness : ndarray
        Logarithmic strain of the thickness, negative where the sheet has thinned.
    """

    major: dict[str, Floats]
    minor: dict[str, Floats]
    thickness: Floats


def sheet_strains(mesh: Mesh, u: Floats) -> SheetStrains:
    """Strains of the sheet under a displacement. eqs. (5.60) to (5.62)

    Parameters
    ----------
    mesh : Mesh
        Undeformed mesh.
    u : ndarray, shape (n, 3) or (3 n,)
        Displacement of the nodes.
    """
    cells = mesh.connectivity
    logs = np.log(_principal_stretches(*_tangents(mesh, u, [[0.0, 0.0, t] for t in SURFACES.values()])))
    thickness = np.log(_heights(cells, mesh.displaced(u)) / _heights(cells, mesh.points))
    major, minor = ({name: logs[:, k, side] for k, name in enumerate(SURFACES)} for side in (1, 0))
    return SheetStrains(major, minor, thickness)


def stretched(mesh: Mesh, u: Floats) -> Floats:
    """Tensor F F^T in the middle of each cell, in axes of the undeformed cell, shape (cells, 2, 2). eq. (5.61)

    Parameters
    ----------
    mesh : Mesh
        Undeformed mesh.
    u : ndarray, shape (n, 3) or (3 n,)
        Displacement of the nodes.
    """
    before, now = _tangents(mesh, u, [[0.0, 0.0, 0.0]])
    return _stretch_tensors(before[:, 0], now[:, 0])


def _tangents(mesh: Mesh, u: Floats, places: list[list[float]]) -> tuple[Floats, Floats]:
    """Tangents of the sheet at places of each cell before and after, shape (cells, places, 2, 3)."""
    cells = mesh.connectivity
    _, dN = _core.shell_functions(cells.shape[1], np.array(places))
    before, now = (np.einsum("qia,eak->eqik", dN[:, :2], x[cells]) for x in (mesh.points, mesh.displaced(u)))
    return before, now


def _principal_stretches(G: Floats, g: Floats) -> Floats:
    """Smaller and larger stretch (..., 2) of tangent vectors (..., 2, 3) before and after. eq. (5.61)"""
    values: Floats = np.sqrt(np.linalg.eigvalsh(_stretch_tensors(G, g)))
    return values


def _stretch_tensors(G: Floats, g: Floats) -> Floats:
    """Tensor F F^T (..., 2, 2) of tangent vectors (..., 2, 3) before and after. eq. (5.61)"""
    first = G[..., 0, :]
    first = first / np.linalg.norm(first, axis=-1, keepdims=True)
    normal = np.cross(G[..., 0, :], G[..., 1, :])
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    local = np.stack([first, np.cross(normal, first)], axis=-2)
    to_local = np.linalg.inv(np.einsum("...ik,...jk->...ij", G, local))  # rows: G_i in the local axes
    F = np.einsum("...ij,...jk->...ik", to_local, g)
    tensors: Floats = np.einsum("...ik,...jk->...ij", F, F)
    return tensors


def _heights(cells: Ids, x: Floats) -> Floats:
    """Mean over the nodes of each cell of the distance of its faces, along normals that neighbours share. eq. (5.62)

    Along the normal of one cell alone the sheet of a bent mesh would be thinner by the angle between neighbours.
    """
    half = cells.shape[1] // 2
    places = np.concatenate([FACE_NODES[:half], np.zeros((half, 1))], axis=1)
    _, dN = _core.shell_functions(2 * half, places)
    g = np.einsum("qia,eak->eqik", dN[:, :2], x[cells])
    normals = np.cross(g[:, :, 0], g[:, :, 1])
    below = cells[:, :half]
    shared = np.stack([np.bincount(below.ravel(), normals[..., k].ravel(), len(x)) for k in range(3)], axis=1)
    shared = shared[below] / np.linalg.norm(shared[below], axis=-1, keepdims=True)
    heights: Floats = np.abs(((x[cells[:, half:]] - x[below]) * shared).sum(axis=-1)).mean(axis=1)
    return heights


def forming_fields(mesh: Mesh, u: Floats, limit: FormingLimit | None = None) -> dict[str, Floats]:
    """Fields of the cells by their names, shape (cells,).

    Parameters
    ----------
    mesh : Mesh
        Undeformed mesh.
    u : ndarray, shape (n, 3) or (3 n,)
        Displacement of the nodes.
    limit : callable, optional
        Largest major strain for minor strains; with it comes ``limit_margin``, negative beyond the limit.

    Returns
    -------
    dict of str to ndarray
        ``major_<surface>`` and ``minor_<surface>`` for lower, middle and upper, ``thickness_strain``, ``thinning`` in
        per cent, and ``wrinkling``: the part of the compression in the plane that goes into the thickness, eq. (5.65).
    """
    strains = sheet_strains(mesh, u)
    fields = {f"major_{name}": values for name, values in strains.major.items()}
    fields |= {f"minor_{name}": values for name, values in strains.minor.items()}
    fields["thickness_strain"] = strains.thickness
    fields["thinning"] = 100.0 * (1.0 - np.exp(strains.thickness))
    fields["wrinkling"] = np.maximum(-(strains.major["middle"] + strains.minor["middle"]), 0.0)
    if limit is not None:
        fields["limit_margin"] = limit_margin(limit, strains.major["middle"], strains.minor["middle"])
    return fields


def beyond_limit(mesh: Mesh, fields: Mapping[str, Floats]) -> str | None:
    """How many elements are beyond the forming limit, by how much at most, and where; None if there are none.

    Parameters
    ----------
    mesh : Mesh
        Undeformed.
    fields : mapping of str to ndarray
        Of :func:`forming_fields`, with ``limit_margin``.
    """
    margin = fields["limit_margin"]
    if not (margin < 0.0).any():
        return None
    worst = int(np.argmin(margin))
    place = mesh.points[mesh.connectivity[worst]].mean(axis=0)
    where = f"at ({place[0]:.3g}, {place[1]:.3g}) of the blank"
    return f"{int((margin < 0.0).sum())} elements are beyond the forming limit, by {-margin[worst]:.3g} {where}"


def add_forming_fields(result: History, limit: FormingLimit | None = None) -> None:
    """Add the fields of forming to all frames of a result, so that its pictures, report and VTKHDF file have them.

    Parameters
    ----------
    result : History
        A result with frames.
    limit : callable, optional
        As for :func:`forming_fields`.
    """
    for frame in result.frames:
        frame.cells.update(forming_fields(result.model.mesh, frame.points["displacement"], limit))

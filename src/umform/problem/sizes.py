"""Size of the elements that a tool bends, in the direction of its curvature."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from umform.model import Model
from umform.model.contact import Contact
from umform.report.symmetry import mirrors_of_blank

Floats = NDArray[np.float64]
#: Ratio of the principal curvatures above which a tool is round in all directions.
_ROUND = 0.5


def size_near(contact: Contact, model: Model, axis: Sequence[float] | None) -> float:
    """Size of the facets nearest to a tool, across its radius.

    Parameters
    ----------
    contact : Contact
        The contact.
    model : Model
        Its model.
    axis : sequence of three floats, optional
        Direction of extrusion of a prismatic tool. Without it a strip that is one element wide bends along its length;
        other sheets bend in the direction in which the tool is curved next to them, or over the shorter sides of the
        facets where it has no such direction.
    """
    places = model.positions
    corners = places[contact.facets[:, :4]]
    sides = np.roll(corners, -1, axis=1) - corners
    lengths = np.linalg.norm(sides, axis=-1)
    gaps = contact.gap(corners.mean(axis=1))
    size = float(np.ptp(places, axis=0).max())
    if axis is not None:
        along = np.array(axis)
        lateral = np.linalg.norm(sides - (sides @ along)[..., None] * along, axis=-1)
        return float(lateral[_nearest(gaps, size)].max(axis=1).min())
    long = _along_a_strip(contact.facets[:, :4], lengths)
    if long is not None:
        return float(long[_nearest(gaps, size)].min())
    curvature, direction = _curvature(contact, corners.mean(axis=1))
    curved = np.isfinite(gaps) & (curvature[:, 1] * size > 1.0)
    normal = np.cross(sides[:, 0], sides[:, 1])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    lateral = direction - np.einsum("ek,ek->e", direction, normal)[:, None] * normal
    lateral /= np.maximum(np.linalg.norm(lateral, axis=1, keepdims=True), 1e-12)
    across = np.abs(np.einsum("esk,ek->es", sides, lateral)).max(axis=1)
    across = np.where(curvature[:, 0] > _ROUND * curvature[:, 1], lengths.min(axis=1), across)
    if curved.any():
        return float(across[_nearest(np.where(curved, gaps, np.nan), size)].min())
    return float(lengths[_nearest(gaps, size)].min())


def sheet_length(model: Model) -> float:
    """Largest extent of the whole sheet: of a half or a quarter, with its images."""
    spans = np.ptp(model.mesh.points, axis=0)
    for mirror in mirrors_of_blank(model):
        spans[mirror.axis] *= 2.0
    return float(spans.max())


def _nearest(gaps: Floats, size: float) -> NDArray[np.bool_]:
    """Mask of the smallest gaps."""
    mask: NDArray[np.bool_] = gaps <= np.nanmin(gaps) + 1e-9 * size
    return mask


def _along_a_strip(facets: NDArray[np.int32], lengths: Floats) -> Floats | None:
    """Lengths (facets,) along a strip that is one element wide; None for a wider sheet."""
    edges = np.sort(np.stack([facets, np.roll(facets, -1, axis=1)], axis=-1), axis=-1).reshape(-1, 2)
    _, which, counts = np.unique(edges, axis=0, return_inverse=True, return_counts=True)
    shared = np.asarray(counts[which.ravel()] > 1).reshape(len(facets), 4)
    free = ~shared[:, :2] & ~shared[:, 2:]  # both sides of a pair
    if not (shared.any(axis=1) & free.any(axis=1)).all():
        return None
    pairs = 0.5 * (lengths[:, :2] + lengths[:, 2:])
    return np.where(free[:, 0], pairs[:, 0], pairs[:, 1])


def _curvature(contact: Contact, points: Floats) -> tuple[Floats, Floats]:
    """Principal curvatures (n, 2) of the tool next to points, and the direction (n, 3) of the larger one. eq. (4.3)"""
    rotation, shift = contact.pose
    H = contact.tool.kernel.gap(np.ascontiguousarray((points - shift) @ rotation))[2]
    H = np.where(np.isfinite(H).all(axis=(1, 2), keepdims=True), H, 0.0)
    values, directions = np.linalg.eigh(H)
    return values[:, 1:], directions[:, :, 2] @ rotation.T

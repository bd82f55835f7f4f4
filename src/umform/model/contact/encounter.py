"""Estimates for a contact: thickness of the sheet, radius of the tool, line force between them.

Estimates suffice: a penalty may be wrong by a factor of two, and the history reports the resulting penetration.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.errors import InvalidPenalty, UmformError
from umform.materials import Material
from umform.mesh import Ids, Mesh
from umform.mesh.numbers import common, median, unique
from umform.mesh.part import sheets_of

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]

#: Shortest lever arm of the contact force in thicknesses: that of the narrowest die, shortened by its radii.
_ARM = 2.0
#: Largest radius that a sheet is bent to, in thicknesses: a strain of one per cent at its faces.
_FLATTEST = 50.0
#: Largest strain at which the bending stress is evaluated.
_LARGEST_STRAIN = 0.25
#: Time in which a law that depends on the rate reaches the strain: that of a step. In no time it would be elastic.
_TIME = 1.0


@dataclass(frozen=True)
class Layer:
    """A layer of a sheet: its law, and its thickness; None if it is the whole sheet."""

    material: Material
    thickness: float | None = None


@dataclass(frozen=True)
class Encounter:
    """Sheet and tool where the tool has its smallest radius.

    Attributes
    ----------
    thickness : float
        Thickness of the sheet, all layers together.
    radius : float
        Smallest radius of the tool, 0 for an edge; at most 50 thicknesses, because the sheet is curved too.
    length : float
        Length of a facet in the direction of the curvature of the tool.
    line_force : float
        Expected force per width. eq. (4.28)
    stiffness : float
        E / (1 - nu^2) behind the faces.
    depth : float
        Thickness of the metal with that stiffness: that of the sheet, or of the layer at the faces of clad metal.
    """

    thickness: float
    radius: float
    length: float
    line_force: float
    stiffness: float
    depth: float

    @property
    def flat(self) -> bool:
        """Whether the tool is flat everywhere."""
        return self.radius >= _FLATTEST * self.thickness

    @classmethod
    def of(cls, mesh: Mesh, faces: Ids, tool: _core.Surface, layers: Sequence[Layer], where: str) -> Encounter:
        """Evaluate mesh and tool in their present position, and the laws, that of the layer at the faces first."""
        h = sheet_thickness(mesh, faces)
        radius, length = _sharpest(mesh.points[mesh.facets_of(faces)[:, :4]], tool, _FLATTEST * h)
        strain = min(h / (2.0 * radius + h), _LARGEST_STRAIN)
        stretched = sum(bending_stress(one.material, strain, where) * (one.thickness or h) for one in layers)
        stiffness = bending_stress(layers[0].material, 1e-7, where) / 1e-7
        return cls(h, radius, length, stretched / (4.0 * _ARM), stiffness, layers[0].thickness or h)


def sheet_thickness(mesh: Mesh, faces: Ids | None = None) -> float:
    """Thickness of the sheet: the median over its cells, of stacked ones over its fibres; of several the smallest.

    ``faces``, rows (cell, face): only the sheets that these belong to, and the fibres that end there.
    """
    sheet = sheets_of(mesh)
    if faces is None:
        return min(cells_thickness(mesh, np.flatnonzero(sheet == one)) for one in unique(sheet).tolist())
    own = sheet[faces[:, 0]]
    return min(cells_thickness(mesh, np.flatnonzero(sheet == one), faces[own == one]) for one in unique(own).tolist())


def cells_thickness(mesh: Mesh, cells: Numbers, faces: Ids | None = None) -> float:
    """Thickness of some cells: their median, or that of the fibres through stacked ones, all or those of faces."""
    nodes, half = mesh.connectivity[cells], mesh.connectivity.shape[1] // 2
    lower, upper = nodes[:, :half], nodes[:, half:]
    if not len(common(lower, upper)):
        return median(np.linalg.norm(mesh.points[upper] - mesh.points[lower], axis=-1))
    above, below = np.arange(len(mesh.points)), np.arange(len(mesh.points))
    above[lower], below[upper] = upper, lower
    ends = unique(lower) if faces is None else mesh.nodes_on(faces)
    while not np.array_equal(ends, down := unique(below[ends])):
        ends = down
    length = np.zeros(len(ends))
    while not np.array_equal(ends, following := above[ends]):
        length += np.linalg.norm(mesh.points[following] - mesh.points[ends], axis=-1)
        ends = following
    return median(length)


def bending_stress(material: Material, strain: float, where: str) -> float:
    """Kirchhoff stress of a law in its virgin state at E11 = strain, E22 = 0 and S33 = 0: outer fibre of a wide bend.

    Raises
    ------
    InvalidPenalty
        If the law fails at such strains.
    """
    law = material.law()
    E, state = np.array([[strain, 0.0, -0.5 * strain, 0.0, 0.0, 0.0]]), law.initial()[None]
    try:
        for _ in range(50):
            S, CC, _ = law.respond(E, state, step=_TIME)
            change = -S[0, 2] / CC[0, 2, 2]
            E[0, 2] += change
            if abs(change) < 1e-6 * strain:
                break
        stress = float(law.respond(E, state, step=_TIME)[0][0, 0] * (1.0 + 2.0 * strain))
    except (UmformError, ValueError, ArithmeticError):
        stress = math.nan
    if not (math.isfinite(stress) and stress > 0.0):
        raise InvalidPenalty(
            "the law has no bending stress that a penalty could be estimated from",
            where=where,
            value=f"strain {strain:.3g}",
            remedy="give penalty and points: penalty = expected contact pressure / penetration that you allow",
        )
    return stress


def _sharpest(corners: Floats, tool: _core.Surface, flattest: float) -> tuple[float, float]:
    """Smallest radius of the tool next to some facets (facets, 4, 3), and the length of the facets across it.

    The largest eigenvalue of H at a distance g is 1 / (R + g), eq. (4.3); its eigenvector is the direction of
    curvature. On a sphere all directions of the face are.
    """
    grid = np.array([(r, s) for r in (-1.0, 0.0, 1.0) for s in (-1.0, 0.0, 1.0)])
    N = 0.25 * np.stack([(1 + a * grid[:, 0]) * (1 + b * grid[:, 1]) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
    gap, _, H = tool.gap(np.ascontiguousarray(np.einsum("aq,eak->eqk", N, corners).reshape(-1, 3)))
    defined = np.isfinite(gap) & np.isfinite(H).all(axis=(1, 2))  # violated on the axis of a tool
    gap, H = np.where(defined, gap, 0.0), np.where(defined[:, None, None], H, 0.0)
    values, directions = np.linalg.eigh(H)
    reach = flattest + np.maximum(gap, 0.0)
    round_ = values * reach[:, None] > 1.0
    radii = np.where(round_, np.maximum(1.0 / np.where(round_, values, 1.0) - gap[:, None], 0.0), flattest)
    radii = np.minimum(radii, flattest).reshape(len(corners), -1, 3)
    along = directions.reshape(*radii.shape, 3)
    edges = np.roll(corners, -1, axis=1) - corners
    radius = float(radii.min())
    if radius == flattest:  # flat everywhere: no direction is preferred
        return radius, float(np.linalg.norm(edges, axis=-1).max())
    sharp = (radii <= 2.0 * radius) & (radii < flattest)
    facet, point = np.nonzero(sharp.any(axis=2))
    across = (edges[facet] @ along[facet, point]) * sharp[facet, point, None]
    return radius, float(np.linalg.norm(across, axis=-1).max())

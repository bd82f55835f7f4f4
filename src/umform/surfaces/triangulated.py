"""Tools from triangles: a smooth surface through their corners."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from umform import _core
from umform.errors import InvalidValue, TurnedNormals
from umform.spec import check_arguments
from umform.spec.types import Sharp
from umform.surfaces.directions import positive
from umform.surfaces.smooth import Patches, connected, from_drawing, from_facets
from umform.surfaces.smooth import patches as smooth_patches
from umform.surfaces.stl import read_stl
from umform.surfaces.tool import Tool
from umform.surfaces.triangles import Floats, Ids, Triangles

#: Angle between facets from which on their edge is sharp, in degrees.
SHARP = 30.0
#: Weights of the corners of a third at which its height over the triangle is measured.
_SAMPLES = np.array([(4 - j - i, i, j) for j in range(5) for i in range(5 - j)]) / 4.0


@dataclass(frozen=True, eq=False)
class Triangulated(Tool):
    """Smooth surface through the corners of triangles: curved patches with one tangent plane along their edges.

    Parameters
    ----------
    surface : Triangles
        Points and triangles, counter-clockwise from outside of the tool. Points that coincide must be one.
    normals : ndarray, shape (m, 3, 3), optional
        Unit normals of the true surface at the corners of each triangle; else they follow from the triangles around a
        point.
    sharp : float
        Angle in degrees from which an edge is sharp: between two triangles, or between the given normals.
    open : bool
        The surface may have rims. A point whose nearest point is on a rim is outside of the tool.
    name : str
        For messages.

    Attributes
    ----------
    patches : Patches
        The curved patches.

    Raises
    ------
    UnfitTriangles, TurnedNormals, HoleInSurface
        If the triangles are no surface; the message names places.

    Examples
    --------
    >>> import umform as uf
    >>> faces = uf.Sphere((0, 0, 0), 5).triangles(((-6, -6, -6), (6, 6, 6)), chord=0.05)
    >>> ball = uf.Triangulated(faces)
    >>> round(float(ball.gap([(0.0, 0.0, 5.5)])[0][0]), 2)
    0.5
    """

    surface: Triangles
    normals: Floats | None = None
    sharp: Sharp = SHARP
    """Angle from which an edge is sharp."""
    open: bool = False
    name: str = "Triangulated"
    patches: Patches = field(init=False, repr=False)

    def __post_init__(self) -> None:
        check_arguments(Triangulated, self.name, sharp=self.sharp)
        _refuse_shape(self.normals, self.surface, self.name)
        edges = connected(self.surface, self.name, rims=self.open)
        if not (edges.mate < 0).any() and self.volume < 0.0:
            raise TurnedNormals(
                "the normals of a closed tool point into it",
                where=self.name,
                value=f"volume {self.volume:.6g}",
                cause="a file that describes the void, or turned faces",
                remedy="reversed() turns all of them; a void inside of a larger solid needs its outer faces too",
            )
        if self.normals is None:
            normals = from_facets(self.surface, edges, self.sharp, self.name)
        else:
            normals = from_drawing(self.surface, edges, self.normals, self.sharp, self.name)
        object.__setattr__(self, "patches", smooth_patches(self.surface, edges, normals))

    @classmethod
    def from_stl(
        cls, path: str | Path, *, sharp: float = sharp, open: bool = False, weld: float = 0.0, scale: float = 1.0
    ) -> Triangulated:
        """A tool from the triangles of an STL file.

        The file does not hold the true surface: normals are estimated from the triangles. Prefer a STEP file if there
        is one.

        Parameters
        ----------
        path : str or Path
            The file, binary or text.
        sharp : float
            Angle between two triangles, in degrees, from which their edge is sharp.
        open : bool
            The surface may have rims.
        weld : float
            Corners nearer than this are one point; by default 1e-6 of the size of the surface.
        scale : float
            Factor from the lengths of the file to those of the model: 25.4 from inches to millimetres.

        Raises
        ------
        FileProblem
            If the file cannot be read.
        UnfitTriangles, TurnedNormals, HoleInSurface
            If the triangles are no surface.
        """
        surface = read_stl(path, weld, positive(scale, "from_stl", "scale"))
        return cls(surface, None, sharp, open, Path(path).name)

    @cached_property
    def volume(self) -> float:
        """Volume inside of a closed surface, negative if the normals point into it."""
        a, b, c = np.moveaxis(self.surface.corners - self.surface.points.mean(axis=0), 1, 0)
        return float(np.einsum("ti,ti->", a, np.cross(b, c)) / 6.0)

    @cached_property
    def arrow(self) -> float:
        """Largest distance of the smooth surface from the triangles: about the error of the tessellation."""
        n = self.surface.area_vectors
        n = np.repeat(n / np.linalg.norm(n, axis=1, keepdims=True), 3, axis=0)
        beside = self.patches.at(_SAMPLES) - self.patches.control[:, None, 0]
        return float(np.abs(np.einsum("pki,pi->pk", beside, n)).max())

    @cached_property
    def largest_curvature(self) -> float:
        """Largest convex curvature in the middles of the thirds of all triangles; infinite with a sharp edge.

        A sheet bends over convex curvature. Concave edges do not count.
        """
        if self._has_convex_edge():
            return math.inf
        H = self.kernel().gap(self.patches.at(np.full((1, 3), 1.0 / 3.0))[:, 0])[2]
        return float(np.linalg.eigvalsh(H).max())

    def convex_radii(self) -> Iterator[float]:
        """One over the largest curvature."""
        if self.largest_curvature > 0.0:
            yield 1.0 / self.largest_curvature

    def _has_convex_edge(self) -> bool:
        """Whether the surface falls away beyond a sharp edge."""
        sharp = np.flatnonzero(self.patches.across == 1)
        beyond = self.surface.triangles.ravel()[_opposite(self.patches.neighbour[sharp])]
        n = self.surface.area_vectors[sharp // 3]
        rise = np.einsum("ei,ei->e", n, self.surface.points[beyond] - self.surface.points[self.patches.ends[sharp, 0]])
        return bool((rise < 0.0).any())

    def __str__(self) -> str:
        """Triangles, sharp edges and rims."""
        across = self.patches.across
        parts = [f"{len(self.surface.triangles)} triangles", f"{int((across == 1).sum()) // 2} sharp edges"]
        parts += [f"{int((across == 2).sum())} edges of rims"] if (across == 2).any() else []
        return f"{self.name}: {', '.join(parts)}; smooth surface up to {self.arrow:.2g} from them"

    def reversed(self) -> Triangulated:
        """The same surface with solid and void exchanged."""
        turned = Triangles(self.surface.points, self.surface.triangles[:, ::-1])
        normals = None if self.normals is None else -self.normals[:, ::-1]
        return replace(self, surface=turned, normals=normals)

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""
        return self._kernel

    @cached_property
    def _kernel(self) -> _core.Surface:
        return self.patches.kernel()

    def __getstate__(self) -> dict[str, object]:
        return {name: value for name, value in self.__dict__.items() if name != "_kernel"}  # rebuilt on demand

    def facets(self, centre: Floats, reach: float, chord: float) -> Triangles:
        """Flat triangles of the patches, within the chord error."""
        del centre, reach
        parts = math.ceil(math.sqrt(float(self.patches.bulge().max()) / chord)) if chord > 0.0 else 1
        return self.patches.facets(min(max(parts, 1), 16))


def _refuse_shape(normals: Floats | None, surface: Triangles, where: str) -> None:
    """Reject normals that are not three for each triangle."""
    if normals is not None and normals.shape != surface.corners.shape:
        raise InvalidValue(
            "there must be one normal for each corner of each triangle",
            where=f"{where}.normals",
            value=f"shape {normals.shape}, {len(surface.triangles)} triangles",
            cause="normals of points",
            remedy="normals[surface.triangles], of the shape (m, 3, 3)",
        )


def _opposite(edge: Ids) -> Ids:
    """The corner of a triangle that does not lie on one of its edges: edge e lies between corners e and e + 1."""
    return edge - edge % 3 + (edge % 3 + 2) % 3

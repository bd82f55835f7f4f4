"""Tools from the faces of a STEP or IGES file."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from umform import _core
from umform.errors import DrawingError, TurnedFaces, TurnedNormals
from umform.surfaces.cad.deviation import distances
from umform.surfaces.cad.elementary import elementary
from umform.surfaces.cad.opencascade import Face, Shape
from umform.surfaces.directions import positive
from umform.surfaces.stl import welded
from umform.surfaces.tool import Tool
from umform.surfaces.triangles import Floats, Ids, Triangles
from umform.surfaces.triangulated import Triangulated

#: Largest distance in mm of a tool from free-form faces, where none is given.
_FREE_FORM = 1e-3
#: Initial angle in radians by which triangles turn, smallest factor of the next attempt, number of attempts.
_ANGLE, _LEAST_SHARE, _ROUNDS = 0.35, 0.5, 8
#: More triangles are not tried.
_MOST = 100_000
#: Initial deviation of the triangles and distance of coincident points, relative to the size of the shape.
_ARROW, _WELD = 5e-3, 1e-7
#: Weights of the corners of a triangle at which the distance from a free form is measured.
_PLACES = np.array([(4, 1, 1), (1, 4, 1), (1, 1, 4), (2, 2, 2), (3, 3, 0), (0, 3, 3), (3, 0, 3)]) / 6.0


@dataclass(frozen=True, eq=False)
class CadTool(Tool):
    """A tool made of the faces of a CAD file.

    Planes, cylinders, cones, spheres and tori are exact; free-form faces are triangulated with their own normals and
    lie within :attr:`deviation` of the drawing.

    Made by :meth:`read`.

    Attributes
    ----------
    smooth : Triangulated
        The triangles of all faces.
    exact : tuple of Tool
        Infinite surfaces of the faces that have a formula.
    face : ndarray of int, shape (m,)
        That of each triangle, -1 on free forms.
    deviation : float
        Largest distance of the smooth surface of the triangles from the faces, measured at seven places of each
        triangle: the error of free-form faces, and of where the exact ones meet.
    kinds : dict of str to int
        How many faces there are of each kind.
    """

    smooth: Triangulated
    exact: tuple[Tool, ...]
    face: Ids
    deviation: float
    kinds: dict[str, int]

    @classmethod
    def read(
        cls,
        path: str | Path,
        *,
        tolerance: float | None = None,
        open: bool = False,
        sharp: float = 2.0,
        scale: float = 1.0,
    ) -> CadTool:
        """A tool from a STEP or IGES file, by OpenCASCADE: `pip install "umform[cad]"`.

        Parameters
        ----------
        path : str or Path
            A file that ends in .step, .stp, .iges or .igs.
        tolerance : float
            Largest :attr:`deviation`, in the unit of the model; triangles are refined until it is met. By default
            0.001 mm.
        open : bool
            The faces may have rims, as a die face without its block. A point whose nearest point is on a rim is
            outside of the tool.
        sharp : float
            Angle in degrees between two faces from which their edge is sharp.
        scale : float
            Factor from millimetres to the unit of the model.

        Raises
        ------
        FileProblem
            If the file cannot be read.
        DrawingError
            If the faces are no surface, or the tolerance is not met; the message names places.
        """
        shape = Shape(path, positive(scale, "CadTool.read", "scale"))
        tolerance = _FREE_FORM * scale if tolerance is None else positive(tolerance, "CadTool.read", "tolerance")
        angle, arrow, found = _ANGLE, _ARROW * shape.size, "folds"
        for _ in range(_ROUNDS):
            share = _LEAST_SHARE
            try:
                made = _tool(shape, arrow, angle, sharp, open)
            except TurnedFaces:  # at any size of the triangles
                raise
            except TurnedNormals as error:  # triangles may be too coarse for the radii
                refusal: DrawingError | None = error
            else:
                if made.deviation <= tolerance:
                    return made
                refusal, found = None, f"{made.deviation:.3g} with {len(made.face)} triangles"
                wanted = (tolerance / made.deviation) ** (1.0 / 3.0)  # third order
                if len(made.face) > _MOST * wanted**2:
                    break
                share = min(max(wanted, share), 0.9)
            angle, arrow = share * angle, share**2 * arrow
        if refusal is not None:
            raise refusal
        raise DrawingError(
            "the triangles of the faces do not reach the tolerance",
            where=str(path),
            value=f"{found}, {tolerance:.3g} is allowed",
            cause="a tolerance far below the size of the radii, or faces with kinks",
            remedy="a larger tolerance, or faces without kinks",
        )

    @property
    def surface(self) -> Triangles:
        """Points and triangles on the faces."""
        return self.smooth.surface

    @property
    def largest_curvature(self) -> float:
        """Largest convex curvature; infinite with a sharp edge."""
        return self.smooth.largest_curvature

    def convex_radii(self) -> Iterator[float]:
        """One over the largest curvature."""
        return self.smooth.convex_radii()

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""
        return self._kernel

    @cached_property
    def _kernel(self) -> _core.Surface:
        faces = [tool.kernel() for tool in self.exact]
        trust = 2.0 * self.deviation + 1e-9 * float(np.abs(self.surface.points).max())
        return self.smooth.patches.kernel(faces, np.repeat(self.face, 3), trust)

    def __getstate__(self) -> dict[str, object]:
        return {name: value for name, value in self.__dict__.items() if name != "_kernel"}  # rebuilt on demand

    def facets(self, centre: Floats, reach: float, chord: float) -> Triangles:
        """Flat triangles of the patches."""
        return self.smooth.facets(centre, reach, chord)

    def __str__(self) -> str:
        """Faces, triangles and deviation."""
        kinds = ", ".join(f"{count} {kind}" for kind, count in sorted(self.kinds.items()))
        return (
            f"{self.smooth.name}: {kinds}; {len(self.face)} triangles, smooth surface within {self.deviation:.2g} of "
            "the faces"
        )


def _tool(shape: Shape, arrow: float, angle: float, sharp: float, rims: bool) -> CadTool:
    """Triangles of one size, their normals, and their distance from the faces."""
    faces = shape.faces(arrow, angle)
    tools = [elementary(face) for face in faces]
    first = np.cumsum([0] + [len(face.points) for face in faces])
    points = np.concatenate([face.points for face in faces])
    triangles = np.concatenate([face.triangles + start for face, start in zip(faces, first[:-1], strict=True)])
    of = np.repeat(np.arange(len(faces)), [len(face.triangles) for face in faces])
    normals = np.concatenate([face.normals() for face in faces])[triangles]
    surface, kept = welded(points, triangles, _WELD * shape.size)
    smooth = Triangulated(surface, normals[kept], sharp, rims, shape.path.name)
    own = [k for k, tool in enumerate(tools) if tool is not None]
    number = np.full(len(faces), -1)
    number[own] = np.arange(len(own))
    uv = np.concatenate([face.uv for face in faces])[triangles][kept]
    return CadTool(
        smooth,
        tuple(tool for tool in tools if tool is not None),
        number[of[kept]],
        _deviation(smooth, faces, tools, of[kept], uv),
        dict(Counter(face.kind for face in faces)),
    )


def _deviation(smooth: Triangulated, faces: list[Face], tools: list[Tool | None], of: Ids, uv: Floats) -> float:
    """Largest distance of the smooth surface from the faces."""
    x = smooth.patches.at_triangles(_PLACES)
    guess = np.einsum("kw,twi->tki", _PLACES, uv)
    largest = 0.0
    for k, (face, tool) in enumerate(zip(faces, tools, strict=True)):
        own = of == k
        places, near = x[own].reshape(-1, 3), guess[own].reshape(-1, 2)
        off = distances(face, places, near) if tool is None else np.abs(tool.gap(places)[0])
        largest = max(largest, float(off.max(initial=0.0)))
    return largest

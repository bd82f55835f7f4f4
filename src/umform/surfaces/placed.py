"""Tools at another place: turned, shifted, mirrored."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from umform import _core
from umform.errors import InvalidValue
from umform.surfaces.directions import Direction, Point, point, rotation_matrix, unit_vector
from umform.surfaces.tool import Surface, Tool
from umform.surfaces.triangles import Floats, Triangles

Matrix = tuple[Point, Point, Point]


@dataclass(frozen=True)
class Placed(Tool):
    """A tool whose points X lie at Q X + c. eq. (4.18)

    Made by :meth:`Tool.moved` and :meth:`Tool.mirrored`. Distances stay what they are, so this is exact.

    Parameters
    ----------
    tool : Surface
        The tool in its own frame.
    matrix : tuple of three rows of three numbers
        Orthogonal matrix Q: a rotation, or a reflection.
    shift : tuple of float
        c.
    """

    tool: Surface
    matrix: Matrix
    shift: Point

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""
        Q = np.array([point(row, "Placed.matrix") for row in self.matrix])
        if np.abs(Q @ Q.T - np.eye(3)).max() > 1e-12:
            raise InvalidValue(
                "the matrix of a placed tool must be orthogonal",
                where="Placed.matrix",
                value=Q,
                cause="a matrix that stretches, or rounded numbers",
                remedy="use moved and mirrored of the tool, which make it",
            )
        return _core.placed(self.tool.kernel(), Q, point(self.shift, "Placed.shift"))

    def facets(self, centre: Floats, reach: float, chord: float) -> Triangles:
        """Those of the tool, placed; a mirror turns them over."""
        if not isinstance(self.tool, Tool):
            return super().facets(centre, reach, chord)  # by samples
        Q, c = np.array(self.matrix), np.array(self.shift)
        own = self.tool.facets((centre - c) @ Q, reach, chord)
        step = 1 if np.linalg.det(Q) > 0 else -1
        return Triangles(own.points @ Q.T + c, own.triangles[:, ::step])


def moved(tool: Surface, translation: Point, rotation: Point) -> Placed:
    """A tool that is turned by a rotation vector about the origin and then shifted."""
    return _after(tool, rotation_matrix(point(rotation, "rotation")), np.array(point(translation, "translation")))


def mirrored(tool: Surface, normal: Direction, at: Point) -> Placed:
    """The mirror image of a tool: Q = 1 - 2 n n^T."""
    n = np.array(unit_vector(normal, "mirror"))
    through = np.array(point(at, "mirror"))
    return _after(tool, np.eye(3) - 2.0 * np.outer(n, n), 2.0 * (through @ n) * n)


def _after(tool: Surface, Q: Floats, c: Floats) -> Placed:
    """Placing a placed tool makes one placed tool."""
    if isinstance(tool, Placed):
        c = Q @ np.array(tool.shift) + c
        Q = Q @ np.array(tool.matrix)
        tool = tool.tool
    rows = [(float(a), float(b), float(c)) for a, b, c in Q]
    return Placed(tool, (rows[0], rows[1], rows[2]), (float(c[0]), float(c[1]), float(c[2])))

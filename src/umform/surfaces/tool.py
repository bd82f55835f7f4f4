"""What all tools have in common: a kernel, and copies at other places."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from umform import _core
from umform.errors import InvalidValue
from umform.surfaces.directions import Direction, Point

if TYPE_CHECKING:
    from umform.surfaces.placed import Placed
    from umform.surfaces.triangles import Box3, Floats, Triangles


@runtime_checkable
class Surface(Protocol):
    """A rigid tool."""

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""


class Tool(ABC):
    """A rigid tool that can be placed anew and drawn."""

    @abstractmethod
    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""

    def gap(self, x: ArrayLike) -> tuple[Floats, Floats, Floats]:
        """Signed distance, normal and Hessian of the distance at some points. eq. (4.1)

        Parameters
        ----------
        x : array_like, shape (n, 3)
            Positions.

        Returns
        -------
        g : ndarray, shape (n,)
            Distance, negative inside of the tool.
        n : ndarray, shape (n, 3)
            Unit normal out of the tool.
        H : ndarray, shape (n, 3, 3)
            Second derivative of the distance.

        Raises
        ------
        InvalidValue
            If x has another shape.
        """
        points = np.ascontiguousarray(x, dtype=float)
        if points.ndim != 2 or points.shape[1] != 3:
            raise InvalidValue(
                "positions must have the shape (n, 3)",
                where="gap",
                value=points.shape,
                cause="one point, or points as columns",
                remedy="np.atleast_2d(x), or x.T",
            )
        return self.kernel().gap(points)

    def moved(self, translation: Point = (0.0, 0.0, 0.0), rotation: Point = (0.0, 0.0, 0.0)) -> Placed:
        """The same tool, turned about the origin and then shifted.

        Parameters
        ----------
        translation : tuple of float
            Shift, after the rotation.
        rotation : tuple of float
            Rotation vector: axis times angle in radians.
        """
        from umform.surfaces.placed import moved  # a placed tool is a tool

        return moved(self, translation, rotation)

    def mirrored(self, normal: Direction, point: Point = (0.0, 0.0, 0.0)) -> Placed:
        """The mirror image of the tool.

        Parameters
        ----------
        normal : str or tuple of float
            Direction across the mirror.
        point : tuple of float
            A point of the mirror.
        """
        from umform.surfaces.placed import mirrored  # a placed tool is a tool

        return mirrored(self, normal, point)

    def triangles(self, box: Box3, chord: float = 0.0) -> Triangles:
        """The surface of the tool inside of a box, for pictures and files.

        Parameters
        ----------
        box : tuple of two points
            Lowest and highest corner.
        chord : float, optional
            Largest distance of a triangle from the true surface; by default 1/1000 of the diagonal of the box.

        Returns
        -------
        Triangles
            Points and triangles, counter-clockwise from outside of the tool.
        """
        from umform.surfaces.triangles import inside_of  # knows the shapes of tools

        return inside_of(self.facets, box, chord)

    def facets(self, centre: Floats, reach: float, chord: float) -> Triangles:
        """Triangles of the surface that cover at least the ball about ``centre`` with the radius ``reach``.

        Tools that know their shape give their own; of any other the distance is sampled.

        Raises
        ------
        InvalidValue
            If the distance cannot be sampled.
        """
        from umform.surfaces.sampled import sampled  # most tools do without

        return sampled(self.kernel().gap, centre, reach, chord)

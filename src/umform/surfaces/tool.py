"""Base of all tools: the kernel's surface, and transformed copies."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from umform import _core
from umform.errors import InvalidValue
from umform.mesh import Mesh
from umform.spec import ParametersInNotebook, check_fields
from umform.surfaces.block import elastic_body
from umform.surfaces.directions import Direction, Point, Point2, point, rotation_matrix, unit_vector
from umform.surfaces.offset_field import RIGHT, OffsetField
from umform.surfaces.profile import Profile
from umform.surfaces.triangles import Box3, Floats, Triangles, halved


@runtime_checkable
class Surface(Protocol):
    """A rigid tool."""

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""


def check_is_surface(tool: object, where: str) -> None:
    """Refuse what is no surface of a tool."""
    if isinstance(tool, type) or not callable(getattr(tool, "kernel", None)):
        raise InvalidValue(
            "a tool must be a surface",
            where=where,
            value=type(tool).__name__,
            cause="a function or a class in place of a surface, or what tool() returned",
            remedy="a tool of umform.surfaces, VDie or Cylinder for instance, or UserSurface(function)",
        )


class Tool(ABC):
    """A rigid tool that can be transformed and drawn."""

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
        """The same tool, rotated about the origin and then shifted.

        Parameters
        ----------
        translation : tuple of float
            Shift, after the rotation.
        rotation : tuple of float
            Rotation vector: axis times angle in radians.
        """
        return _moved(self, translation, rotation)

    def mirrored(self, normal: Direction, point: Point = (0.0, 0.0, 0.0)) -> Placed:
        """The mirror image of the tool.

        Parameters
        ----------
        normal : str or tuple of float
            Normal of the mirror plane.
        point : tuple of float
            A point of the mirror plane.
        """
        return _mirrored(self, normal, point)

    def offset(self, distance: float | OffsetField) -> Tool:
        """The tool offset outward by a distance, or inward by a negative one.

        Parameters
        ----------
        distance : float or OffsetField
            Offset of its surface, which may vary over it. Convex edges become round, concave radii below the distance
            vanish.
        """
        return OffsetByField(self, distance) if isinstance(distance, OffsetField) else Offset(self, distance)

    def counterpart(self, thickness: float) -> Offset:
        """The region beyond a sheet that lies on the tool: the punch for a die.

        Parameters
        ----------
        thickness : float
            Thickness of the sheet, and of the clearance with it.
        """
        return Offset(self, thickness, other_side=True)

    def along(self) -> Point | None:
        """Direction along which it does not vary; None if there is none."""
        return None

    def section(self) -> Swept | None:
        """The profile that is extruded or revolved, as a drawing shows it; None if there is none."""
        return None

    def elastic_body(self, face: tuple[Point2, Point2], back: tuple[Point2, Point2], **options: Any) -> Mesh:
        """Mesh of a part of the tool, for a tool that deforms; see :func:`umform.surfaces.block.elastic_body`.

        Raises
        ------
        InvalidValue
            If the tool is neither extruded nor revolved.
        """
        section = self.section()
        if section is None:
            raise InvalidValue(
                "this tool has no profile under which a block of elements fits",
                where="elastic_body",
                value=type(self).__name__,
                cause="it is neither extruded nor revolved",
                remedy="a mesh of its own: uf.mesh.read(path)",
            )
        return elastic_body(section, face, back, **options)

    def convex_radii(self) -> Iterator[float]:
        """Radii over which a sheet may bend, 0 at a sharp edge; nothing if they are unknown."""
        yield from ()

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
        from umform.surfaces.triangles import inside_of  # imports the shapes of tools

        return inside_of(self.facets, box, chord)

    def facets(self, centre: Floats, reach: float, chord: float) -> Triangles:
        """Triangles of the surface that cover at least the ball about ``centre`` with the radius ``reach``.

        Those of the section; without one, the distance is sampled. Other shapes have their own method.

        Raises
        ------
        InvalidValue
            If the distance cannot be sampled.
        """
        section = self.section()
        if section is not None:
            return section.facets(centre, reach, chord)
        from umform.surfaces.sampled import sampled  # imported late: few tools need it

        return sampled(self.kernel().gap, centre, reach, chord)


@dataclass(frozen=True)
class ToolSpec(ParametersInNotebook, Tool):
    """A tool that its fields declare: with the same name in Python, as `shape` in decks, and in their schema.

    A subclass is a frozen dataclass, its fields are annotated as in `umform.spec`.
    """

    def __post_init__(self) -> None:
        check_fields(self)


class Swept(ToolSpec):
    """A profile that is extruded or revolved."""

    profile: Profile
    """Section."""

    @abstractmethod
    def placed(self, Q: Floats, c: Floats) -> Swept:
        """The same whose points X lie at Q X + c, with an orthogonal matrix Q."""

    @property
    @abstractmethod
    def right_handed(self) -> bool:
        """Whether the two directions of the section and the third one of :meth:`in_space` are a right-handed frame."""

    @abstractmethod
    def third(self, width: float | None, sector: float | None, elements: int) -> Floats:
        """Borders of elements along the third direction: over a width, or over a sector in degrees; one of both."""

    @abstractmethod
    def in_space(self, plane: Floats, third: Floats) -> Floats:
        """Points of the section (n, 2) in space, at distances (n,) from its plane or turned by angles in radians."""


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
        """Those of the tool, transformed; a reflection reverses their order."""
        if not isinstance(self.tool, Tool):
            return super().facets(centre, reach, chord)  # by samples
        Q, c = np.array(self.matrix), np.array(self.shift)
        own = self.tool.facets((centre - c) @ Q, reach, chord)
        step = 1 if np.linalg.det(Q) > 0 else -1
        return Triangles(own.points @ Q.T + c, own.triangles[:, ::step])

    def along(self) -> Point | None:
        """That of the tool, transformed."""
        own = self.tool.along() if isinstance(self.tool, Tool) else None
        if own is None:
            return None
        a, b, c = (float(part) for part in np.array(self.matrix) @ own)
        return a, b, c

    def section(self) -> Swept | None:
        """That of the tool, transformed."""
        own = self.tool.section() if isinstance(self.tool, Tool) else None
        return None if own is None else own.placed(np.array(self.matrix), np.array(self.shift))

    def convex_radii(self) -> Iterator[float]:
        """Those of the tool."""
        return self.tool.convex_radii() if isinstance(self.tool, Tool) else super().convex_radii()


@dataclass(frozen=True)
class Offset(Tool):
    """A tool offset from another one. eq. (4.172)

    Made by :meth:`Tool.offset` and :meth:`Tool.counterpart`; as exact as the distance to the tool.

    Parameters
    ----------
    tool : Surface
        The tool.
    distance : float
        Distance of the new surface from that of the tool, positive outward.
    other_side : bool
        The solid is the region beyond the new surface.
    """

    tool: Surface
    distance: float
    other_side: bool = False

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""
        if not np.isfinite(self.distance):
            raise InvalidValue(
                "the distance to another tool must be finite",
                where="Offset.distance",
                value=self.distance,
                cause="nan or inf",
                remedy="the thickness of the sheet",
            )
        return _core.offset(self.tool.kernel(), float(self.distance), -1 if self.other_side else 1)

    def facets(self, centre: Floats, reach: float, chord: float) -> Triangles:
        """Those of the tool moved along its normals, except parts that are nearer to another part of it."""
        if not isinstance(self.tool, Tool):
            return super().facets(centre, reach, chord)  # by samples
        own = self.tool.facets(centre, reach + abs(self.distance), chord)
        kernel = self.tool.kernel()
        points = own.points + self.distance * kernel.gap(np.ascontiguousarray(own.points))[1]
        there = np.abs(kernel.gap(points)[0] - self.distance) <= 1e-6 * abs(self.distance) + 0.5 * chord
        return Triangles(points, own.triangles[there[own.triangles].all(axis=1)][:, :: -1 if self.other_side else 1])

    def along(self) -> Point | None:
        """That of the tool."""
        return self.tool.along() if isinstance(self.tool, Tool) else None

    def convex_radii(self) -> Iterator[float]:
        """Those of the tool and the distance; unknown on the other side."""
        if isinstance(self.tool, Tool) and not self.other_side:
            yield from (max(radius + self.distance, 0.0) for radius in self.tool.convex_radii())


@dataclass(frozen=True)
class OffsetByField(Tool):
    """A tool grown by a field: its surface is where the distance to the tool is the value of the field. eq. (4.264)

    Made by :meth:`Tool.offset`. Its gap is the exact distance to this surface, with its unit normal and Hessian.

    Parameters
    ----------
    tool : Surface
        The tool.
    field : OffsetField
        The offset, in the frame of the tool.
    """

    tool: Surface
    field: OffsetField

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""
        return self.field.kernel(self.tool.kernel())

    def facets(self, centre: Floats, reach: float, chord: float) -> Triangles:
        """Those of the tool, as small as the field needs, moved to the surface."""
        if not isinstance(self.tool, Tool):
            return super().facets(centre, reach, chord)  # by samples
        largest = float(np.abs(self.field.values).max())
        own = halved(self.tool.facets(centre, reach + largest, chord), self.field.edge(chord))
        kernel, points = self.kernel(), own.points
        for _ in range(3):
            g, n, _ = kernel.gap(np.ascontiguousarray(points))
            points = points - g[:, None] * n
        return Triangles(points, own.triangles)

    def along(self) -> Point | None:
        """That of the tool, if the field does not vary along it."""
        own = self.tool.along() if isinstance(self.tool, Tool) else None
        varies = own and any(abs(np.dot(unit_vector(one), own)) > RIGHT for one in self.field.along)
        return None if varies else own

    def convex_radii(self) -> Iterator[float]:
        """Those of the tool: the field changes them little."""
        return self.tool.convex_radii() if isinstance(self.tool, Tool) else super().convex_radii()


def _moved(tool: Surface, translation: Point, rotation: Point) -> Placed:
    """A tool rotated by a rotation vector about the origin and then shifted."""
    return _after(tool, rotation_matrix(point(rotation, "rotation")), np.array(point(translation, "translation")))


def _mirrored(tool: Surface, normal: Direction, at: Point) -> Placed:
    """The mirror image of a tool: Q = 1 - 2 n n^T."""
    n = np.array(unit_vector(normal, "mirror"))
    through = np.array(point(at, "mirror"))
    return _after(tool, np.eye(3) - 2.0 * np.outer(n, n), 2.0 * (through @ n) * n)


def _after(tool: Surface, Q: Floats, c: Floats) -> Placed:
    """Combine two transformations to one."""
    if isinstance(tool, Placed):
        c = Q @ np.array(tool.shift) + c
        Q = Q @ np.array(tool.matrix)
        tool = tool.tool
    rows = [(float(a), float(b), float(c)) for a, b, c in Q]
    return Placed(tool, (rows[0], rows[1], rows[2]), (float(c[0]), float(c[1]), float(c[2])))

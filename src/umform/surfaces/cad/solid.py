"""The faces and edges of one solid of a STEP file, as numbers: what planes and cylinders are, and which faces meet."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from umform.surfaces.triangles import Floats

#: Angle in radians by which the normals of two faces that go on smoothly may differ.
SMOOTH = math.radians(0.5)


@dataclass(frozen=True, eq=False)
class SolidEdge:
    """An edge of a solid.

    Attributes
    ----------
    faces : tuple of int
        Numbers of the faces that meet there.
    kind : str
        Line, Circle, or another word for another curve.
    points : ndarray, shape (n, 3)
        Points along it, both ends among them: two of a line; of other curves as many as keep within the deviation.
    centre : ndarray, shape (3,), optional
        Of a circle.
    smooth : bool
        The normals of both faces agree along it.
    """

    faces: tuple[int, ...]
    kind: str
    points: Floats
    centre: Floats | None
    smooth: bool


@dataclass(frozen=True, eq=False)
class SolidFace:
    """A face of a solid.

    Attributes
    ----------
    number : int
        Its place in the solid, from 1.
    kind : str
        Plane, Cylinder, or another word.
    point : ndarray, shape (3,)
        A point of the plane, or of the axis of the cylinder.
    direction : ndarray, shape (3,)
        Unit normal out of the solid, or direction of the axis.
    radius : float
        Of the cylinder; else 0.
    convex : bool
        The normal out of the solid points away from the axis of the cylinder.
    area : float
        Area.
    corners : ndarray, shape (n, 3, 3)
        Its triangles, coarse on curved faces.
    edges : tuple of int
        Places of its edges in `Solid.edges`.
    """

    number: int
    kind: str
    point: Floats
    direction: Floats
    radius: float
    convex: bool
    area: float
    corners: Floats
    edges: tuple[int, ...]

    @property
    def inside(self) -> Floats:
        """Middle of its largest triangle."""
        return np.asarray(self.corners[self._sizes.argmax()].mean(axis=0))

    @property
    def _sizes(self) -> Floats:
        x = self.corners
        return np.asarray(np.linalg.norm(np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]), axis=1))

    def covers(self, x: Floats) -> bool:
        """Whether a point of its plane lies on this flat face."""
        ways = self.corners - x
        sides = np.cross(ways, np.roll(ways, -1, axis=1)) @ self.direction
        return bool(((sides >= 0.0).all(axis=1) | (sides <= 0.0).all(axis=1)).any())

    def normal(self, x: Floats) -> Floats:
        """Unit normal out of the solid at a point of a plane or cylinder."""
        if self.kind == "Plane":
            return self.direction
        arm = x - self.point
        arm = arm - (arm @ self.direction) * self.direction
        return np.asarray(arm / np.linalg.norm(arm) * (1.0 if self.convex else -1.0))


@dataclass(frozen=True, eq=False)
class Solid:
    """One solid of a STEP file in millimetres.

    Attributes
    ----------
    path : Path
        The file.
    unit : str
        Unit of the file, as it names it.
    faces : dict of int to SolidFace
        Faces by their numbers.
    edges : tuple of SolidEdge
        Edges.
    volume : float
        Volume.
    deviation : float
        Largest distance of the polylines of curved edges from the curves.
    """

    path: Path
    unit: str
    faces: dict[int, SolidFace]
    edges: tuple[SolidEdge, ...]
    volume: float
    deviation: float

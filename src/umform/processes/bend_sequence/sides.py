"""Both sides of a bend in a strip: sections as of single bends, in the frame of the bend, and lines of its legs."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.mesh import Mesh
from umform.model.transfer.rigid_motion import RigidMotion
from umform.processes.air_bending.section import Section

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Strip:
    """Section of the strip, the lines of nodes through the thickness one after the other.

    Attributes
    ----------
    reference, current : ndarray, shape (lines, levels, 2)
        Positions (x, z) of the nodes; levels from the lower to the upper face of the flat strip.
    order : int
        1, or 2 with a line of nodes in the middle of each element.
    """

    reference: Floats
    current: Floats
    order: int

    @classmethod
    def of(cls, mesh: Mesh, u: Floats, edge: str = "y0") -> Strip:
        """Section of a mesh of a flat strip under displacements u, shape (n, 3) or (3 n,).

        It is the mean of the faces y0, whose nodes are the set `edge`, and y1: in an oblique rolling direction the
        strip shears.
        """
        section = Section.of(mesh, u, [edge, edge.replace("y0", "y1")])
        return cls(section.reference, section.current, section.order)

    def at(self, position: float, *, over: bool) -> Strip:
        """The strip with flat coordinates relative to a bend line; turned over, above and below are exchanged."""
        reference = self.reference - np.array([position, 0.0])
        if not over:
            return Strip(reference, self.current, self.order)
        turned = np.array([0.0, self.thickness]) - reference
        return Strip(turned[::-1, ::-1], self.current[::-1, ::-1], self.order)

    @property
    def thickness(self) -> float:
        """Thickness of the flat strip."""
        return float(self.reference[0, :, 1].max() - self.reference[0, :, 1].min())

    @property
    def middle(self) -> Floats:
        """Positions (lines, 2) half way between lower and upper face."""
        half: Floats = 0.5 * (self.current[:, 0] + self.current[:, -1])
        return half

    @property
    def outline(self) -> Floats:
        """Outline (n, 2): one face from one end to the other, then the other face back."""
        around: Floats = np.concatenate([self.current[:, 0], self.current[::-1, -1]])
        return around

    def laid(self, reach: float) -> RigidMotion:
        """Motion that places the strip within ``reach`` of x = 0 on the plane z = 0, its middle at x = 0.

        The straight line is the least-squares fit of the mid-surface there.
        """
        s = self.reference[:, 0, 0]
        near = np.abs(s) <= reach
        x = self.middle[near]
        centre = x.mean(axis=0)
        along = np.linalg.svd(x - centre)[2][0]
        along *= np.sign(along @ (x[-1] - x[0]))
        start = self.middle[np.abs(s).argmin()]
        foot = centre + along * ((start - centre) @ along)
        target = np.array([0.0, 0.5 * self.thickness])
        return RigidMotion.in_section(-math.atan2(along[1], along[0]), foot, target)

    def sides(self, half_length: float) -> Sides:
        """Both sides of the bend line at x = 0, of whole elements, up to half_length or to the end of the strip."""
        s = self.reference[:, 0, 0]
        edge = half_length * (1.0 + 1e-9)
        origin = self.middle[np.abs(s).argmin()]
        right, left = self._lines((s > -1e-9) & (s <= edge)), self._lines((s < 1e-9) & (s >= -edge))[::-1]
        x = (self.current - origin) @ _turn(-self._tangent())
        halves = (self.reference[right], x[right]), (self.reference[left] * _MIRROR, x[left] * _MIRROR)
        slopes = [Section(X, c, self.order).slope for X, c in halves]
        lean = 0.5 * (slopes[0] - slopes[1])
        sections = [Section(X, c @ _turn(turn), self.order) for (X, c), turn in zip(halves, (-lean, lean), strict=True)]
        legs = [Leg.of(section, self.current[lines, 0]) for section, lines in zip(sections, (right, left), strict=True)]
        return Sides(sections[0], sections[1], legs[0], legs[1])

    def _lines(self, chosen: NDArray[np.bool_]) -> NDArray[np.int64]:
        """Indices of the lines of whole elements in a selection; the bend line is a border of elements."""
        numbers = np.flatnonzero(chosen)
        inner = slice(0, len(numbers) - (len(numbers) - 1) % self.order)
        ends_in_the_middle = abs(self.reference[numbers[0], 0, 0]) > 1e-9  # the left side ends with the bend line
        return numbers[(len(numbers) - 1) % self.order :] if ends_in_the_middle else numbers[inner]

    def _tangent(self) -> float:
        """Direction of the mid-surface at the bend line, in radians."""
        k = int(np.abs(self.reference[:, 0, 0]).argmin())
        along = self.middle[k + 1] - self.middle[k - 1]
        return math.atan2(along[1], along[0])


@dataclass(frozen=True)
class Leg:
    """Straight line of a leg on its outer face, in the present position of the strip.

    Attributes
    ----------
    point, direction : ndarray, shape (2,)
        A point, and the unit vector away from the bend.
    """

    point: Floats
    direction: Floats

    @classmethod
    def of(cls, section: Section, face: Floats) -> Leg:
        """Best-fit line through the outermost two thicknesses of the outer face (lines, 2), away from the bend."""
        X = section.reference[:, 0, 0]
        x = face[min(section.half_length - 2.0 * section.thickness, X[-1 - section.order]) - 1e-9 < X]
        direction = np.linalg.svd(x - x.mean(axis=0))[2][0]
        return cls(x.mean(axis=0), direction * np.sign(direction @ (x[-1] - x[0])))


@dataclass(frozen=True)
class Sides:
    """Both sides of a bend.

    Attributes
    ----------
    right, left : Section
        Sections in a frame in which both legs have the same slope; the left one is mirrored.
    right_leg, left_leg : Leg
        Lines of the legs in the present position of the strip.
    """

    right: Section
    left: Section
    right_leg: Leg
    left_leg: Leg

    @property
    def angle(self) -> float:
        """Angle between the legs in degrees."""
        return self.right.angle

    @property
    def apex(self) -> Floats:
        """Intersection of the lines of the outer faces."""
        a, b = self.right_leg, self.left_leg
        way = np.linalg.solve(np.stack([a.direction, -b.direction], axis=1), b.point - a.point)
        corner: Floats = a.point + way[0] * a.direction
        return corner


_MIRROR = np.array([-1.0, 1.0])


def _turn(angle: float) -> Floats:
    """Matrix that rotates rows (x, z) by an angle, from x to z."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, s], [-s, c]])

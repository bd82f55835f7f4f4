"""Outlines that each ray from a centre meets once, and meshes stretched to them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.errors import FoldedElement, InvalidValue, InvertedElement
from umform.mesh import Mesh

Floats = NDArray[np.float64]

_TURN = 2.0 * math.pi
#: Angle below which a ray goes through a point, and length over the size below which points are one.
_HAIR = 1e-9
#: Angle by which an outline may end before a ray.
_SHORT = 1e-3
#: Part of the way from the centre to the edge on which a mesh stays as it is.
KEPT = 0.5


@dataclass(frozen=True, eq=False)
class Star:
    """An outline around a centre, closed, or the part of it in a sector.

    Attributes
    ----------
    centre : ndarray, shape (2,)
        In x and y.
    points : ndarray, shape (n, 2) or (n, 3)
        Corners, counter-clockwise about the centre.
    """

    centre: Floats
    points: Floats

    @classmethod
    def of(cls, points: ArrayLike, centre: ArrayLike, where: str) -> Star:
        """The outline with these corners, in their order, either way around; a repeated corner counts once.

        Raises
        ------
        InvalidValue
            If a ray from the centre meets it twice; ``where`` names it.
        """
        x, c = np.asarray(points, dtype=float), np.asarray(centre, dtype=float)
        if x.ndim != 2 or x.shape[1] not in (2, 3) or len(x) < 3 or not np.isfinite(x).all():
            raise InvalidValue(
                "an outline has at least three corners with two or three coordinates",
                where=where,
                value=f"an array of shape {x.shape}",
                cause="another table, or a missing number",
                remedy="columns x, y or x, y, z",
            )
        hair = _HAIR * float(np.ptp(x[:, :2], axis=0).max())
        x = x[np.linalg.norm(x - np.roll(x, 1, axis=0), axis=1) > hair]
        steps = np.diff(np.unwrap(np.arctan2(*(x[:, :2] - c).T[::-1])))
        if steps.sum() < 0.0:
            x, steps = x[::-1], -steps[::-1]
        if steps.min() <= 0.0 or steps.sum() > _TURN + _HAIR:
            worst = int(steps.argmin())
            raise InvalidValue(
                "a ray from the centre meets the outline more than once",
                where=where,
                value=f"at ({x[worst, 0]:.4g}, {x[worst, 1]:.4g}), centre ({c[0]:.4g}, {c[1]:.4g})",
                cause="an outline of another shape or place, corners out of their order, or a hole",
                remedy="an outline around the middle of the blank that each ray meets once",
            )
        return cls(c, x)

    def check_reaches(self, angle: ArrayLike, where: str) -> None:
        """Refuse an outline that ends before rays at some angles; the side that closes it is no part of it.

        Raises
        ------
        InvalidValue
            If rays miss it; ``where`` names it.
        """
        corners = self._corners
        behind = np.mod(np.asarray(angle, dtype=float) - corners[-1], _TURN)
        missed = np.flatnonzero((behind > _SHORT) & (behind < _TURN - np.ptp(corners) - _SHORT))
        if len(missed) and not self.closed:
            first, last = np.degrees(corners[[0, -1]])
            raise InvalidValue(
                "an outline does not reach over the whole modelled part",
                where=where,
                value=f"from {first:.5g} to {last:.5g} degrees about ({self.centre[0]:.4g}, {self.centre[1]:.4g}); "
                f"{len(missed)} points of the edge of the blank lie elsewhere",
                cause="an end before a plane of symmetry, or another half or quarter",
                remedy="the whole outline, or the modelled part of it to its planes of symmetry",
            )

    @property
    def closed(self) -> bool:
        """Whether it is a whole outline: its last side is then that to the first corner."""
        return _TURN - float(np.ptp(self._corners)) < math.pi - _SHORT

    @property
    def _corners(self) -> Floats:
        """Angles of the corners, rising."""
        return np.asarray(np.unwrap(np.arctan2(*(self.points[:, :2] - self.centre).T[::-1])))

    def at(self, angle: ArrayLike) -> Floats:
        """Where rays at some angles meet it."""
        corners = self._corners
        turned = np.mod(np.asarray(angle, dtype=float) - corners[0], _TURN)
        turned[turned > _TURN - _HAIR] = 0.0
        place = np.searchsorted(corners - corners[0], turned + _HAIR, side="right") - 1
        p, q = self.points[place], self.points[(place + 1) % len(corners)]
        normal = np.stack([-np.sin(angle), np.cos(angle)], axis=-1)
        a, b = (((end[:, :2] - self.centre) * normal).sum(axis=1) for end in (p, q))
        return np.asarray(p + (a / np.where(a == b, 1.0, a - b))[:, None] * (q - p))

    def radius(self, angle: ArrayLike) -> Floats:
        """Distance of these places from the centre, in x and y."""
        return np.asarray(np.hypot(*(self.at(angle)[:, :2] - self.centre).T))


def stretched(mesh: Mesh, before: Star, after: Star) -> Mesh:
    """A mesh moved along rays, so that its edge lies on another outline; its inner half stays as it is.

    Raises
    ------
    InvalidValue
        If the outlines are too different.
    """

    def moved(x: Floats) -> Floats:
        away = x[:, :2] - before.centre
        angle = np.arctan2(*away.T[::-1])
        edge = before.radius(angle)
        share = np.clip((np.hypot(*away.T) / edge - KEPT) / (1.0 - KEPT), 0.0, 1.0)
        factor = 1.0 + share * (after.radius(angle) / edge - 1.0)
        return np.concatenate([before.centre + factor[:, None] * away, x[:, 2:]], axis=1)

    try:
        return mesh.transformed(moved)
    except (InvertedElement, FoldedElement) as error:
        angle = np.arctan2(*(after.points[:, :2] - after.centre).T[::-1])
        share = after.radius(angle) / before.radius(angle)
        raise InvalidValue(
            "the mesh of the blank cannot be stretched to an outline so far from its edge",
            where="edge of the blank",
            value=f"{share.min():.3g} to {share.max():.3g} of its distance from the middle",
            cause="a wanted or a first outline, or a height, in another unit or far from that of the formed part",
            remedy="one that is nearer, or another blank in the deck",
        ) from error

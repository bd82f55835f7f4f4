"""Ears of a cup: height of its rim over the angle to the rolling direction."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.mesh import Mesh, Selector

Floats = NDArray[np.float64]

#: An ear stands out of its valleys by this part of the largest difference of heights, at least.
_PROMINENCE = 0.1
#: Elements of the rim in the shortest ear; shorter waves come from the mesh.
_ELEMENTS = 6


@dataclass(frozen=True)
class EarProfile:
    """Height of a cup over the angle.

    Attributes
    ----------
    angle : ndarray, shape (n,)
        Degrees from the x-axis, ascending; a part of the circle where the blank was one.
    height : ndarray, shape (n,)
        Height of the rim above the lowest point of the cup.
    """

    angle: Floats
    height: Floats

    @cached_property
    def mean(self) -> float:
        """Mean height over the angle."""
        angle, height = self._closed() if self.is_closed else (self.angle, self.height)
        return float(np.trapezoid(height, angle) / (angle[-1] - angle[0]))

    @property
    def amplitude(self) -> float:
        """Highest less lowest point."""
        return float(np.ptp(self.height))

    @property
    def is_closed(self) -> bool:
        """Whether it goes around the whole cup."""
        gaps = np.diff(self.angle)
        return bool(360.0 - (self.angle[-1] - self.angle[0]) < 2.0 * gaps.max())

    def whole(self) -> EarProfile:
        """The profile around the whole cup; that of a half or a quarter is mirrored at its ends."""
        angle, height = self.angle, self.height
        if self.is_closed:
            return self
        if angle[-1] - angle[0] < 135.0:
            angle, height = np.concatenate([angle, 180.0 - angle[-2::-1]]), np.concatenate([height, height[-2::-1]])
        around = np.concatenate([angle, 2.0 * angle[-1] - angle[-2:0:-1]])
        return EarProfile(around, np.concatenate([height, height[-2:0:-1]]))

    def at(self, angle: Floats) -> Floats:
        """Height at some angles, straight between the nodes."""
        whole = self.whole()
        return np.asarray(np.interp(angle, whole.angle, whole.height, period=360.0), dtype=float)

    def ears(self) -> Floats:
        """Angles of the ears around the whole cup, in degrees."""
        return self._extremes(1.0)

    def valleys(self) -> Floats:
        """Angles of the valleys around the whole cup, in degrees."""
        return self._extremes(-1.0)

    def harmonic(self, number: int) -> float:
        """Amplitude of the wave of the height that goes around the whole cup so many times."""
        height = self._equal_steps()
        return float(2.0 * np.abs(np.fft.rfft(height)[number]) / len(height))

    def _extremes(self, sign: float) -> Floats:
        from scipy.signal import find_peaks  # slow to import

        height = self._smooth()
        count = len(height)
        least = max(_PROMINENCE * self.amplitude, 1e-9 * abs(self.mean))
        peaks, _ = find_peaks(sign * np.tile(height, 3), prominence=least)
        return np.asarray(360.0 / count * (peaks[(peaks >= count) & (peaks < 2 * count)] - count))

    def _smooth(self) -> Floats:
        """Heights at equal steps of the angle from 0, without waves shorter than so many elements of the rim."""
        height = self._equal_steps()
        waves = np.fft.rfft(height)
        waves[len(self.whole().angle) // _ELEMENTS + 1 :] = 0.0
        return np.asarray(np.fft.irfft(waves, len(height)), dtype=float)

    def _equal_steps(self) -> Floats:
        """Heights at equal steps of the angle from 0, straight between the nodes."""
        count = 360 * max(1, round(len(self.whole().angle) / 36))
        return self.at(np.linspace(0.0, 360.0, count, endpoint=False))

    def _closed(self) -> tuple[Floats, Floats]:
        return np.append(self.angle, self.angle[0] + 360.0), np.append(self.height, self.height[0])


def ear_profile(mesh: Mesh, u: Floats, rim: Selector = "rim", *, bottom: Selector = "all") -> EarProfile:
    """Height of the rim of a cup that was drawn along z.

    Parameters
    ----------
    mesh : Mesh
        Undeformed blank about the z-axis.
    u : ndarray, shape (n, 3) or (3 n,)
        Displacement of the nodes.
    rim : str, callable or array_like
        Nodes of the edge of the blank: those of a fibre through the thickness count with the farthest from the bottom.
    bottom : str, callable or array_like
        Nodes of which the lowest (the highest, where the cup opens downwards) is the zero of the heights.

    Returns
    -------
    EarProfile
    """
    x = mesh.points + u.reshape(-1, 3)
    ids = mesh.nodes(rim)
    if not len(ids):
        raise InvalidValue("the rim of a cup has no nodes", where="ear_profile", value=rim, remedy="the node set rim")
    base = x[:, 2] if isinstance(bottom, str) and bottom == "all" else x[mesh.nodes(bottom), 2]
    upwards = x[ids, 2].mean() >= base.mean()
    zero = base.min() if upwards else base.max()
    at_start = np.degrees(np.arctan2(mesh.points[ids, 1], mesh.points[ids, 0]))
    _, fibre = np.unique(np.round(at_start, 6), return_inverse=True)
    fibres = fibre.max() + 1
    height = np.full(fibres, -np.inf)
    np.maximum.at(height, fibre.ravel(), np.abs(x[ids, 2] - zero))
    count = np.bincount(fibre.ravel(), minlength=fibres)
    cosine, sine = (np.bincount(fibre.ravel(), x[ids, k], fibres) / count for k in (0, 1))
    angle = np.sort(np.degrees(np.arctan2(sine, cosine)))
    order = np.argsort(np.degrees(np.arctan2(sine, cosine)))
    gaps = np.diff(angle, append=angle[0] + 360.0)
    first = (int(np.argmax(gaps)) + 1) % fibres if gaps.max() > 2.0 * np.median(gaps) else int(np.argmax(angle > -1e-6))
    angle, height = np.roll(angle, -first), np.roll(height[order], -first)
    angle[angle < angle[0]] += 360.0
    return EarProfile(angle, height)

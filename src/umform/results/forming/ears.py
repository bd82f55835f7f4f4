"""Ears of a cup: height of its rim over the angle to the rolling direction, in harmonics. eq. (5.70)"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.mesh import Mesh, Selector

Floats = NDArray[np.float64]

#: Smallest amplitude of ears relative to the mean height. Peak to valley is twice that, one per cent.
SMALLEST_EAR = 0.005
#: Elements of the rim per wave of the highest harmonic that a mesh resolves.
_ELEMENTS = 6
#: Harmonics whose amplitudes are measures of a cup.
_WAVES = (2, 4, 6, 8)
#: Number of angles at which the sum of harmonics is searched for peaks.
_STEPS = 720
#: Name of the measure.
NUMBER_OF_EARS = "number of ears"


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

    @cached_property
    def resolved(self) -> int:
        """Highest harmonic, in waves around the whole cup, that its nodes resolve."""
        return len(self.whole().angle) // _ELEMENTS

    def wave(self, number: int) -> tuple[float, float]:
        """Amplitude of a harmonic, and the angle of its crest.

        Parameters
        ----------
        number : int
            Number of waves around the whole cup, from 0 (the mean) to ``resolved``.

        Returns
        -------
        amplitude, angle : float
            The angle is that of the crest nearest to the x-axis, in degrees; 0 for ears in the rolling direction.

        Raises
        ------
        InvalidValue
            If the nodes of the rim do not resolve the harmonic.
        """
        if not 0 <= number <= self.resolved:
            raise InvalidValue(
                f"a rim of {len(self.whole().angle)} elements resolves {self.resolved} waves",
                where="EarProfile.wave",
                value=number,
                remedy=f"{_ELEMENTS * number} elements around the whole cup",
            )
        wave = self._waves[number]
        return float(abs(wave)), float(np.degrees(np.angle(wave)) / max(number, 1))

    @cached_property
    def smallest_ear(self) -> float:
        """Smallest amplitude of a harmonic that counts as ears.

        It is ``SMALLEST_EAR`` times the mean height, or the amplitude of the residual of the fit if that is larger.
        """
        return max(SMALLEST_EAR * abs(self.mean), float(np.sqrt(2.0) * self._rest.std()))

    def ears(self) -> Floats:
        """Angles of the ears around the whole cup, in degrees."""
        return self._extremes(1.0)

    def valleys(self) -> Floats:
        """Angles of the valleys around the whole cup, in degrees."""
        return self._extremes(-1.0)

    def heights(self) -> dict[str, float]:
        """Mean, lowest and highest height by the names of their measures."""
        low, high = float(self.height.min()), float(self.height.max())
        return {"height, mean": self.mean, "height, lowest": low, "height, highest": high}

    def waves(self) -> dict[str, float]:
        """Amplitudes of the resolved harmonics, and ``smallest_ear``, by the names of their measures."""
        found = {f"amplitude of {n} waves": self.wave(n)[0] for n in _WAVES if n <= self.resolved}
        return found | {"ears count from an amplitude of": self.smallest_ear}

    def words(self, unit: str) -> str:
        """Number of ears and the largest amplitude of their harmonics as text."""
        count = len(self.ears())
        if not count:
            return f"no ears above {self.smallest_ear:.3g} {unit}"
        return f"{count} ears, amplitude {max(self.wave(n)[0] for n in self._counted):.3g} {unit}"

    def _extremes(self, sign: float) -> Floats:
        """Peaks, or valleys, of the sum of the counted harmonics, at least as prominent as the smallest ear."""
        angle = 2.0 * np.pi / _STEPS * np.arange(_STEPS)
        height = sum((self._waves[n] * np.exp(-1j * n * angle) for n in self._counted), np.zeros(_STEPS)).real
        rises = np.roll(height, -1) > height
        turns = np.flatnonzero(rises != np.roll(rises, 1))  # peaks and valleys in turn
        while turns.size:  # the least step between neighbours is removed, until all are large
            steps = np.abs(height[np.roll(turns, -1)] - height[turns])
            least = int(steps.argmin())
            if steps[least] >= 2.0 * (1.0 - 1e-3) * self.smallest_ear:
                break
            turns = np.delete(turns, [least, (least + 1) % turns.size])
        return np.asarray(360.0 / _STEPS * turns[sign * (np.roll(height, -1) - height)[turns] <= 0.0])

    @cached_property
    def _counted(self) -> list[int]:
        """Harmonics with the amplitude of the smallest ear or more. The first one is an eccentric blank, no ear."""
        return [n for n in range(2, self.resolved + 1) if abs(self._waves[n]) >= self.smallest_ear > 0.0]

    @cached_property
    def _basis(self) -> NDArray[np.complex128]:
        """Harmonics 0 to the highest resolved one at the nodes around the whole cup, shape (nodes, harmonics)."""
        return np.exp(-1j * np.radians(self.whole().angle)[:, None] * np.arange(self.resolved + 1))

    @cached_property
    def _waves(self) -> NDArray[np.complex128]:
        """Complex amplitudes by least squares: the height is the real part of _basis @ _waves."""
        real = np.hstack([self._basis.real, -self._basis.imag[:, 1:]])
        found = np.linalg.lstsq(real, self.whole().height, rcond=None)[0]
        count = self.resolved + 1
        return np.asarray(found[:count] + 1j * np.concatenate([[0.0], found[count:]]))

    @cached_property
    def _rest(self) -> Floats:
        """Residual of the fit at the nodes."""
        return np.asarray(self.whole().height - (self._basis @ self._waves).real)

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
    x = mesh.displaced(u)
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

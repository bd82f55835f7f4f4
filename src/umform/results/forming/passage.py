"""Largest force of a tool without the ripple of elements that pass its edges. eqs. (5.71), (5.72)"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.results.forming.sections import Section

Floats = NDArray[np.float64]

#: Places in one passage; odd, so that one is in its middle.
_PLACES = 21
#: Ripple relative to the largest force above which the mesh is too coarse for it.
RIPPLE = 0.05


@dataclass(frozen=True)
class LargestForce:
    """Largest force of a tool over passages of one element.

    Attributes
    ----------
    value : float
        Largest mean over a passage.
    ripple : float
        Error band of the value: largest deviation of the force from that mean within a passage, or above it anywhere.
    stroke : float
        Stroke in the middle of that passage.
    """

    value: float
    ripple: float
    stroke: float

    @property
    def is_rough(self) -> bool:
        """Whether the ripple is more than ``RIPPLE`` of the force."""
        return self.ripple > RIPPLE * abs(self.value)


def largest_force(
    stroke: Floats, force: Floats, way: float, *, between: tuple[float, float] = (-math.inf, math.inf)
) -> LargestForce:
    """Largest mean of a force over a passage, and its ripple.

    The mean over less than a passage at either end of the stroke is that of the line through the last whole one.
    Without a travel it is the largest force itself.

    Parameters
    ----------
    stroke, force : ndarray, shape (n,)
        Travel of the tool and its force; where the travel stands still or goes back, the last of the values counts.
    way : float
        Travel in which an element passes an edge, see :func:`longest_element`; the whole stroke at most.
    between : tuple of float
        Part of the stroke whose largest mean is wanted; means at its ends reach beyond it.

    Raises
    ------
    InvalidValue
        If the way is not positive.
    """
    far = np.maximum.accumulate(stroke)
    last = np.append(np.diff(far) > 0.0, True)
    s, f = far[last], force[last]
    if not way > 0.0:
        raise InvalidValue(
            "an element that passes an edge has a length",
            where="largest_force",
            value=way,
            cause="a sign, or zero",
            remedy="the length of the longest element",
        )
    if len(s) == 1:  # the run has ended before the stroke began
        return LargestForce(float(force.max()), 0.0, float(s[0]))
    step = min(way, s[-1] - s[0]) / _PLACES
    at = s[0] + step * np.arange(int((s[-1] - s[0]) / step + 1e-9) + 1)
    own = np.interp(at, s, f)
    mean = _mean_over_passages(own)
    first, end = (float(np.clip(place, at[0], at[-1])) for place in between)
    wanted = np.flatnonzero((at >= first) & (at <= end))
    if not wanted.size:  # a part of the stroke between two places
        wanted = np.array([np.argmin(np.abs(at - end))])
    top = int(wanted[np.argmax(mean[wanted])])
    near = wanted[np.abs(at[wanted] - at[top]) <= step * _PLACES]
    above = f[(s >= between[0]) & (s <= between[1])].max(initial=mean[top]) - mean[top]
    return LargestForce(float(mean[top]), max(float(np.abs(own - mean)[near].max()), float(above)), float(at[top]))


def _mean_over_passages(values: Floats) -> Floats:
    """Mean over the passage around each place; near the ends the line through the first and the last whole passage."""
    mean, half, x = np.convolve(values, np.full(_PLACES, 1.0 / _PLACES), "same"), _PLACES // 2, np.arange(_PLACES)
    for end, outer in ((slice(None, _PLACES), slice(None, half)), (slice(-_PLACES, None), slice(half + 1, None))):
        line = np.polynomial.Polynomial.fit(x, values[end], 1)
        mean[end][outer] = line(x[outer])
    return mean


def longest_element(cut: Section, ends: Floats, first: float) -> float:
    """Length in the part of the longest element of a section that lay beyond a place of the blank.

    Parameters
    ----------
    cut : Section
        The section in the part.
    ends : ndarray
        Ends of the elements along the undeformed section.
    first : float
        Where the elements begin that pass an edge.
    """
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(cut.middle, axis=0), axis=1))])
    lengths = np.diff(np.interp(ends[ends >= first - 1e-9 * ends[-1]], cut.s, way))
    return float(lengths.max())

"""The last increment of a run, its difference from the previous one, and the predictor. eq. (5.50)"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from umform.model.terms.control import Control

Floats = NDArray[np.float64]

#: Tolerated deviation of the changes of the controls from parallel, relative to their size.
_PARALLEL = 1e-6


@dataclass(frozen=True)
class Trail:
    """The last increments.

    Attributes
    ----------
    terms : ndarray, shape (1 or 2, 3 n + k)
        Last increment of displacement and scalar unknowns; and, if it continued the previous direction, its curvature:
        half of the change of the increment from one to the next, at equal sizes.
    way : ndarray, shape (controls,)
        Changes of the controls of the model in the last increment.
    """

    terms: Floats
    way: Floats

    @classmethod
    def of(cls, increment: Floats, way: Floats, before: Self | None, ratio: float | None) -> Self:
        """The trail after an increment.

        Parameters
        ----------
        increment : ndarray, shape (3 n + k,)
            The increment.
        way : ndarray, shape (controls,)
            Changes of the controls in it.
        before : Trail, optional
            The previous trail; None without curvature.
        ratio : float, optional
            Its size relative to the previous increment, if it continued its direction.
        """
        terms = [increment]
        if before is not None and ratio is not None:
            terms.append((increment - ratio * before.terms[0]) * (ratio / (1.0 + ratio)))
        return cls(np.stack(terms), way)

    def guess(self, ratio: float) -> Floats:
        """Extrapolated increment for a ratio of sizes: on the line or the parabola of the last states."""
        guess: Floats = ratio * self.terms[0]
        if len(self.terms) == 2:
            guess += ratio * (1.0 + ratio) * self.terms[1]
        return guess

    def size(self, way: Floats) -> float | None:
        """Ratio of the last increment to one that changes the controls by `way`; None if the direction differs."""
        square = float(way @ way)
        size = float(self.way @ way) / square if square else 0.0
        off = self.way - size * way
        return size if size > 0.0 and off @ off <= _PARALLEL**2 * (self.way @ self.way) else None


def changes(controls: Sequence[Control], moved: Sequence[Control], by: Floats) -> Floats:
    """Changes of all controls of a model, of which some are moved."""
    change = dict(zip(moved, by, strict=True))
    return np.array([change.get(control, 0.0) for control in controls])

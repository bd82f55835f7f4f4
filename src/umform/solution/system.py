"""What Newton's method asks of a model: it knows no elements and no contact beyond these two protocols."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from umform.ranks import Ranks
from umform.solvers import Pattern

Floats = NDArray[np.float64]


class Evaluation(Protocol):
    """What Newton reads of an evaluation."""

    @property
    def residual(self) -> Floats:
        """Residual at all degrees of freedom, reactions at the prescribed ones."""

    @property
    def values(self) -> Floats:
        """Entries of the tangent."""

    @property
    def predictor(self) -> Floats:
        """Tangent times the increment of the prescribed degrees of freedom."""

    @property
    def force_scale(self) -> float:
        """Scale of the forces."""

    @property
    def round_off(self) -> float:
        """What a relative error of all positions makes of the residual of contact, over that error. eq. (5.36)"""

    @property
    def failed(self) -> int:
        """First cell that has no residual, or -1."""

    @property
    def failure(self) -> str:
        """Why that cell has none, in words that follow its number."""


class System(Protocol):
    """What Newton asks of a model."""

    u: Floats

    @property
    def ranks(self) -> Ranks:
        """Who shares the model: forces are then shares that are to be summed up, displacements the same on all."""

    @property
    def pattern(self) -> Pattern:
        """Sparse pattern of the tangent."""

    @property
    def effort(self) -> float:
        """What an evaluation costs for each equation; 1 for 8-node elements with 20 points."""

    @property
    def extent(self) -> float:
        """Largest extent of the undeformed body along an axis."""

    def restrict(self, r: Floats) -> Floats:
        """Unknowns' share of forces at all degrees of freedom, summed over the ranks. eq. (5.18)"""

    def coefficients(self, u: Floats) -> Floats:
        """Unknowns in a displacement of all degrees of freedom. eq. (5.18)"""

    def extend(self, x: Floats) -> Floats:
        """Displacement of all degrees of freedom that the unknowns make. eq. (5.17)"""

    def prescribed_displacement(self) -> Floats:
        """Displacement that the supports prescribe, zero elsewhere."""

    def largest_entry(self, values: Floats) -> float:
        """Size of the largest entry of the tangent."""

    def evaluate(self, u: Floats, du: Floats | None = None) -> Evaluation:
        """Residual and tangent."""

    def recover(self, du: Floats, s: float, mixed: bool = False) -> None:
        """Update condensed parameters; the next tangent may be mixed, of the stress that the increment foresaw."""

    def undo_recover(self) -> None:
        """Take the last update back."""

    def active_set(self) -> NDArray[np.bool_]:
        """Contact points that penetrate."""

    def flowing(self) -> NDArray[np.uint8]:
        """1 for each point of the material whose history the last evaluation has changed, else 0."""

    def commit(self, u: Floats) -> None:
        """Accept."""

    def revert(self) -> None:
        """Forget."""

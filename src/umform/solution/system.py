"""What Newton's method asks of a model: it knows no elements and no contact beyond these two protocols."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol, Self

import numpy as np
from numpy.typing import NDArray

from umform.ranks import Ranks
from umform.solvers import Pattern

Floats = NDArray[np.float64]


class Border(Protocol):
    """Rows and columns of scalar unknowns, see :class:`umform.model.term.Border`."""

    @property
    def unknowns(self) -> tuple[Any, ...]:
        """The scalar unknowns."""

    @property
    def columns(self) -> Floats:
        """Rates of the residual with each of them, shape (k, 3 n)."""

    @property
    def rows(self) -> Floats:
        """Derivatives of their equations with the displacement, shape (k, 3 n)."""

    @property
    def corner(self) -> Floats:
        """Derivatives of their equations with them, shape (k, k)."""


class Evaluation(Protocol):
    """What Newton reads of an evaluation."""

    @property
    def x(self) -> Floats:
        """Where it was made."""

    @property
    def residual(self) -> Floats:
        """Residual at all degrees of freedom, reactions at the prescribed ones; then those of scalar unknowns."""

    @property
    def values(self) -> Floats:
        """Entries of the tangent; empty of forces alone."""

    @property
    def predictor(self) -> Floats:
        """Tangent times the increment of the prescribed degrees of freedom."""

    @property
    def border(self) -> Border:
        """Rows and columns of the scalar unknowns."""

    @property
    def force_scale(self) -> float:
        """Scale of the forces."""

    @property
    def round_off(self) -> float:
        """What a relative error of all positions makes of the residual of contact, over that error. eq. (5.36)"""

    @property
    def failed(self) -> int:
        """First cell without an answer, or -1."""

    @property
    def failure(self) -> str:
        """Why it has none."""

    @property
    def status(self) -> NDArray[np.uint8]:
        """0 for each contact point that is open, 1 if a tool holds it, 2 if it slips as well."""

    def without_tangent(self) -> Self:
        """The same without the entries of the tangent, whose memory the next one may take."""

    def at_points(self, chosen: NDArray[np.bool_]) -> str:
        """Where some of the contact points are, in words."""

    @property
    def flowing(self) -> NDArray[np.uint8]:
        """1 for each point of the material whose history the evaluation has changed, else 0."""


class System(Protocol):
    """What Newton asks of a model."""

    @property
    def x(self) -> Floats:
        """Displacement and scalar unknowns of the converged state."""

    @property
    def ranks(self) -> Ranks:
        """Who shares the model: forces are then shares that are to be summed up, displacements the same on all."""

    @property
    def pattern(self) -> Pattern:
        """Sparse pattern of the tangent at the nodes."""

    @property
    def effort(self) -> float:
        """What an evaluation costs for each equation; 1 for 8-node elements with 20 points."""

    @property
    def extent(self) -> float:
        """Largest extent of the undeformed body along an axis."""

    @property
    def elastic(self) -> bool:
        """Whether no law has a history."""

    @property
    def smooth(self) -> bool:
        """Whether there is neither contact nor a law with a history."""

    def restrict(self, r: Floats) -> Floats:
        """Unknowns' share of forces, summed over the ranks; on the first rank scalar ones follow. eq. (5.18)"""

    def coefficients(self, u: Floats) -> Floats:
        """Unknowns in a displacement of all degrees of freedom and scalar unknowns. eq. (5.18)"""

    def extend(self, x: Floats) -> Floats:
        """Displacement of all degrees of freedom and scalar unknowns that the unknowns make. eqs. (5.17), (5.46)"""

    def prescribed_displacement(self) -> Floats:
        """Displacement that the supports prescribe, zero elsewhere, shape (3 n,)."""

    def displacement_of_supports(self, values: Mapping[Any, float]) -> Floats:
        """Displacement that supports prescribe if their controls have these values, shape (3 n,)."""

    def largest_entry(self, values: Floats) -> float:
        """Size of the largest entry of the tangent."""

    def evaluate(self, x: Floats, du: Floats | None = None, *, tangent: bool = True) -> Evaluation:
        """Residual and tangent, or the residual alone, which leaves the blocks of enhanced parameters as they are."""

    def recover(self, du: Floats, mixed: bool = False) -> None:
        """Update condensed parameters; the next tangent may be mixed, of the stress that the increment foresaw."""

    def follow(self) -> None:
        """After forces alone were evaluated: let the next recovery take them, with the tangent of before."""

    def shorten(self, part: float) -> None:
        """Shorten the last update to a part of it."""

    def revert(self) -> None:
        """Forget everything since the last commit."""

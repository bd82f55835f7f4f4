"""Interface between Newton's method and a model: two protocols, independent of elements and contact."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol, Self

import numpy as np
from numpy.typing import NDArray

from umform.ranks import Ranks
from umform.solvers import Pattern

Floats = NDArray[np.float64]


class Border(Protocol):
    """Rows and columns of scalar unknowns, see :class:`umform.model.terms.term.Border`."""

    @property
    def unknowns(self) -> tuple[Any, ...]:
        """The scalar unknowns."""

    @property
    def columns(self) -> Floats:
        """Derivatives of the residual with respect to each of them, shape (k, 3 n)."""

    @property
    def rows(self) -> Floats:
        """Derivatives of their equations with respect to the displacement, shape (k, 3 n)."""

    @property
    def corner(self) -> Floats:
        """Derivatives of their equations with respect to each of them, shape (k, k)."""


class State(Protocol):
    """Where a system is evaluated, or the goal of an increment, see :class:`umform.model.terms.state.State`."""

    @property
    def x(self) -> Floats:
        """Displacement and scalar unknowns; of a goal those of the converged state."""


class Evaluation(Protocol):
    """Data of an evaluation that Newton's method uses."""

    @property
    def x(self) -> Floats:
        """Where the evaluation was made."""

    @property
    def residual(self) -> Floats:
        """Residual at all degrees of freedom, reactions at the prescribed ones; then those of scalar unknowns."""

    @property
    def values(self) -> Floats:
        """Entries of the tangent; empty if only forces were evaluated."""

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
        """Change of the residual of contact per relative error of all positions. eq. (5.36)"""

    @property
    def failed(self) -> int:
        """First cell whose evaluation failed, or -1."""

    @property
    def failure(self) -> str:
        """Cause of that failure."""

    @property
    def status(self) -> NDArray[np.uint8]:
        """0 for each open contact point, 1 if a tool holds it, 2 if it also slips."""

    @property
    def kept(self) -> bool:
        """Whether tools hold open points, so that this is no state of equilibrium. eq. (4.230)"""

    def without_tangent(self) -> Self:
        """The same without the entries of the tangent, whose memory the next evaluation may reuse."""

    def at_points(self, chosen: NDArray[np.bool_]) -> str:
        """Positions of some contact points as text."""

    @property
    def flowing(self) -> NDArray[np.uint8]:
        """1 for each point of the material whose history the evaluation has changed, else 0."""


class System(Protocol):
    """Operations of a model that Newton's method uses."""

    @property
    def state(self) -> Any:
        """The converged state."""

    def state_at(self, x: Floats, goal: Any) -> Any:
        """A goal with other unknowns."""

    @property
    def ranks(self) -> Ranks:
        """Ranks that share the model: forces are partial sums, displacements are the same on all."""

    @property
    def pattern(self) -> Pattern:
        """Sparse pattern of the tangent at the nodes."""

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
        """Reduce forces to the unknowns, summed over the ranks; on the first rank scalar ones follow. eq. (5.18)"""

    def coefficients(self, u: Floats) -> Floats:
        """Reduce a displacement of all degrees of freedom and scalar unknowns to the unknowns. eq. (5.18)"""

    def extend(self, x: Floats) -> Floats:
        """Displacement of all degrees of freedom and scalar unknowns from the unknowns. eqs. (5.17), (5.46)"""

    def prescribed_displacement(self, goal: Any) -> Floats:
        """Displacement that the supports prescribe at a goal, zero elsewhere, shape (3 n,)."""

    def displacement_of_supports(self, values: Mapping[Any, float]) -> Floats:
        """Displacement that supports prescribe for given values of their controls, shape (3 n,)."""

    def resultants(self, evaluation: Any) -> tuple[float, float]:
        """Largest resultant along an axis of the residual of the unknowns, and of the forces of a tool. eq. (5.130)"""

    def largest_entry(self, values: Floats) -> float:
        """Size of the largest entry of the tangent."""

    def evaluate(self, state: Any, du: Floats | None = None, *, tangent: bool = True, keep: bool = False) -> Evaluation:
        """Residual and tangent at a state, or the residual alone, which leaves blocks of enhanced parameters unchanged.

        With ``keep`` tools hold all points that they hold in the converged state, whatever the gap. eq. (4.230)
        """

    def recover(self, du: Floats, mixed: bool = False) -> None:
        """Update condensed parameters; the next tangent may be mixed, with the stress that the increment predicts."""

    def too_deep(self, evaluation: Any) -> Mapping[Any, float]:
        """Contacts whose penalty will grow, and their penetration relative to the allowed one. eq. (4.200)"""

    def follow(self) -> None:
        """After an evaluation of forces only: let the next recovery use them, with the previous tangent."""

    def shorten(self, part: float) -> None:
        """Scale the last update."""

    def mechanism(self, values: Floats, motion: Floats) -> Floats | None:
        """What can move although a tangent looks singular, by default the motion given.

        None for a very thin sheet that is held: its tangent resists bending less than round-off. eq. (5.99)
        """

    def revert(self) -> None:
        """Discard all changes since the last commit."""

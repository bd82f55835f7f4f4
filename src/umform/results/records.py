"""Results of the iterations of an increment: records, equilibrium, or failure."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.solvers import Factorisation

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Iteration:
    """Record of one iteration.

    Attributes
    ----------
    residual : float
        Norm of the residual of the unknowns relative to the force scale.
    increment : float
        Largest entry of the last increment relative to the largest displacement.
    energy : float
        Scalar product of the residual and the next increment (absolute); zero in the last iteration.
    entered, left : int
        Contact points that closed and opened.
    step_length : float
        Step length of the line search.
    negative_pivots : int or None
        Negative pivots of the tangent, if the solver reports them.
    seconds : float
        Wall time.
    switched : int
        Material points that began or ceased to flow since the previous iteration.
    """

    number: int
    residual: float
    increment: float
    energy: float
    entered: int
    left: int
    step_length: float
    negative_pivots: int | None
    seconds: float
    switched: int = 0


class Cause(StrEnum):
    """Why an attempt did not converge."""

    CELL = "cell without an answer"
    CYCLE = "contact in a cycle"
    INDEFINITE = "indefinite tangent far from equilibrium"
    SINGULAR = "singular tangent"
    STALL = "residual does not fall"
    PASSAGE = "sheet through a tool or a sheet"
    TURN = "sheet turns on a tool"
    ITERATIONS = "too many iterations"
    OTHER = "other"


class Failed(Exception):
    """A failed attempt: the cause, and the iterations so far. Steps turn it into a cut or an error.

    A singular tangent may report the displacement of the nodal unknowns that it does not resist, its ``motion``.
    """

    def __init__(
        self, reason: str, iterations: list[Iteration], cause: Cause = Cause.OTHER, motion: Floats | None = None
    ) -> None:
        super().__init__(reason)
        self.reason = reason
        self.iterations = iterations
        self.cause = cause
        self.motion = motion


@dataclass(frozen=True)
class Converged:
    """A converged increment.

    Attributes
    ----------
    evaluation : Evaluation
        At the equilibrium.
    iterations, passes : list of Iteration
        Iterations, and those of augmentations at the same loads.
    goal : State
        The goal of the increment.
    jumped : bool
        Whether the sheet jumped to another stable state, since none was near. eq. (5.102)
    missed : float
        Relative residual, if it is above the tolerance; else zero. eq. (5.131)
    linear : bool
        Whether the factors of the predictor served all iterations.
    """

    evaluation: Any
    iterations: list[Iteration]
    goal: Any = None
    passes: list[Iteration] = field(default_factory=list)
    jumped: bool = False
    missed: float = 0.0
    linear: bool = False

    @property
    def x(self) -> Floats:
        """Displacement and scalar unknowns."""
        return self.evaluation.x  # type: ignore[no-any-return]

    @property
    def residual(self) -> Floats:
        """Residual, reactions at the degrees of freedom that are held, prescribed or tied."""
        return self.evaluation.residual  # type: ignore[no-any-return]


@dataclass(frozen=True)
class First:
    """Source of the first increment: factors of the tangent, and its largest entry."""

    factors: Factorisation
    entry: float

"""Options of Newton's method."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from umform.errors import InvalidValue


@dataclass(frozen=True)
class NewtonOptions:
    """Tolerances and strategies of Newton's method.

    Attributes
    ----------
    residual : float
        Tolerance of the residual, relative to the element forces.
    increment : float
        Tolerance of the increment, relative to the largest displacement.
    max_iterations : int
        Largest number of iterations.
    line_search : bool, optional
        Shorten increments that are too long, see :mod:`umform.solution.line_search`. Default: if a law has a history.
    extrapolate : int
        Predictor: 0 from the tangent; 1 from the last increment of the step, extrapolated; 2 from the parabola through
        the last three states, also across the end of a move if the next one continues its direction. eq. (5.50) The
        parabola suits smooth paths: many increments, and contact at many points.
    factor_cost : float, optional
        Cost of a factorisation relative to an evaluation with a solve. If it is large, factors are reused, see
        :mod:`umform.solution.factor_reuse`. Default: an estimate from the entries of the factors; 0 never reuses them.
    mixed : bool, optional
        Compute the geometric stiffness from the stress predicted by the last increment, not from the present one: thin
        elastic sheets then allow larger steps and need fewer iterations. eq. (5.39) Default: if no law has a history.
    keep : bool
        Whether the first evaluation of an extrapolated increment keeps the contact points of the last one, also where
        they have opened. eq. (4.230) It halves the evaluations of drawn parts; bends with few points may take other
        paths.

    Examples
    --------
    >>> import umform as uf
    >>> model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=210e3, nu=0.3))
    >>> clamp = model.fix("x0")
    >>> tip = model.prescribe("x1_lower", "z", name="tip")
    >>> options = uf.NewtonOptions(residual=1e-8, max_iterations=15)
    >>> result = uf.solve(model, uf.Move(tip, to=-0.1, steps=2), options=options)
    """

    residual: float = 1e-9
    increment: float = 1e-6
    max_iterations: int = 25
    line_search: bool | None = None
    extrapolate: int = 1
    factor_cost: float | None = None
    mixed: bool | None = None
    keep: bool = False

    def __post_init__(self) -> None:
        if not self.residual > 0 or not self.increment > 0 or self.max_iterations < 1:
            raise InvalidValue("tolerances and iterations must be positive", where="NewtonOptions", value=self)
        if self.extrapolate not in (0, 1, 2):
            raise InvalidValue(
                "an increment starts from the tangent, a line or a parabola",
                where="extrapolate",
                value=self.extrapolate,
                remedy="0, 1 or 2",
            )
        if self.factor_cost is not None and not self.factor_cost >= 0:
            raise InvalidValue("a cost is zero or more", where="factor_cost", value=self.factor_cost)


class IndefiniteTangent(Enum):
    """Response to an indefinite tangent far from equilibrium."""

    IGNORED = "the iterations go on"
    STOPS_IF_MORE = "they end where negative pivots become more from one iteration to the next"
    STOPS = "they end at once"
    STOPS_BEFORE_JUMP = "they end at once, unless they descend to the next stable state already"

    @property
    def stops(self) -> bool:
        """Whether the last equilibrium was stable: an indefinite tangent is unexpected."""
        return self in (IndefiniteTangent.STOPS, IndefiniteTangent.STOPS_BEFORE_JUMP)


@dataclass(frozen=True)
class IterationMode:
    """Mode of the iterations.

    Attributes
    ----------
    line_search : bool
        Whether to shorten increments that are too long. eq. (5.12)
    reuses : bool
        Whether the factors of the previous iteration may be reused.
    mixed : bool
        Whether the geometric stiffness is that of the stress predicted by the last increment. eq. (5.39)
    indefinite : IndefiniteTangent
        When to stop because the tangent is indefinite far from equilibrium.
    extended : bool
        Whether more iterations are allowed, since a smaller increment would need as many.
    grows : bool
        Whether the iterations end near equilibrium where a penalty will grow. docs/theory, 4.11
    """

    line_search: bool
    reuses: bool
    mixed: bool
    indefinite: IndefiniteTangent = IndefiniteTangent.IGNORED
    extended: bool = False
    grows: bool = False

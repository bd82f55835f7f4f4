"""Options of Newton's method."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Annotated, Literal

from annotated_types import Le, Lt

from umform.spec import About, check_fields
from umform.spec.types import Count, Positive


@dataclass(frozen=True)
class NewtonOptions:
    """Tolerances and strategies of Newton's method.

    Examples
    --------
    >>> import umform as uf
    >>> model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=210e3, nu=0.3))
    >>> clamp = model.fix("x0")
    >>> tip = model.prescribe("x1_lower", "z", name="tip")
    >>> options = uf.NewtonOptions(residual=1e-8, max_iterations=15)
    >>> result = uf.solve(model, uf.Move(tip, to=-0.1, steps=2), options=options)
    """

    residual: Annotated[Positive, Lt(1.0), About(cause="a force in place of a part of the forces")] = 1e-9
    """Tolerance of the residual, relative to the element forces."""
    increment: Positive = 1e-6
    """Tolerance of the increment, relative to the largest displacement."""
    max_iterations: Annotated[Count, Le(1000)] = 25
    """Largest number of iterations before an increment is cut; twice as many while contact settles."""
    line_search: bool | None = None
    """Shorten increments that are too long, see :mod:`umform.analysis.newton.line_search`; default: if a law has a
    history, but not where supports and tools are removed, and with friction."""
    extrapolate: Annotated[
        Literal[0, 1, 2], About(cause="another order", remedy="0 from the tangent, 1 from a line, 2 from a parabola")
    ] = 1
    """Predictor: 0 from the tangent; 1 from the last increment of the step, extrapolated, in elastic sheets without
    contact along the tangent at its end, eq. (5.133); 2 from the parabola through the last three states, also across
    the end of a move if the next one continues its direction, eq. (5.50). The parabola suits smooth paths: many
    increments, and contact at many points."""
    mixed: bool | None = None
    """Compute the geometric stiffness from the stress predicted by the last increment, not from the present one: thin
    elastic sheets then allow larger steps and need fewer iterations. eq. (5.39) Default: if no law has a history, and
    where supports and tools are removed."""
    keep: bool = False
    """Start an increment that is extrapolated with the contact points of the last one, also where they have opened. eq.
    (4.230) Convergence then does not wait for contact points that open and close. It saves two fifths to a
    half of the evaluations of cups; bends with few points may take other paths."""

    def __post_init__(self) -> None:
        check_fields(self)


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
    mixed: bool
    indefinite: IndefiniteTangent = IndefiniteTangent.IGNORED
    extended: bool = False
    grows: bool = False

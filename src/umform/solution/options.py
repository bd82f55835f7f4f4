"""How far and how hard Newton's method iterates."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from umform.errors import InvalidValue


@dataclass(frozen=True)
class NewtonOptions:
    """How far and how hard to iterate.

    Attributes
    ----------
    residual : float
        Tolerance of the residual, relative to the element forces.
    increment : float
        Tolerance of the increment, relative to the largest displacement.
    max_iterations : int
        Iterations before a step is given up.
    line_search : bool, optional
        Shorten increments that go too far, see :mod:`umform.solution.line_search`. Default: where a law has a history.
    extrapolate : int
        Where an increment starts: 0 from the tangent; 1 from the last increment of the step, extrapolated; 2 from the
        parabola through the last three states, over the end of a move too if the next one goes on the same way.
        eq. (5.50) The parabola is for smooth ways: many increments, and contact at many points.
    factor_cost : float, optional
        What a factorisation costs over an evaluation with a solve; where it is dear, old factors serve for more than
        one iteration, see :mod:`umform.solution.factor_reuse`. Default: an estimate from the entries of the factors; 0
        makes new ones always.
    mixed : bool, optional
        Take the geometric stiffness from the stress that the last increment foresaw, not from the present one: thin
        elastic sheets take larger steps and fewer iterations. eq. (5.39) Default: where no law has a history.

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


class Wary(Enum):
    """What becomes of an attempt whose tangent is indefinite far from equilibrium."""

    NOT = "it goes on"
    OF_MORE = "it ends where negative pivots become more from one iteration to the next"
    OF_ANY = "it ends at once"


@dataclass(frozen=True)
class Manner:
    """How iterations are made.

    Attributes
    ----------
    line_search : bool
        Whether increments that go too far are shortened, and iterations end when the residual does not fall. eq. (5.12)
    reuses : bool
        Whether the factors of the iteration before may serve for the next one.
    mixed : bool
        Whether the geometric stiffness is that of the stress which the last increment foresaw. eq. (5.39)
    wary : Wary
        When iterations end because the tangent is indefinite far from equilibrium.
    """

    line_search: bool
    reuses: bool
    mixed: bool
    wary: Wary = Wary.NOT

"""Limits for increments whose size adapts to the changes in them. eq. (5.49)"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.model import Model
from umform.model.bodies.change import strained, turned
from umform.results.balance import Worked
from umform.results.records import Converged
from umform.spec import About, check_fields, names_its_words
from umform.spec.types import Count, Positive, Share

Floats = NDArray[np.float64]

#: Range of the ratio of successive sizes.
_LEAST, _MOST = 0.5, 2.0
#: Size, relative to the first one, below which no increment is repeated because of its work.
_SHORTEST = 0.3
#: This number of contact points may always open or close.
_FEW_POINTS = 8


@names_its_words
@dataclass(frozen=True)
class Pace:
    """Limits of the changes in one increment; half of them give finer increments, for a study of convergence.

    Examples
    --------
    >>> import umform as uf
    >>> model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=210e3, nu=0.3))
    >>> clamp = model.fix("x0")
    >>> tip = model.prescribe("x1_lower", "z", name="tip")
    >>> result = uf.solve(model, uf.Move(tip, to=-0.1, steps=uf.Pace(turn=1.0)))
    """

    first: Share = 0.01
    """First increment, as a fraction of the step."""
    largest: Share = 0.1
    """Largest increment, as a fraction of the step."""
    turn: Annotated[Positive, About("degrees")] = 2.0
    """Rotation of a fibre through the thickness."""
    strain: Positive = 0.02
    """Increase of the accumulated plastic strain at a material point."""
    contact: Positive = 1.0
    """Contact points that open or close, relative to those in contact."""
    iterations: Count = 12
    """Newton iterations at which the size is kept: with half of them it may double."""
    work: Positive = 1e-3
    """Difference of the external work from the energies in an increment, relative to the energy so far, or to that of
    the step at this rate. An increment with more is repeated with half the size. eq. (5.103)"""

    def __post_init__(self) -> None:
        check_fields(self)
        if self.first > self.largest:
            raise InvalidValue(
                "the first increment of a pace must not be larger than the largest one",
                where="first",
                value=f"first = {self.first:g}, largest = {self.largest:g}",
                cause="one of both was changed alone",
                remedy="first <= largest <= 1",
            )

    def repeats(self, size: float, worked: Worked) -> bool:
        """Whether an increment of this size, as a fraction of the step, is repeated with half of it. eq. (5.103)"""
        largest = max(worked.energy, worked.gained / size)
        return size > _SHORTEST * self.first and worked.difference > self.work * largest

    def factor(self, happened: Happened) -> float:
        """Ratio of the next size to that of the increment with these changes."""
        limits = [
            self.iterations / happened.iterations,
            _ratio(self.turn, happened.turn),
            _ratio(self.strain, happened.strain),
            _ratio(self.contact, happened.contact),
        ]
        return min(max(min(limits), _LEAST), _MOST)


@dataclass(frozen=True)
class Happened:
    """Changes in an increment, in the terms of :class:`Pace`.

    Attributes
    ----------
    turn : float
        Largest rotation of a fibre, in degrees.
    strain : float
        Largest increase of the accumulated plastic strain.
    contact : float
        Contact points that opened or closed, relative to those in contact; zero for a few.
    iterations : int
        Newton iterations.
    """

    turn: float
    strain: float
    contact: float
    iterations: int

    @classmethod
    def between(
        cls, model: Model, x_before: Floats, active_before: NDArray[np.bool_], converged: Converged
    ) -> Happened:
        """Changes up to a committed converged state.

        Parameters
        ----------
        model : Model
            At the converged state.
        x_before : ndarray, shape (3 n + k,)
            Displacement of the previous state.
        active_before : ndarray of bool
            Contact points in contact at the previous state.
        converged : Converged
            The increment.
        """
        ranks, active = model.system.ranks, converged.evaluation.active
        changed, held = ranks.sum(float((active != active_before).sum())), ranks.sum(float(active.sum()))
        bodies = [body for body in model.bodies if len(body.cells)]
        turn = max((turned(body, x_before[: model.u.size], model.u) for body in bodies), default=0.0)
        strain = max((strained(body) for body in bodies), default=0.0)
        return cls(
            turn=ranks.max(turn),
            strain=ranks.max(strain),
            contact=changed / max(held, 1.0) if changed > _FEW_POINTS else 0.0,
            iterations=len(converged.iterations),
        )


def _ratio(limit: float, value: float) -> float:
    return limit / value if value > 0.0 else math.inf

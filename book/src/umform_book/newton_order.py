"""Order of Newton's method, measured for each increment, and the reason where it is below two."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from statistics import median
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from umform.results.records import Iteration

#: An order below this is low and needs a reason.
LOW = 1.8
#: Residual over error characterises the kind of error: a larger factor, up or down, is another kind.
_ANOTHER_KIND = 2.0
#: An error that has not fallen by this factor is no error of a converging iteration yet.
_CONVERGING = 3.0

CONTACT, FLOW, SEARCH, TURNS, FEW, OPEN = "contact", "flow", "search", "turns", "few", "open"
#: Meaning of the words, in the order in which they are tried.
REASONS = {
    CONTACT: "contact points entered or left",
    FLOW: "material points started or stopped to flow",
    SEARCH: "the line search shortened a step",
    TURNS: "stiff and soft errors (membrane and bending) alternate: residual over error rose and fell by more than a "
    "factor of two",
    FEW: "only the last two steps converge, so the first of their three errors need not be small",
    OPEN: "none of these",
}


@dataclass(frozen=True)
class NewtonOrder:
    """How Newton's method converged in a run.

    Attributes
    ----------
    order : float or None
        Median over the increments of the order of their last two steps; None if no increment has one.
    measured : int
        Number of increments with an order.
    low : dict of str to int
        Of these, how many have an order below 1.8, by reason.
    """

    order: float | None
    measured: int
    low: dict[str, int]

    def why(self) -> str:
        """Reasons in a few words."""
        if self.order is None:
            return "too short to tell"
        return ", ".join(f"{reason} {count}" for reason, count in self.low.items())


def measure(increments: Iterable[Sequence[Iteration]]) -> NewtonOrder:
    """Measure the increments of a run."""
    orders, low = [], Counter[str]()
    for iterations in increments:
        errors = measurable(iterations)
        order = newton_order(iterations)
        if order is None:
            continue
        orders.append(order)
        if order < LOW:
            low[reason(errors)] += 1
    return NewtonOrder(median(orders) if orders else None, len(orders), {key: low[key] for key in REASONS if low[key]})


def measurable(iterations: Sequence[Iteration]) -> list[Iteration]:
    """Iterations whose error stands out of round-off.

    The error is measured by the energy r . du of the increment, whose root is a norm of it. An energy at round-off
    is useless; round-off is at least the residual of the last iteration. Of an increment with several passes the last
    one counts.
    """
    if not iterations:
        return []
    first = max(k for k, record in enumerate(iterations) if record.number == 1)
    noise = max(1e-11, 30.0 * iterations[-1].residual)
    return [record for record in iterations[first:] if record.energy > 0.0 and record.residual > noise]


def newton_order(iterations: Sequence[Iteration]) -> float | None:
    """Order of convergence p of the last two steps of an increment, |e_(k+1)| ~ |e_k|^p; None for less than three."""
    errors = [math.sqrt(record.energy) for record in measurable(iterations)]
    if len(errors) < 3:
        return None
    before, middle, last = errors[-3:]
    if not last < middle < before:
        return None
    return math.log(last / middle) / math.log(middle / before)


def reason(errors: Sequence[Iteration]) -> str:
    """What kept the last two steps of an increment from the order two.

    Parameters
    ----------
    errors : sequence of Iteration
        Three or more iterations above round-off; each records what changed since the one before.
    """
    before, *steps = errors[-3:]
    if any(record.entered or record.left for record in steps):
        return CONTACT
    if any(record.switched for record in steps):
        return FLOW
    if any(record.step_length < 1.0 for record in steps):
        return SEARCH
    kinds = [math.log(record.residual / math.sqrt(record.energy)) for record in (before, *steps)]
    first, second = kinds[1] - kinds[0], kinds[2] - kinds[1]
    if first * second < 0.0 and min(abs(first), abs(second)) > math.log(_ANOTHER_KIND):
        return TURNS
    if len(errors) == 3 or errors[-4].energy < _CONVERGING**2 * before.energy:
        return FEW
    return OPEN

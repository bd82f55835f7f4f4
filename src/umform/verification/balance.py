"""What every nonlinear run is asked: do work and forces balance, does Newton converge quadratically?"""

from __future__ import annotations

import math
from dataclasses import dataclass
from statistics import median
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from umform.newton import Iteration
    from umform.results import Result


@dataclass(frozen=True)
class BalanceRow:
    """Balance of a run.

    Attributes
    ----------
    case, run : str
        Which run.
    increments, iterations : int
        How long it was.
    drift : float
        Largest difference of external work and energies in the run, over the largest energy in the run.
    force, moment : float
        Largest resultant of all external forces and their moments, over the sum of their sizes.
    order : float or None
        Order of Newton's method: median over the increments of the order of the last steps, None where no increment
        has enough iterations above round-off.
    measured : int
        Number of increments that have: short increments converge in fewer iterations than tell an order.
    """

    case: str
    run: str
    increments: int
    iterations: int
    drift: float
    force: float
    moment: float
    order: float | None
    measured: int


def balance_row(case: str, run: str, result: Result) -> BalanceRow:
    """Balance of a result."""
    balance = result.balance()
    energy = balance.elastic + balance.plastic + balance.contact
    orders = [order for iterations in result.iterations if (order := newton_order(iterations)) is not None]
    return BalanceRow(
        case=case,
        run=run,
        increments=len(result) - 1,
        iterations=int(result["iterations"].sum()),
        drift=float(np.abs(balance.external_work - energy).max() / (np.abs(energy).max() or 1.0)),
        force=float(np.abs(balance.force_imbalance).max()),
        moment=float(np.abs(balance.moment_imbalance).max()),
        order=median(orders) if orders else None,
        measured=len(orders),
    )


def newton_order(iterations: list[Iteration]) -> float | None:
    """Order of convergence p of the last two steps of an increment, |e_(k+1)| ~ |e_k|^p.

    The error is measured by the energy r . du of the increment, whose root is a norm of it. An energy at round-off
    tells nothing: round-off is where the residual of the last iteration is, at the lowest.
    """
    if not iterations:
        return None
    noise = max(1e-11, 30.0 * iterations[-1].residual)
    sizes = [math.sqrt(record.energy) for record in iterations if record.energy > 0.0 and record.residual > noise]
    if len(sizes) < 3:
        return None
    before, middle, last = sizes[-3:]
    if not last < middle < before:
        return None
    return math.log(last / middle) / math.log(middle / before)

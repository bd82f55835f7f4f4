"""Balance of work and forces of a nonlinear run, and the order of Newton's method."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from umform_book.newton_order import NewtonOrder, measure

#: An imbalance of the forces above this is not round-off.
_AT_REST = 1e-6

if TYPE_CHECKING:
    from umform.analysis.run import Result


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
    newton : NewtonOrder
        Order of Newton's method, and the reasons where it is low.
    """

    case: str
    run: str
    increments: int
    iterations: int
    drift: float
    force: float
    moment: float
    newton: NewtonOrder


def balance_row(case: str, run: str, result: Result) -> BalanceRow:
    """Balance of a result."""
    balance = result.balance()
    energy = balance.elastic + balance.plastic + balance.contact + balance.friction
    drift = balance.external_work - energy
    if abs(balance.force_imbalance[0]) > _AT_REST:  # a start inside of a tool is no equilibrium
        drift -= drift[min(1, len(drift) - 1)]
    force, moment = balance.largest_imbalances
    return BalanceRow(
        case=case,
        run=run,
        increments=len(result) - 1,
        iterations=int(result["iterations"].sum()),
        drift=float(np.abs(drift[1:]).max(initial=0.0) / (np.abs(energy).max() or 1.0)),
        force=force,
        moment=moment,
        newton=measure(result.iterations),
    )

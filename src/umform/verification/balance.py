"""What every nonlinear run is asked: do work and forces balance, does Newton converge quadratically, or why not?"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from umform.verification.newton_order import NewtonOrder, measure

if TYPE_CHECKING:
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
    energy = balance.elastic + balance.plastic + balance.contact
    return BalanceRow(
        case=case,
        run=run,
        increments=len(result) - 1,
        iterations=int(result["iterations"].sum()),
        drift=float(np.abs(balance.external_work - energy).max() / (np.abs(energy).max() or 1.0)),
        force=float(np.abs(balance.force_imbalance).max()),
        moment=float(np.abs(balance.moment_imbalance).max()),
        newton=measure(result.iterations),
    )

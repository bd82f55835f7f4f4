"""How far the forces and energies of a run are out of balance: for the random jobs and for the corpus."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

import umform as uf
from umform.results.balance import Balance

#: Largest resultant of all external forces, and of their moments, relative to their magnitudes: what the convergence
#: criterion of Newton's method leaves.
FORCES = 1e-6
#: Part of the largest energy below which forces are round-off: a sheet that nothing touches yet.
_NOTHING = 1e-12


def resultants(balance: Balance) -> tuple[float, float]:
    """Largest resultant of forces and of moments in the rows in which the sheet is loaded."""
    stored = np.abs(balance.elastic + balance.plastic + balance.contact)
    loaded = (stored > _NOTHING * stored.max()) & (np.arange(len(stored)) > 0)  # the start may be out of balance
    force, moment = (values[loaded].max(initial=0.0) for values in (balance.force_imbalance, balance.moment_imbalance))
    return float(force), float(moment)


def largest_drift(results: Iterable[uf.Result]) -> float:
    """Largest drift of the energies in some runs, over the largest energy of each."""
    return max((float(np.abs(result.balance().drift).max()) for result in results), default=0.0)

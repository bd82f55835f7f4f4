"""How well the forces and energies of a run are in balance: the largest imbalances of its increments, its works."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass

import numpy as np

from umform.results.history import History
from umform.results.quantity import Quantity

#: Drift from which on it is a warning.
LIMIT = 0.01
#: Energy over force times length, the order of the strains, below which there is nothing but round-off.
_NOTHING = 1e-9


@dataclass(frozen=True)
class Balanced:
    """The largest imbalances of a run, and its works and energies; NaN if the material states no energy.

    Works and energies are those of the modelled part of the sheet.

    Attributes
    ----------
    force_imbalance, moment_imbalance : float
        Largest resultant of all external forces and of their moments, relative. eq. (5.34)
    drift : float
        Largest difference of external work and energies over the largest energy. eq. (5.33)
    drift_step : int
        Step in which the drift is largest.
    small : bool
        Whether the drift is within its limit, or there are no energies but round-off.
    before : float
        Sum of the energies at the start.
    external_work, elastic, plastic, contact, friction : float
        External work with the energies at the start, and energies, at the end.
    works : dict of str to float
        Work of each tool, of loads and supports, and of contact beyond the mean.
    """

    force_imbalance: float
    moment_imbalance: float
    drift: float
    drift_step: int
    small: bool
    before: float
    external_work: float
    elastic: float
    plastic: float
    contact: float
    friction: float
    works: dict[str, float]

    @property
    def quantity(self) -> Quantity:
        """The drift with its limit, which round-off has not."""
        limit = None if self.small and self.drift > LIMIT else 100.0 * LIMIT
        return Quantity("drift of the energies", "%", value=100.0 * self.drift, limit=limit, digits=2)

    @property
    def text(self) -> str:
        """The imbalances as a line."""
        if math.isnan(self.drift):
            energies = "energies of the material unknown"
        else:
            limit = "" if self.small else f", {100.0 * LIMIT:g} % allowed: {self.quantity.verdict}"
            energies = f"work and energies differ by up to {100.0 * self.drift:.2g} % (step {self.drift_step}){limit}"
        return (
            f"{energies}; forces are in balance to {self.force_imbalance:.1g}, moments to {self.moment_imbalance:.1g}"
        )

    def record(self) -> dict[str, object]:
        """All of it as JSON data; None for unknown values."""
        return {name: _known(value) for name, value in asdict(self).items()}


def balanced(result: History) -> Balanced | None:
    """The balance of a run; None without an increment."""
    if len(result) < 2:
        return None
    balance = result.balance()
    drift = np.abs(balance.drift)
    worst = int(np.argmax(drift))
    energy = np.abs(balance.elastic + balance.plastic + balance.contact + balance.friction).max()
    force, moment = balance.largest_imbalances
    return Balanced(
        force_imbalance=force,
        moment_imbalance=moment,
        drift=float(drift[worst]),
        drift_step=int(balance.step[worst]),
        small=not (drift[worst] > LIMIT and energy > _NOTHING * result.largest_moment),  # an unknown energy is NaN
        before=float(balance.external_work[0]),
        external_work=float(balance.external_work[-1]),
        elastic=float(balance.elastic[-1]),
        plastic=float(balance.plastic[-1]),
        contact=float(balance.contact[-1]),
        friction=float(balance.friction[-1]),
        works={name: float(work[-1]) for name, work in balance.works.items()},
    )


def _known(value: object) -> object:
    return None if isinstance(value, float) and math.isnan(value) else value

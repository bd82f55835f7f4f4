"""Warning of increments that are too long: the work of a run and its energies differ."""

from __future__ import annotations

import math

import numpy as np

from umform.model import Model
from umform.results.history import History

#: Drift from which on it is a warning.
LIMIT = 0.01
#: Energy over force times length, the order of the strains, below which there is nothing but round-off.
_NOTHING = 1e-9


def warn_of_drift(model: Model, result: History) -> None:
    """Warn if the external work and the energies differ anywhere by more than a hundredth of the largest energy."""
    if len(result) < 2:
        return
    balance = result.balance()
    drift = np.abs(balance.drift)
    energy = np.abs(balance.elastic + balance.plastic + balance.contact + balance.friction).max()
    if not (drift.max() > LIMIT and energy > _NOTHING * result.largest_moment):  # an unknown energy is NaN
        return
    worst = int(np.argmax(drift))
    finer = math.ceil(2.0 * math.sqrt(drift[worst] / LIMIT)) / 2.0
    message = (
        f"the external work and the energies differ by {100.0 * drift[worst]:.2g} % of the largest energy in step "
        f"{balance.step[worst]:.0f}: its increments are too long for the works, or the sheet jumped to another shape; "
        f"at least {finer:g} times as many increments"
    )
    if any(contact.augmented for contact in model.contacts):  # multipliers remove a penetration without work. 4.12
        message += ", or a stiffer penalty, which leaves less to the multipliers"
    if message not in result.warnings:  # a run that was taken up at its end
        result.warn(message)

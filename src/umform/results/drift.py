"""Warning of increments that are too long: the work of a run and its energies differ."""

from __future__ import annotations

import math

from umform.model import Model
from umform.results.balance_summary import LIMIT, balanced
from umform.results.history import History


def warn_of_drift(model: Model, result: History) -> None:
    """Warn if the external work and the energies differ anywhere by more than a hundredth of the largest energy."""
    found = balanced(result)
    if found is None or found.small:
        return
    finer = math.ceil(2.0 * math.sqrt(found.drift / LIMIT)) / 2.0
    message = (
        f"the external work and the energies differ by {100.0 * found.drift:.2g} % of the largest energy in step "
        f"{found.drift_step}: its increments are too long for the works, or the sheet jumped to another shape; "
        f"at least {finer:g} times as many increments"
    )
    if model.system.multiplied:  # multipliers remove a penetration without work. 4.12
        message += ", or a stiffer penalty, which leaves less to the multipliers"
    if message not in result.warnings:  # a run that was taken up at its end
        result.warn(message)

"""Warning of forces that are not in balance: Newton's method was asked for too little."""

from __future__ import annotations

from umform.results.balance_summary import balanced
from umform.results.history import History

#: Largest resultant of all external forces, relative to their magnitudes, and largest tolerance that need no warning:
#: small forces on a sheet that hardly bears any are never in balance to a part of themselves.
_LIMIT, _TIGHT = 0.01, 0.01


def warn_of_imbalance(result: History, tolerance: float) -> None:
    """Warn if the external forces of an increment are out of balance by more than a hundredth.

    Parameters
    ----------
    result : History
        The result.
    tolerance : float
        Tolerance of the residual.
    """
    found = balanced(result) if tolerance > _TIGHT else None
    if found is None or not found.force_imbalance > _LIMIT:
        return
    message = (
        f"the forces are out of balance by up to {100.0 * found.force_imbalance:.2g} %: the tolerance of the residual, "
        f"{tolerance:g} of the forces of the elements, is too large; 1e-3 does for drawn parts, the default is 1e-9"
    )
    if message not in result.warnings:  # a run that was taken up at its end
        result.warn(message)

"""Numbers as the book prints them: those that differ between machines, such as round-off, are bounds."""

from __future__ import annotations

#: Numbers below this are round-off in any check.
_ROUND_OFF = 1e-12
#: A check with a limit up to this is about round-off or Newton's tolerance: whether it passes is all that is stable.
_NUMERICAL = 1e-5
#: Numbers of tables below this are round-off.
_TABLE = 1e-10


def bounded(value: float, limit: float) -> str:
    """A bound such as "below 1e-10" for an error at round-off; empty if the number itself is to be printed.

    Parameters
    ----------
    value : float
        The error.
    limit : float
        Largest error that passes. If it is numerical (1e-5 or less) it is the bound: another processor changes such
        errors by any factor. Otherwise the bound is 1e-12. An exact zero of a count has no bound.
    """
    size = abs(value)
    if not size <= limit or (size == 0.0 and not 0.0 < limit < 0.5):
        return ""
    if limit <= _NUMERICAL:
        return _below(limit)
    return _below(_ROUND_OFF) if size <= _ROUND_OFF else ""


def _below(limit: float) -> str:
    return f"below {limit:g}".replace("e-0", "e-")


def about(count: int) -> int:
    """A count, such as that of iterations, that differs a little between machines: two digits."""
    return round(count, 2 - len(str(abs(count))))


def shown(value: float, digits: int = 4) -> str:
    """A number of a table: four digits, a bound at round-off, a dash for none."""
    if value != value:
        return "-"
    if 0.0 < abs(value) <= _TABLE:
        return _below(_TABLE)
    return f"{value:.{digits}g}"

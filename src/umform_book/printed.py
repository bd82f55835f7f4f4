"""Numbers as the book prints them: round-off, which differs between machines, stands as a bound."""

from __future__ import annotations

#: Bounds that stand for round-off and for what Newton's tolerance leaves.
_BOUNDS = (1e-12, 1e-10, 1e-8, 1e-6)
#: A check with a larger limit is about mechanics: its number is printed unless it is below the first bound.
_NUMERICAL = 1e-5
#: Numbers of tables below this are round-off.
_TABLE = 1e-10


def bounded(value: float, limit: float) -> str:
    """A bound such as "below 1e-12" for an error at round-off; empty if the number itself is to be printed.

    Parameters
    ----------
    value : float
        The error.
    limit : float
        Largest error that passes. The bound is never above it; an exact zero of a count has no bound.
    """
    size = abs(value)
    if not size <= limit or (size == 0.0 and not 0.0 < limit < 0.5):
        return ""
    bounds = _BOUNDS if limit <= _NUMERICAL else _BOUNDS[:1]
    found = next((bound for bound in bounds if size <= bound), 0.0)
    return f"below {min(found, limit):g}".replace("e-0", "e-") if found else ""


def about(count: int) -> int:
    """A count, such as that of iterations, that differs a little between machines: two digits."""
    return round(count, 2 - len(str(abs(count))))


def shown(value: float, digits: int = 4) -> str:
    """A number of a table: four digits, a bound at round-off, a dash for none."""
    if value != value:
        return "-"
    if 0.0 < abs(value) <= _TABLE:
        return bounded(value, _TABLE)
    return f"{value:.{digits}g}"

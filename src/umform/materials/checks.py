"""Checks that the parameters of all laws share."""

from __future__ import annotations

import math

from umform.errors import NotFinite


def check_finite(where: str, **values: float) -> None:
    """Reject numbers that are not finite.

    Raises
    ------
    NotFinite
        With the name of the first such number.
    """
    for name, value in values.items():
        if not math.isfinite(value):
            raise NotFinite(
                f"{name} is not a finite number",
                where=where,
                value=value,
                cause="an earlier computation, or an empty cell of a table",
                remedy="give a finite number",
            )

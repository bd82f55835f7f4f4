"""Outcomes that a user gives to a study must be those of its case."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from umform.analysis.run.fingerprint import text
from umform.errors import InvalidValue
from umform.results.outcome import Outcome


def refuse_other_case(outcome: Outcome, case: Any, where: str) -> None:
    """Refuse the outcome of another case; what the case leaves open, such as a stroke for an angle, may be any.

    Raises
    ------
    InvalidValue
        They differ.
    """
    own = getattr(outcome, "case", case)
    if type(own) is not type(case):
        others = [type(own).__name__]
    elif own is case:
        return
    else:
        pairs = {one.name: (getattr(own, one.name), getattr(case, one.name)) for one in fields(case)}
        others = [name for name, (one, other) in pairs.items() if other is not None and text(one) != text(other)]
    if others:
        raise InvalidValue(
            "this is the outcome of another case",
            where=where,
            value=f"another {', '.join(others)}",
            cause="a case that was changed after its run",
            remedy="the outcome of this case, or none: then it is run",
        )

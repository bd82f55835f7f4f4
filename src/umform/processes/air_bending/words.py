"""Measures as rows of text: for the terminal, the report and files."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING

from umform.processes.air_bending.measures import QUANTITIES, Measures

if TYPE_CHECKING:
    from umform.processes.air_bending.budget import Budget

#: Text of an unknown number.
_UNTOLD = "–"
#: Columns of a bending table.
_TABLE = ("stroke", "loaded_angle", "angle", "springback", "force", "radius", "k_factor", "bend_deduction")


def summary_header(budget: Budget | None = None) -> list[str]:
    """Names of the columns of `summary`."""
    return ["quantity", "value", *(["±", *budget.changes] if budget else []), "unit"]


def summary(measures: Measures, width: float | None = None, budget: Budget | None = None) -> list[list[str]]:
    """Rows of all measures; with a budget, the uncertainty and the change by each refinement."""
    rows = []
    for name, quantity in QUANTITIES.items():
        digits = quantity.decimals
        hint = f" ({quantity.hint})" if quantity.hint and budget is None else ""
        row = [quantity.label + hint, _told(getattr(measures, name), f".{digits}f")]
        if budget:
            row.append(_told(budget.total(name), f".{digits}f"))
            row += [_told(change[name], f"+.{digits}f") for change in budget.changes.values()]
        rows.append([*row, quantity.unit])
    if width is not None:
        blank = [""] * (1 + len(budget.changes)) if budget else []
        rows.insert(3, ["force on the width", f"{measures.largest_force * width / 1e3:.2f}", *blank, "kN"])
    return rows


def table_header() -> list[str]:
    """Names of the columns of `table_rows`."""
    return [f"{QUANTITIES[name].label}, {QUANTITIES[name].unit}".rstrip(", ") for name in _TABLE]


def table_rows(table: Sequence[Measures]) -> list[list[str]]:
    """Rows of a bending table."""
    return [[_told(getattr(row, name), f".{QUANTITIES[name].decimals}f") for name in _TABLE] for row in table]


def _told(value: float, form: str) -> str:
    return _UNTOLD if math.isnan(value) else f"{value:{form}}"


def columns(table: Sequence[Measures]) -> dict[str, list[float]]:
    """All measures of a bending table as columns."""
    return {name: [asdict(row)[name] for row in table] for name in QUANTITIES}

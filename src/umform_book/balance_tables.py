"""Balance of work and forces, and the order of Newton's method: a line, the table of a page, the page of all cases."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from statistics import median

from umform_book.balance import BalanceRow
from umform_book.case import Chapter
from umform_book.markdown import markdown_table
from umform_book.newton_order import LOW, REASONS
from umform_book.outcome import Outcome
from umform_book.printed import bounded

#: Imbalances up to this are Newton's tolerance and round-off: a bound stands for them.
_TOLERANCE = 1e-6

_MEANING = f"""\
**Drift**: largest difference between external work and the sum of stored, dissipated, contact and friction energy,
over the largest energy of the run. If a sheet starts inside a tool, the drift counts from the first equilibrium.
**Forces**, **moments**: resultant of all external forces or moments over the sum of their sizes.
**Order of Newton**: median over the increments of the order of the last two steps. Problems that are linear but for
contact have orders far above 2: with the right active set, one step gives the answer.
**Low**: the most frequent reason for an order below {LOW:g}."""


def balance_line(rows: Sequence[BalanceRow]) -> str:
    """Worst balance of some runs in a sentence."""
    drift, force, moment, order = _worst(rows)
    runs = f"{len(rows)} nonlinear run{'s' * (len(rows) > 1)}"
    return (
        f"{runs}: drift of energy {drift}, imbalance of forces {force}, of moments {moment}, order of Newton {order}."
    )


def balance_table(rows: Sequence[BalanceRow]) -> str:
    """Balance of each run, and what the columns mean."""
    columns = ("run", "increments", "drift", "forces", "moments", "order of Newton", "low")
    cells = [
        (row.run, str(row.increments), _size(row.drift), _size(row.force), _size(row.moment), _order([row]), _low(row))
        for row in rows
    ]
    reasons = [f"*{word}*: {meaning}" for word, meaning in REASONS.items() if any(word == _low(row) for row in rows)]
    legend = f"Low order, reasons: {'; '.join(reasons)}.\n\n" if reasons else ""
    return f"{markdown_table(columns, cells)}\n\n{legend}[What the columns mean](balance.md)"


def balance_page(chapters: Sequence[Chapter], outcomes: Mapping[str, Outcome]) -> str:
    """Markdown of the page with one row for each case."""
    rows = []
    for case in (case for chapter in chapters for case in chapter.cases):
        found = outcomes[case.name].balances if case.name in outcomes else ()
        if found:
            rows.append((f"[{case.title}]({case.name}.md)", str(len(found)), *_worst(found)))
    table = markdown_table(("case", "runs", "drift", "forces", "moments", "order of Newton"), rows)
    reasons = "\n".join(f"* *{word}*: {meaning}" for word, meaning in REASONS.items())
    parts = ["# Balance of all nonlinear runs", "The worst run of each case; each page lists its own runs.", table]
    parts += ["## What the columns mean", _MEANING, "Reasons for a low order:", reasons, "[All cases](README.md)"]
    return "\n\n".join(parts) + "\n"


def _worst(rows: Sequence[BalanceRow]) -> tuple[str, str, str, str]:
    drift, force, moment = (max(getattr(row, name) for row in rows) for name in ("drift", "force", "moment"))
    return _size(drift), _size(force), _size(moment), _order(rows)


def _size(value: float) -> str:
    """A part of the whole: two digits, or a bound at the tolerance of Newton's method and below."""
    return bounded(value, _TOLERANCE) or f"{value:.1e}"


def _order(rows: Sequence[BalanceRow]) -> str:
    """Median of the orders, to one digit after the point."""
    orders = [row.newton.order for row in rows if row.newton.order is not None and math.isfinite(row.newton.order)]
    return f"{median(orders):.1f}" if orders else "-"


def _low(row: BalanceRow) -> str:
    """The most frequent reason of a low order; an empty cell where less than a tenth of the increments is low."""
    low = row.newton.low
    if sum(low.values()) < 0.1 * max(row.newton.measured, 1):
        return ""
    return max(low, key=lambda reason: low[reason], default="")

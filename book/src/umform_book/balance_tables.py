"""Balance of work and forces, and the order of Newton's method: a line, the table of a page, the page of all cases."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from statistics import median

from umform_book.balance import BalanceRow
from umform_book.case import Chapter
from umform_book.markdown import markdown_table
from umform_book.newton_order import LOW, REASONS
from umform_book.outcome import Outcome
from umform_book.printed import bounded

#: Imbalances up to this are Newton's tolerance and round-off, and are printed as a bound.
_TOLERANCE = 1e-6

#: Columns of the page of all cases.
WORST = ("runs", "drift", "forces", "moments", "order of Newton")

_MEANING = f"""\
* **Drift**: largest difference between external work and the sum of stored, dissipated, contact and friction energy,
  over the largest energy of the run. If a sheet starts inside a tool, the drift counts from the first equilibrium.
* **Forces**, **moments**: resultant of all external forces or moments over the sum of their sizes.
* **Order of Newton**: median over the increments of the order of the last two steps; *quadratic* from {LOW:g} on, else
  the order with the most frequent reason."""


def balance_line(rows: Sequence[BalanceRow]) -> str:
    """Worst balance of some runs in a sentence."""
    number, drift, force, moment, order = worst_balance(rows).values()
    runs = f"{number} nonlinear run{'s' * (len(rows) > 1)}"
    return (
        f"{runs}: drift of energy {drift}, imbalance of forces {force}, of moments {moment}, order of Newton {order}."
    )


def balance_table(rows: Sequence[BalanceRow]) -> str:
    """Balance of each run."""
    columns = ("run", "increments", "drift", "forces", "moments", "order of Newton")
    cells = [
        (row.run, str(row.increments), _size(row.drift), _size(row.force), _size(row.moment), _order([row]))
        for row in rows
    ]
    return f"{markdown_table(columns, cells)}\n\n[What the columns mean](balance.md)"


def balance_page(chapters: Sequence[Chapter], outcomes: Mapping[str, Outcome]) -> str:
    """Markdown of the page with one row for each case."""
    rows = []
    for case in (case for chapter in chapters for case in chapter.cases):
        found = outcomes[case.name].balance if case.name in outcomes else None
        if found:
            rows.append((f"[{case.title}]({case.name}.md)", *(found[column] for column in WORST)))
    table = markdown_table(("case", *WORST), rows)
    reasons = "\n".join(f"* *{word}*: {meaning}" for word, meaning in REASONS.items())
    parts = ["# Balance of all nonlinear runs", "The worst run of each case; each page lists its own runs.", table]
    parts += ["## What the columns mean", _MEANING, "Reasons for a low order:", reasons, "[All cases](README.md)"]
    return "\n\n".join(parts) + "\n"


def worst_balance(rows: Sequence[BalanceRow]) -> dict[str, str]:
    """The number of runs and their worst balance as it is printed, by column of the page of all cases."""
    sizes = (_size(max(getattr(row, name) for row in rows)) for name in ("drift", "force", "moment"))
    return dict(zip(WORST, (str(len(rows)), *sizes, _order(rows)), strict=True))


def _size(value: float) -> str:
    """A ratio: two digits, or a bound at the tolerance of Newton's method and below."""
    return bounded(value, _TOLERANCE) or f"{value:.1e}"


def _order(rows: Sequence[BalanceRow]) -> str:
    """Median of the orders: quadratic from 1.8 on, else to one digit, with the most frequent reason."""
    orders = [row.newton.order for row in rows if row.newton.order is not None and math.isfinite(row.newton.order)]
    if not orders:
        return "-"
    if median(orders) >= LOW:
        return "quadratic"
    low = sum((Counter(row.newton.low) for row in rows), Counter[str]())
    return f"{median(orders):.1f} ({max(low, key=lambda reason: low[reason])})"

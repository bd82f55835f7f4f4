"""The lines about penetration and balance of the runs of a process, in red where a limit was not kept."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console

    from umform.results.history import History


def show_checks(screen: Console, stages: Mapping[str, History], *, everything: bool = True) -> None:
    """Print a line for each contact and one for the balance, of each run by its name; or only of limits not kept."""
    from umform.results.balance_summary import balanced
    from umform.results.penetration import stage_penetrations

    def show(text: str, kept: bool) -> None:
        if everything or not kept:
            screen.print(text, soft_wrap=True, markup=False, style=None if kept else "bold red")

    for stage, rows in stage_penetrations(stages).items():
        which = f"{stage}, " if len(stages) > 1 else ""
        for name, reached in rows.items():
            show(f"{which}contact {name}: {reached.text}", reached.kept)
        if (balance := balanced(stages[stage])) is not None:
            show(f"{which}balance: {balance.text}", balance.small)

"""The lines of the contacts of a run: allowed and reached penetration, in red where it was not kept."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console

    from umform.results.history import History


def show_contacts(screen: Console, result: History) -> None:
    """Print a line for each contact."""
    from umform.results.penetration import penetrations

    for name, reached in penetrations(result.model, result).items():
        style = None if reached.kept else "bold red"
        screen.print(f"contact {name}: {reached.text}", soft_wrap=True, markup=False, style=style)

"""``umform elements``: the catalogue."""

from __future__ import annotations

from typing import TYPE_CHECKING

from umform.cli.root import app, console

if TYPE_CHECKING:
    from umform.elements.technology import Element


@app.command()
def elements() -> None:
    """Show the catalogue of elements."""
    from rich import box
    from rich.table import Table

    from umform.elements import CATALOGUE

    table = Table("name", "nodes", "assumed strains", "enhanced modes", "source", box=box.SIMPLE_HEAD)
    for name, make in CATALOGUE.items():
        table.add_row(name, *_described(make()))
    console().print(table)


def _described(element: Element) -> tuple[str, str, str, str]:
    """Nodes, tied components, number of modes per component, source."""
    tied = " ".join(dict.fromkeys(f"E{row.component}" for row in element.tying)) or "none"
    counts: dict[str, int] = {}
    for mode in element.modes:
        component = "+".join(dict.fromkeys(f"E{part.component}" for part in mode.polynomials))
        counts[component] = counts.get(component, 0) + 1
    enhanced = ", ".join(f"{count} {component}" for component, count in counts.items()) or "none"
    return str(element.nodes), tied, enhanced, element.citation

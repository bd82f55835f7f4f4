"""What `umform bend` prints: measures, bending table, remarks."""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

from umform.cli.root import console
from umform.cli.run_checks import show_checks
from umform.cli.warnings import echo_warnings

if TYPE_CHECKING:
    from umform.processes.air_bending.bend import AirBend
    from umform.processes.air_bending.budget import Budget
    from umform.processes.air_bending.measures import Measures


def show_bend(done: AirBend, rows: list[Measures], errors: Budget | None, note: str, length: float | None) -> None:
    """Print measures, bending table, and remarks."""
    from umform.processes.air_bending.formulas import shop_forces
    from umform.processes.air_bending.remarks import remarks, tools_text, total_force
    from umform.processes.air_bending.words import summary, summary_header, table_header, table_rows

    screen = console()
    screen.print(tools_text(done.case), soft_wrap=True)
    _print_table("Air bending", summary_header(errors), summary(done.measures, done.case.width, errors))
    screen.print("rows of the table: docs/air-bending.md, What is measured")
    low, high = shop_forces(done.case)
    screen.print(f"rule of the shop for the largest force: {low:.1f} to {high:.1f} N/mm (1.33 to 1.42 Rm t²/V)")
    if length is not None:
        screen.print(total_force(done.measures.largest_force, length), soft_wrap=True)
    for remark in remarks(done.case, done.measures):
        screen.print(remark, soft_wrap=True)
    if rows:
        _print_table("Bending table", table_header(), table_rows(rows))
    show_checks(screen, done.stages)
    if note:
        screen.print(note, soft_wrap=True)
    echo_warnings(done.warnings)
    for name, why in (errors.failures if errors else {}).items():
        typer.echo(f"umform: {name}: {why}", err=True)


def _print_table(title: str, header: list[str], rows: list[list[str]]) -> None:
    from rich import box
    from rich.table import Table

    table = Table(title=title, box=box.SIMPLE_HEAD)
    for number, name in enumerate(header):
        table.add_column(name, justify="left" if number == 0 or name == "unit" else "right", no_wrap=number == 0)
    for row in rows:
        table.add_row(*row)
    console().print(table)

"""The end of each step of a run as a table: quantities are rows, steps are columns."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.table import Table

    from umform.results.history import History

#: Characters that the table adds to each column, and at its ends.
_GUTTER, _ENDS = 3, 1


def step_rows(result: History) -> list[list[str]]:
    """Rows of text: a header, then time, increments, iterations and each control with its force.

    No row: what never changes in the run, what is zero at the end of every step, and the force of a load, which is the
    load itself.
    """
    steps = sorted({int(row["step"]) for row in result.rows} - {0})
    within = [[row for row in result.rows if row["step"] == step] for step in steps]
    names: list[str] = []
    for control in result.model.controls:
        force = f"{control.name}_force"
        load = all(row[control.name] == row[force] for row in result.rows)
        names += [control.name] if load else [control.name, force]
    changing = [name for name in names if len({row[name] for row in result.rows}) > 1]
    shown = [name for name in changing if any(rows[-1][name] for rows in within)]
    return [
        ["step", *map(str, steps)],
        ["time", *(f"{rows[-1]['time']:.6g}" for rows in within)],
        ["increments", *(str(len(rows)) for rows in within)],
        ["iterations", *(str(int(sum(row["iterations"] for row in rows))) for rows in within)],
        *([name, *(f"{rows[-1][name] + 0.0:.6g}" for rows in within)] for name in shown),
    ]


def step_tables(result: History, width: int) -> Iterator[Table]:
    """The table in as many parts as the width needs, each with whole columns; at least one step a part."""
    from rich import box
    from rich.table import Table

    rows = step_rows(result)
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    for columns in blocks(widths, width):
        exact = sum(widths[column] + _GUTTER for column in (0, *columns)) + _ENDS
        table = Table(width=exact, box=box.SIMPLE_HEAD)  # rich never shortens a table of given width
        for column in (0, *columns):
            table.add_column(rows[0][column], justify="right" if column else "left", no_wrap=True)
        for row in rows[1:]:
            table.add_row(row[0], *(row[column] for column in columns))
        yield table


def blocks(widths: Sequence[int], width: int) -> list[list[int]]:
    """Numbers of the columns, from 1 on, that fit beside column 0 into a width."""
    room = width - _ENDS - widths[0] - _GUTTER
    found: list[list[int]] = [[]]
    used = 0
    for column, need in enumerate(widths[1:], start=1):
        if found[-1] and used + need + _GUTTER > room:
            found.append([])
            used = 0
        found[-1].append(column)
        used += need + _GUTTER
    return found

"""Take all measures of a deck after its run, and write them: tables, pictures, a part of the report."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from umform.analysis.run import Result
from umform.errors import UmformError
from umform.io.tables import write_csv
from umform.problem.measures.base import FORMED, RELEASED, Formed, Measured, Row
from umform.problem.prepared import Prepared
from umform.problem.problem import Problem
from umform.problem.unloading import loading_steps
from umform.results.budget import Budget
from umform.results.outcome import QUANTITIES
from umform.results.quantity import Quantity, list_columns, table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from umform.problem.contents import Contents

#: Table of all numbers.
TABLE = "measures.csv"
#: Numbers of a measure, and of all of them, on the first screen of a report.
_FIRST, _LEADING = 3, 8
#: Tables and pictures of single measures are named after them.
_OF_ONE = "measure-{}"
#: Their names.
OF_ONE = re.compile(_OF_ONE.format(r"[A-Za-z][\w-]{0,100}") + r"\.(csv|png)", re.ASCII)


@dataclass(frozen=True)
class Taken:
    """The measures of a run by name; one that could not be taken is a warning of the run.

    Attributes
    ----------
    measures : dict of str to Measured
        The measures.
    length : str
        Unit of lengths.
    budget : Budget or None
        Changes of all numbers by coarser runs, if they were asked for.
    ends : sequence of Quantity
        Controls and their forces at the end of each step, largest values of forming; with a budget only.
    """

    measures: dict[str, Measured] = field(default_factory=dict)
    length: str = ""
    budget: Budget | None = None
    ends: Sequence[Quantity] = ()

    @classmethod
    def of(cls, deck: Problem, problem: Prepared, result: Result, *, complete: bool) -> Taken:
        """Take the measures; maps add their fields to the frames.

        Parameters
        ----------
        deck : Problem
            The deck.
        problem : Prepared
            Its problem.
        result : Result
            Its run.
        complete : bool
            Whether the run has reached its end.
        """
        contents = deck.contents
        if not contents.measures or not result.rows:
            return cls(length=contents.units.length)
        tools: dict[str, str] = {}
        for name, contact in contents.contacts.items():
            tools.setdefault(contact.tool, name)
        names = {"units": contents.units, "tools": tools, "placed": deck.placed}
        part = Formed.of(result, problem, loading_steps(contents), complete, **names)
        measures = {}
        for name, wanted in contents.measures.items():
            try:
                measures[name] = wanted.take(name, part)
            except (UmformError, ArithmeticError, ValueError) as error:  # a measure must not lose the run
                result.warn(f"measure {name} is left out: {error}")
        return cls(measures, contents.units.length)

    def with_budget(self, budget: Budget, ends: Sequence[Quantity], *, of_mesh: bool) -> Taken:
        """With the bands of a budget, which are those of this mesh if no run had another one."""
        bands = budget.bands

        def banded(one: Quantity, name: str) -> Quantity:
            return replace(one, band=bands[name], of_mesh=of_mesh)

        measures = {
            name: replace(
                measured,
                rows=[
                    {state: banded(one, _named_as(name, one, state)) for state, one in row.items()}
                    for row in measured.rows
                ],
            )
            for name, measured in self.measures.items()
        }
        return replace(self, measures=measures, budget=budget, ends=[banded(one, one.name) for one in ends])

    @property
    def quantities(self) -> list[Quantity]:
        """All numbers; their names are those of the measure, of the number and of the state, with points between."""
        found = [
            replace(one, name=_named_as(name, one, state), label=f"{name}: {one.label}, {state}")
            for name, row in self.rows
            for state, one in row.items()
        ]
        return [*found, *self.ends]

    @property
    def leading(self) -> list[Quantity]:
        """The numbers for the first screen: the first ones of each measure, in its last state."""
        firsts = [(name, row) for name, one in self.measures.items() for row in one.rows[:_FIRST]][:_LEADING]
        found = [(name, list(row.values())[-1]) for name, row in firsts]
        labels = [one.label for _, one in found]
        return [
            replace(
                one,
                label=one.label if labels.count(one.label) == 1 else f"{name}: {one.label}",
                of_mesh=one.band is None or one.of_mesh,
            )
            for name, one in found
        ]

    @property
    def rows(self) -> list[tuple[str, Row]]:
        """All numbers, with the names of their measures."""
        return [(name, row) for name, measured in self.measures.items() for row in measured.rows]

    @property
    def is_released(self) -> bool:
        """Whether there is a number of a released part."""
        return any(RELEASED in row and row[RELEASED].value is not None for _, row in self.rows)

    @property
    def table(self) -> list[list[str]]:
        """Rows of text, behind a header; without the column of the released part if there is none.

        With a budget each number has a row, with its error and its changes.
        """
        if self.budget is not None:
            return table(self.quantities)
        states = [FORMED, *[RELEASED] * self.is_released]
        rows = []
        for name, row in self.rows:
            first = next(iter(row.values()))
            rows.append([name, first.label, *(row[state].text if state in row else "" for state in states), first.unit])
        return [["measure", "quantity", *states, "unit"], *rows]

    def write(self, folder: Path) -> None:
        """Write the table of all numbers, and that of each measure."""
        if self.budget is not None:
            write_csv(folder / QUANTITIES, list_columns(self.quantities))
        if not self.measures:
            return
        names, rows = zip(*self.rows, strict=True)
        firsts = [next(iter(row.values())) for row in rows]
        states = {state: [row[state].value if state in row else None for row in rows] for state in (FORMED, RELEASED)}
        columns = {"quantity": [one.label for one in firsts], **states, "unit": [one.unit for one in firsts]}
        write_csv(folder / TABLE, {"measure": names, **columns})
        for name, measured in self.measures.items():
            write_csv(folder / f"{_OF_ONE.format(name)}.csv", measured.columns)

    def draw(self, folder: Path) -> None:
        """Write the picture of each measure."""
        from umform.plotting import save

        for name, figure in self.pictures.items():
            save(figure, folder / f"{_OF_ONE.format(name)}.png", dpi=120)

    @cached_property
    def pictures(self) -> dict[str, Figure]:
        """Pictures by the names of the measures, each drawn once."""
        return {name: measured.picture() for name, measured in self.measures.items()}

    def parts(self) -> Iterator[str]:
        """The part of the report."""
        if not self.measures and self.budget is None:
            return
        from umform.report import parts

        yield parts.heading("Measures")
        header, *rows = self.table
        yield parts.table(header, rows)
        for name, measured in self.measures.items():
            yield parts.figure(self.pictures[name], f"{name}: {measured.caption}")


def may_report(contents: Contents, name: str) -> bool:
    """Whether a measure of a deck may have a number of this name: that of the measure, of the number, of the state."""
    measure, _, rest = name.partition(".")
    number, _, state = rest.rpartition(".")
    wanted = contents.measures.get(measure)
    return wanted is not None and number.startswith(wanted.numbers) and state in _states_of(contents)


def names_begin(contents: Contents) -> list[str]:
    """Names of the numbers of a deck for messages; a star stands for letters that the run knows."""
    return [
        f"{name}.{begin}{'' if begin.strip() == begin != '' else '*'}.{state}"
        for name, measure in contents.measures.items()
        for begin in measure.numbers
        for state in _states_of(contents)
    ]


def _states_of(contents: Contents) -> list[str]:
    return [FORMED, *[RELEASED] * (loading_steps(contents) < len(contents.steps))]


def _named_as(measure: str, one: Quantity, state: str) -> str:
    return f"{measure}.{one.name}.{state}"


def data_files(*folders: Path) -> list[str]:
    """Names of the tables of single measures in some folders; those of an earlier run too."""
    return _named(folders, "csv")


def picture_files(*folders: Path) -> list[str]:
    """Names of the pictures, likewise."""
    return _named(folders, "png")


def _named(folders: tuple[Path, ...], kind: str) -> list[str]:
    return sorted({file.name for folder in folders for file in folder.glob(_OF_ONE.format("*") + f".{kind}")})

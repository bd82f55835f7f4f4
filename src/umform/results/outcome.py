"""What a process reports of its runs; terminal, page, files, sweeps and the bench read nothing else."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from umform.errors import InvalidValue
from umform.io.tables import write_csv
from umform.results.balanced import balanced
from umform.results.history import History
from umform.results.penetration import stage_penetrations
from umform.results.quantity import Quantity, list_columns, prefixed, table, values
from umform.results.run_record import run_record

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: Heading of the table of all quantities.
MEASURES = "Measures"
#: File of the quantities of an outcome.
QUANTITIES = "quantities.csv"


@dataclass(frozen=True)
class Annex:
    """A study of an outcome, such as its derivatives: what terminal and page show of it behind the outcome.

    Attributes
    ----------
    title : str
        Heading.
    table : list of list of str
        A header, then rows of cells.
    notes, warnings : sequence of str
        What belongs beside the numbers, and what makes them doubtful.
    picture : callable, optional
        Makes its figure.
    caption : str
        Text below the figure.
    """

    title: str
    table: list[list[str]]
    notes: Sequence[str] = ()
    warnings: Sequence[str] = ()
    picture: Callable[[], Figure] | None = None
    caption: str = ""


class Outcome(ABC):
    """Base of the results of processes: quantities, runs, warnings, notes."""

    #: Studies of the results.
    annexes: Sequence[Annex] = ()

    def with_annex(self, annex: Annex) -> Self:
        """The outcome with one more study."""
        other = copy(self)
        object.__setattr__(other, "annexes", (*self.annexes, annex))  # outcomes are frozen
        return other

    @property
    @abstractmethod
    def title(self) -> str:
        """Heading of tables and pages."""

    @property
    @abstractmethod
    def quantities(self) -> list[Quantity]:
        """The numbers that the process reports, in the order of tables."""

    def __repr__(self) -> str:
        numbers = ", ".join(f"{one.name}={one.full_text}" for one in self.leading)
        return f"{type(self).__name__}({numbers})"

    @property
    def leading(self) -> list[Quantity]:
        """The few numbers that are shown first: those that are marked, and those beyond a limit; without marks, all."""
        found = self.quantities
        return [one for one in found if one.leading or one.missed] if any(one.leading for one in found) else found

    @property
    def main(self) -> Sequence[str]:
        """Names of the quantities that the process is for, the first one first: what a picture shows."""
        return [one.name for one in self.quantities[:1]]

    @property
    @abstractmethod
    def stages(self) -> Mapping[str, History]:
        """The runs by their names, in order."""

    @property
    @abstractmethod
    def warnings(self) -> Sequence[str]:
        """What makes the numbers doubtful."""

    @property
    def length(self) -> str:
        """Unit of lengths."""
        return "mm"

    @property
    def notes(self) -> list[str]:
        """What belongs beside the numbers."""
        return []

    @property
    def all_notes(self) -> list[str]:
        """The notes, and where the errors of the quantities come from."""
        bands = (one.band for one in self.quantities)
        return [*self.notes, *dict.fromkeys(f"error: {band.source}" for band in bands if band is not None)]

    @property
    def tables(self) -> dict[str, list[list[str]]]:
        """Tables for people by their headings: a header, then rows of cells."""
        return {MEASURES: table(self.quantities)}

    @property
    def short_tables(self) -> dict[str, list[list[str]]]:
        """The tables with the leading numbers only."""
        found = self.tables
        return found | {MEASURES: table(self.leading)} if MEASURES in found else found

    @property
    def checks(self) -> list[Quantity]:
        """Penetration of each contact and drift of the energies of each run, with their limits."""
        return checks(self.stages, self.length)

    @property
    def values(self) -> dict[str, float | None]:
        """Values of the quantities by name; None for unknown ones."""
        return values(self.quantities)

    def __getitem__(self, name: str) -> Quantity:
        """A quantity by its name."""
        found = {one.name: one for one in self.quantities}
        if name not in found:
            raise InvalidValue("the outcome has no such quantity", value=name, remedy="one of " + ", ".join(found))
        return found[name]

    @property
    def increments(self) -> int:
        """Number of increments of all runs."""
        return sum(len(run) - 1 for run in self.stages.values())

    @property
    def iterations(self) -> int:
        """Number of Newton iterations of all runs."""
        return int(sum(run["iterations"].sum() for run in self.stages.values()))

    @property
    def seconds(self) -> float:
        """Wall time of all runs."""
        return sum(run.seconds for run in self.stages.values())

    def write(self, folder: Path) -> None:
        """Write all quantities and checks as a table, `QUANTITIES`."""
        write_csv(folder / QUANTITIES, list_columns([*self.quantities, *self.checks]))

    def record(self) -> dict[str, Any]:
        """Quantities, checks, effort and warnings as JSON data."""
        return {
            "quantities": [one.record() for one in self.quantities],
            "checks": [one.record() for one in self.checks],
            "increments": self.increments,
            "iterations": self.iterations,
            "seconds": self.seconds,
            **run_record(self.stages),
            "warnings": list(self.warnings),
        }


def checks(stages: Mapping[str, History], length: str = "") -> list[Quantity]:
    """Penetration of each contact and drift of the energies of runs by their names, with their limits.

    Parameters
    ----------
    stages : mapping of str to History
        The runs.
    length : str
        Unit of lengths.
    """
    found = []
    for stage, rows in stage_penetrations(stages).items():
        of = f"{stage}: " if len(stages) > 1 else ""
        deep = [replace(reached.quantity, unit=length) for reached in rows.values()]
        balance = balanced(stages[stage])
        drift = [] if balance is None else [balance.quantity]
        found += [prefixed(one, of) for one in (*deep, *drift)]
    return found

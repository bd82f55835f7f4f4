"""Results of a process: terminal, page, files, sweeps and the bench read nothing else."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Self

from umform.errors import InvalidValue
from umform.io.tables import write_csv
from umform.notebook import Display, InNotebook
from umform.results.balance_summary import balanced
from umform.results.history import History
from umform.results.penetration import stage_penetrations
from umform.results.quantity import GIVEN, Band, Quantity, list_columns, prefixed, table, values
from umform.results.run_record import run_record
from umform.results.studies import StudiedMesh, estimated

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: Heading of the table of all quantities.
MEASURES = "Measures"
#: Names in the line of a study, beside the first.
_NAMED = 4
#: Standard deviations of the scatter in half of a band: 95 % of a normal distribution.
SIGMAS = 2.0
_SCATTER = "two standard deviations by the scatter of parameters"
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


def display_of(title: str, annexes: Sequence[Annex], before: Display | None = None) -> Display:
    """What a notebook shows of studies, behind what is shown before them."""
    first = before or Display(title)
    return Display(
        title,
        {**first.tables, **{one.title: one.table for one in annexes}},
        [*first.warnings, *(text for one in annexes for text in one.warnings)],
        [*first.notes, *(text for one in annexes for text in one.notes)],
    )


class Study(InNotebook):
    """Base of the results of studies: a notebook shows their tables; their line has the names of what was found."""

    @property
    def annex(self) -> Annex:
        """The first of what is shown; a study has this or all."""
        return self.annexes[0]

    @property
    def annexes(self) -> Sequence[Annex]:
        """All studies that are shown."""
        return [self.annex]

    def __repr__(self) -> str:
        found = [row[0] for row in self.annexes[0].table[1:]]
        names = [*found[: _NAMED + 1], *(["..."] if len(found) > _NAMED + 1 else [])]
        return f"{type(self).__name__}({', '.join(names)})"

    def _display(self) -> Display:
        return display_of(type(self).__name__, self.annexes)


class Outcome(InNotebook, ABC):
    """Base of the results of processes: quantities, runs, warnings, notes."""

    #: Studies of the results.
    annexes: Sequence[Annex] = ()
    #: Standard deviations of the quantities by the scatter of parameters, by name; NaN: unknown, as the error is then.
    deviations: Mapping[str, float] = MappingProxyType({})

    def with_annex(self, annex: Annex) -> Self:
        """The outcome with one more study."""
        other = copy(self)
        object.__setattr__(other, "annexes", (*self.annexes, annex))  # outcomes are frozen
        return other

    def with_deviations(self, deviations: Mapping[str, float]) -> Self:
        """The outcome with standard deviations of its quantities, which widen their bands."""
        other = copy(self)
        object.__setattr__(other, "deviations", dict(deviations))
        return other

    @property
    def studied(self) -> StudiedMesh | None:
        """Mesh of the run beside those of the studies of errors; None for a process without studies."""
        return None

    def banded(self, found: Sequence[Quantity], at: StudiedMesh | None = None) -> list[Quantity]:
        """Quantities with their bands: their own, else that of the studies; both with the scatter of parameters.

        Parameters
        ----------
        found : sequence of Quantity
            The quantities; one with changes by refinements keeps its band, and an extrapolation its error by the mesh.
        at : StudiedMesh, optional
            Their process and mesh; default: those of the outcome.
        """
        at = at or self.studied
        return [replace(one, band=self._band(one, at)) for one in found]

    def _band(self, one: Quantity, at: StudiedMesh | None) -> Band | None:
        own = one.band
        studied = None if at is None or (own is not None and own.parts) else estimated(one, at)
        if own is None or studied is None:
            own = own or studied
        else:
            own = own.joined(studied) if own.middle is None else own.beside_the_mesh(studied)
        deviation = self.deviations.get(one.name, 0.0)
        if deviation == 0.0:
            return own
        return (own or Band(0.0, "")).widened(SIGMAS * deviation, _SCATTER, "scatter")

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

    def _display(self) -> Display:
        missed = [one for one in self.checks if one.missed]
        tables = {"" if title == MEASURES else title: rows for title, rows in self.short_tables.items()}
        tables |= {"Beyond their limits": table(missed)} if missed else {}
        return display_of(self.title, self.annexes, Display(self.title, tables, self.warnings, self.all_notes))

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
        """Warnings about the numbers."""

    @property
    def length(self) -> str:
        """Unit of lengths."""
        return "mm"

    @property
    def notes(self) -> list[str]:
        """Remarks on the numbers."""
        return []

    @property
    def all_notes(self) -> list[str]:
        """The notes, and where the errors of the quantities come from."""
        bands = (one.band for one in self.quantities)
        sources = [f"error: {band.source}" for band in bands if band is not None and band != GIVEN]
        return [*self.notes, *dict.fromkeys(sources)]

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

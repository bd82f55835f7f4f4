"""The plan of a sweep: its keys, its jobs, refused jobs, and the rows of its table."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product
from pathlib import Path
from typing import Any

from umform.analysis.run.fingerprint import text
from umform.errors import InvalidValue
from umform.problem import DeckError, Problem
from umform.problem.deck_text import toml
from umform.problem.source import within
from umform.studies.sweep.jobs import Job, job, record_of
from umform.studies.sweep.keys import change, find_key, is_text
from umform.studies.sweep.measures import Measure, Record, usual
from umform.studies.sweep.values import MOST_VALUES, Written, read_values

#: Remarks on a job in its row.
_ABOUT = ("outcome", "warnings", "seconds", "reason")


@dataclass(frozen=True)
class Plan:
    """All jobs of a sweep, by index from 0.

    Attributes
    ----------
    varied : list of str
        Names of the varied keys.
    values : list of dict
        Values by these names, for each job.
    jobs : dict of int to Job
        Jobs with a valid deck.
    refused : dict of int to Record
        Records of the others.
    """

    varied: list[str]
    values: list[dict[str, Any]]
    jobs: dict[int, Job]
    refused: dict[int, Record]

    def __len__(self) -> int:
        return len(self.values)

    def known(self, *, retry: bool, force: bool) -> dict[int, Record]:
        """Records of the jobs that need not run: they are done, or would fail again.

        Parameters
        ----------
        retry : bool
            Whether to run jobs again that are not done.
        force : bool
            Whether to run refused jobs again.
        """
        finished = {"done"} | (set() if retry else {"stopped"}) | (set() if retry or force else {"refused"})
        kept = {number: job.record() for number, job in self.jobs.items()}
        return self.refused | {
            number: record for number, record in kept.items() if record is not None and record["outcome"] in finished
        }

    @property
    def folders(self) -> set[str]:
        """Names of the folders of the jobs: they depend on the values and on the whole deck."""
        return {job.folder.name for job in self.jobs.values()}

    def at(self, folder: Path) -> Plan:
        """The plan with its jobs in a folder."""
        return replace(self, jobs={n: replace(one, folder=folder / one.folder.name) for n, one in self.jobs.items()})

    def alike(self, number: int) -> list[int]:
        """Jobs that are equal to one, itself included: a value may be given twice."""
        return self._by_folder[self.jobs[number].folder]

    @cached_property
    def _by_folder(self) -> dict[Path, list[int]]:
        numbers: dict[Path, list[int]] = {}
        for number in self.jobs:
            numbers.setdefault(self.jobs[number].folder, []).append(number)
        return numbers

    @cached_property
    def _cells(self) -> dict[str, list[Any]]:
        """Cells of the varied values; objects with the same words, such as those of two long tables, are counted."""
        return {name: _cells([values.get(name) for values in self.values]) for name in self.varied}

    def row(self, number: int, record: Record, measures: Iterable[Measure]) -> dict[str, Any]:
        """A row of the table, and its measures as ``quantities``; a job that is not done has none.

        Raises
        ------
        InvalidValue
            An unknown measure.
        """
        done = record["outcome"] == "done"
        measured = {measure.name: measure.quantity(record) if done else None for measure in measures}
        found = {name: None if one is None else one.value for name, one in measured.items()}
        folder = self.jobs[number].folder.name if number in self.jobs else ""
        about = {name: record[name] for name in _ABOUT}
        varied = {name: cells[number] for name, cells in self._cells.items()}
        return {**found, **about, "folder": folder, "quantities": measured, **varied}

    def beside(self, measures: Iterable[Measure]) -> list[Measure]:
        """Measures with names that no other column of the table has.

        Raises
        ------
        InvalidValue
            A function has the name of a varied key, or of another measure.
        """
        found: list[Measure] = []
        for measure in measures:
            others = [one.name for one in found if one.function or measure.function]
            found.append(measure.beside([*self.varied, *_ABOUT, "folder", *others]))
        return found

    def table(self, records: Mapping[int, Record], wanted: Sequence[Measure]) -> tuple[list[dict[str, Any]], list[str]]:
        """Rows of all jobs, and the names of the measures."""
        done = [record for record in records.values() if record["outcome"] == "done"]
        measures = list(wanted) or self.beside(usual(done))
        open_ = record_of("open", "")
        rows = [self.row(number, records.get(number, open_), measures) for number in range(len(self))]
        return rows, [measure.name for measure in measures]


def make_plan(
    deck: Problem,
    vary: Mapping[str, Any],
    jobs: Sequence[Mapping[str, Any]] | None,
    changes: Mapping[str, Any],
    folder: Path,
    **options: Any,
) -> Plan:
    """Find the keys and values of a sweep, and read the decks of all its jobs.

    Parameters
    ----------
    deck : Problem
        The deck.
    vary, jobs, changes
        See :func:`umform.sweep`.
    folder : Path
        Where the jobs have their folders.
    **options
        See :func:`umform.studies.sweep.jobs.job`.

    Raises
    ------
    InvalidValue
        Nothing is varied, or a key is unknown, ambiguous, or changed for all jobs, too.
    DeckError
        None of the decks can be read.
    """
    data = deck.with_(changes).source.data
    listed_too = sorted({name for values in jobs or () for name in values} & set(vary))
    if listed_too:
        raise InvalidValue(
            "a key is varied twice",
            where="vary",
            value=", ".join(listed_too),
            cause="it is a key of the list of jobs, too",
            remedy="give it once",
        )
    varied = list(dict.fromkeys([*(name for values in jobs or () for name in values), *vary]))
    keys = {name: find_key(name, data) for name in varied}
    _check_keys(keys)
    _check_changes(changes, keys)
    axes = {name: [_value(keys[name], value, data) for value in _values(name, given)] for name, given in vary.items()}
    listed = [{name: _value(keys[name], value, data) for name, value in values.items()} for values in jobs or [{}]]
    combined = [{**values, **dict(zip(axes, chosen))} for values in listed for chosen in product(*axes.values())]
    _check_number(len(combined))
    made: dict[int, Job] = {}
    refused: dict[int, Record] = {}
    errors = []
    for number, values in enumerate(combined):
        changed = dict(change(keys[name], value, data) for name, value in values.items())
        try:
            made[number] = job(deck, {**changes, **changed}, values, folder, **options)
        except DeckError as error:
            refused[number] = record_of("refused", error)
            errors.append(error)
    if errors and not made:
        raise errors[0]
    return Plan(varied, combined, made, refused)


def _values(name: str, given: Any) -> list[Any]:
    """The values of a key, from text or a sequence."""
    if isinstance(given, str):
        return list(read_values(given, f"--vary {name}"))
    values = list(given) if isinstance(given, Iterable) and not isinstance(given, Mapping) else [given]
    if not values:
        raise InvalidValue("a varied key has no values", where=name, cause="an empty list", remedy="give one at least")
    return values


def _value(key: str, value: Any, data: Mapping[str, Any]) -> Any:
    if isinstance(value, Written):
        return value.value(as_text=is_text(key, data))
    return value.item() if hasattr(value, "item") else value


def _cells(values: Sequence[Any]) -> list[Any]:
    """Values as cells of a table: lists and tables as in a deck, objects by their words."""
    cells = [_cell(value) for value in values]
    alike: dict[Any, dict[str, int]] = {}
    for cell, value in zip(cells, values, strict=True):
        numbers = alike.setdefault(cell, {})
        numbers.setdefault(text(value) if _is_object(value) else "", len(numbers) + 1)
    return [
        f"{cell}, {alike[cell][text(value)]}" if _is_object(value) and len(alike[cell]) > 1 else cell
        for cell, value in zip(cells, values, strict=True)
    ]


def _cell(value: Any) -> Any:
    if isinstance(value, Mapping | list | tuple):
        return toml(value)
    return str(value) if _is_object(value) else value


def _is_object(value: Any) -> bool:
    """Whether a value is one that a program has made, such as a law."""
    return not (value is None or isinstance(value, str | int | float | Mapping | list | tuple))


def _check_keys(keys: Mapping[str, str]) -> None:
    """Reject a sweep that varies nothing, or a key twice."""
    twice = {key: [name for name, other in keys.items() if other == key] for key in keys.values()}
    for key, names in twice.items():
        if len(names) > 1:
            raise InvalidValue("a key is varied twice", where=key, value=", ".join(names), remedy="give it once")
    if not keys:
        raise InvalidValue(
            "a sweep varies nothing",
            where="vary",
            cause="neither a key with values nor a list of jobs",
            remedy="--vary thickness=0.8:1.2:0.1",
        )


def _check_changes(changes: Mapping[str, Any], keys: Mapping[str, str]) -> None:
    """Reject another value for all jobs of a key that each job has its own value of."""
    for name, key in keys.items():
        if lost := [one for one in changes if within(one, [key])]:
            raise InvalidValue(
                "a key has a value for all jobs, and is varied",
                where=lost[0],
                value=changes[lost[0]],
                cause=f"it is set, and varied as {name}",
                remedy="leave one of them out: --set or --vary",
            )


def _check_number(number: int) -> None:
    if number > MOST_VALUES:
        raise InvalidValue(
            f"a sweep has at most {MOST_VALUES} jobs",
            where="vary",
            value=number,
            cause="all combinations of many values",
            remedy="fewer values, or a list of jobs",
        )

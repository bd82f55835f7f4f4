"""Measures of a job: its quantities, numbers of its history, springback, and user-defined functions."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.analysis.run import Result
from umform.errors import InvalidValue
from umform.problem.errors import slip
from umform.report.symmetry import mirrors, with_images
from umform.results.forming import lay_by_best_fit
from umform.results.quantity import Quantity

#: A user-defined function: a number or a quantity from a result. Other processes must be able to import it.
Function = Callable[[Result], float | Quantity]
#: Record of a job, as JSON.
Record = Mapping[str, Any]

SPRINGBACK = "springback"
#: What a job reports besides its history.
_KINDS = ("quantities", "checks")
#: Significant digits of a number of the history.
_DIGITS = 6
#: Columns of the history whose last values do not characterise a part.
_COUNTS = ("step", "time", "iterations")
_STATS: dict[str, Callable[[NDArray[np.float64]], float]] = {
    "last": lambda column: float(column[-1]),
    "min": lambda column: float(column.min()),
    "max": lambda column: float(column.max()),
    "peak": lambda column: float(column[np.abs(column).argmax()]),
    "sum": lambda column: float(column.sum()),
}


@dataclass(frozen=True)
class Measure:
    """A column of the table of a sweep.

    Attributes
    ----------
    name : str
        Its name in the table.
    column, stat : str
        Column of the history and its statistic; empty for springback and for functions. Without a statistic in its
        name it may also be a quantity of the job.
    missing : bool
        Whether a job may be without it.
    function : bool
        Whether it is a function of the user.
    """

    name: str
    column: str = ""
    stat: str = ""
    missing: bool = False
    function: bool = False

    @classmethod
    def of(cls, wanted: str | Function) -> Measure:
        """The measure for ``punch_force:max``, ``punch_force``, a quantity or ``springback``, or a function.

        Raises
        ------
        InvalidValue
            An unknown word after the colon.
        """
        if not isinstance(wanted, str):
            return cls(wanted.__name__, function=True)
        column, colon, stat = wanted.partition(":")
        if wanted == SPRINGBACK:
            return cls(wanted)
        if colon and stat not in _STATS:
            raise InvalidValue(
                "this measure is unknown",
                where="measure",
                value=wanted,
                cause=slip(stat, _STATS, "an unknown word behind the colon"),
                remedy=f"write COLUMN or COLUMN:{', COLUMN:'.join(_STATS)}; peak is that of the largest magnitude",
            )
        return cls(column if stat == "last" else wanted, column, stat or "last")

    def beside(self, names: Collection[str]) -> Measure:
        """The measure with its statistic in its name, if that without it is one of other columns of the table.

        Raises
        ------
        InvalidValue
            It is no column of the history.
        """
        if self.name not in names:
            return self
        if not self.column:
            raise InvalidValue(
                "a measure has the name of another column of the table",
                where="measures",
                value=self.name,
                cause="a key that is varied, a remark on the job, or two functions with one name, as lambdas",
                remedy="another name for the function, or the whole path of the key",
            )
        return replace(self, name=f"{self.column}:{self.stat}")

    def quantity(self, record: Record) -> Quantity:
        """The number of a finished job.

        Raises
        ------
        InvalidValue
            The job has no such column or quantity, or no springback.
        """
        known = {one["name"]: one for kind in _KINDS for one in record.get(kind, ())}
        found = record["functions"][self.name] if self.function else known.get(self.name)
        if isinstance(found, Mapping):
            return replace(Quantity.of(found), name=self.name)
        return Quantity(self.name, value=self._number(record, known), digits=_DIGITS)

    def _number(self, record: Record, known: Mapping[str, Any]) -> float | None:
        number: float | None
        if self.function:
            number = record["functions"][self.name]
            return number
        if self.column:
            history = record["history"]
            if self.column in history:
                number = history[self.column][self.stat]
                return number
            if self.missing:
                return None
            raise InvalidValue(
                "the history has no such column, and the job no such quantity",
                where="measure",
                value=self.column,
                cause=slip(self.column, [*history, *known]),
                remedy=f"one of {', '.join([*history, *known])}; finished jobs are kept: run the sweep again",
            )
        number = record[SPRINGBACK]
        if number is None and not self.missing:
            raise no_springback()
        return number


def no_springback() -> InvalidValue:
    """The error of a springback without unloading."""
    return InvalidValue(
        "a sweep without unloading has no springback",
        where="measure",
        value=SPRINGBACK,
        cause="no step of the kind release or free at the end, after another step",
        remedy="such a step at the end of the deck, or leave the measure out",
    )


def usual(records: Sequence[Record]) -> list[Measure]:
    """Default measures: peaks of the forces of controls, springback, quantities, last values of the history, checks.

    A job without one of them has no value there.
    """
    if not records:
        return []
    controls = dict.fromkeys(name for record in records for name in record["controls"])
    columns = list(dict.fromkeys(name for record in records for name in record["history"]))
    quantities, checks = (
        dict.fromkeys(one["name"] for record in records for one in record.get(kind, ())) for kind in _KINDS
    )
    measures = [Measure.of(f"{name}_force:peak") for name in controls]
    if any(record[SPRINGBACK] is not None for record in records):
        measures.append(Measure(SPRINGBACK))
    columns = [name for name in columns if name not in _COUNTS]
    more = [Measure.of(name) for name in (*quantities, *columns, "iterations:sum", *checks)]
    return [replace(measure, missing=True) for measure in (*measures, *more)]


def unit_of(rows: Sequence[Mapping[str, Any]], measure: str) -> str:
    """Unit of a measure; empty if no job has it, or if it is unknown."""
    found = (row["quantities"][measure].unit for row in rows if row.get("quantities", {}).get(measure) is not None)
    return next(found, "")


def heading(rows: Sequence[Mapping[str, Any]], name: str) -> str:
    """A name and its unit, above a column or beside an axis."""
    unit = unit_of(rows, name)
    return f"{name}, {unit}" if unit else name


def stats(result: Result) -> dict[str, dict[str, float | None]]:
    """Last value, extremes and sum of each column of the history; None where it is not finite."""
    return {
        name: {stat: _finite(function(column)) for stat, function in _STATS.items()}
        for name, column in result.table().items()
    }


def column_number(result: Result, wanted: str) -> float | None:
    """A number of the history, as ``punch_force:max``; None where it is not finite."""
    one = Measure.of(wanted)
    return _finite(_STATS[one.stat](result[one.column]))


def springback(result: Result, loading: int) -> float | None:
    """Largest displacement of a node by unloading, after the best fit of the part into its loaded shape. eq. (5.67)

    Parameters
    ----------
    result : Result
        A run with a frame at the end of each step.
    loading : int
        Number of steps before those that unload the part at the end.

    Returns
    -------
    float or None
        In units of length. For a modelled half or quarter, the whole part is fitted. None without a loading step
        before.
    """
    steps = [int(result.rows[frame.number]["step"]) for frame in result.frames]
    before = [number for number, step in enumerate(steps) if 0 < step <= loading]
    if not before:
        return None
    X = result.model.mesh.points
    loaded = X + result.frames[before[-1]].points["displacement"]
    left = X + result.model.u.reshape(-1, 3)
    planes = mirrors(result.model)
    return lay_by_best_fit(with_images(left, planes), with_images(loaded, planes)).largest


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def answer_of(function: Function, result: Result) -> float | Quantity:
    """What a user-defined function makes of a result.

    Raises
    ------
    InvalidValue
        Neither a number nor a quantity. An error of the function has its name in its notes.
    """
    name = getattr(function, "__name__", "number")
    try:
        found = function(result)
    except Exception as error:
        error.add_note(f"in the function {name}, called with the result of a run")
        raise
    if isinstance(found, Quantity):
        return found
    try:
        return float(found)
    except (TypeError, ValueError):
        raise InvalidValue(
            "a function of a result returns a number or a Quantity",
            where=name,
            value=type(found).__name__,
            cause="a return that is missing, or a column in place of one of its numbers",
            remedy='return result["punch_force"].max(), for instance',
        ) from None


def number_of(function: Function, result: Result) -> float | dict[str, Any] | None:
    """Value of a user-defined function for a result: a number, or a quantity as JSON data."""
    found = answer_of(function, result)
    return found.record() if isinstance(found, Quantity) else _finite(found)

"""Measurements: curves along a run, and single numbers, with their standard deviations."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from os import PathLike
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.errors import InvalidValue
from umform.problem.errors import slip
from umform.processes.rules import number as is_number
from umform.results.quantity import Quantity
from umform.spec.types import FARTHEST
from umform.studies.calibration.columns import number, read_rows
from umform.studies.derivatives import Derivatives
from umform.studies.identification.branches import NOISE, at_abscissae, branches

Floats = NDArray[np.float64]
#: Deviation, relative to the largest measured number, where none is given.
RELATIVE = 0.01
#: Column of a file with the standard deviation of each row.
_DEVIATION = "deviation"


class Measured(Protocol):
    """A measurement."""

    @property
    def at(self) -> Mapping[str, Any]:
        """Values of the problem with which it was measured, where they differ."""

    @property
    def name(self) -> str:
        """Its name."""

    @property
    def known(self) -> bool:
        """Whether its standard deviation is given."""

    @property
    def of(self) -> list[str | Callable[..., float | Quantity]]:
        """Results that a run needs for it besides its history."""

    @property
    def numbers(self) -> tuple[Floats, Floats]:
        """The measured numbers and their standard deviations."""

    def found(self, run: Derivatives) -> tuple[Floats, Floats]:
        """The same of a run, shape (m,), and the derivatives, shape (m, n)."""


@dataclass(frozen=True)
class MeasuredNumber:
    """One measured number of a run.

    Attributes
    ----------
    quantity : str or callable
        A quantity such as ``"angle"``, a column of the history such as ``"punch_force:max"``, or a function of a
        result.
    value : float
        The measured number.
    deviation : float, optional
        Its standard deviation.
    at : mapping of str to object
        Values of the problem with which it was measured, where they differ: ``{"stroke": 5.2}``.

    Examples
    --------
    >>> import umform as uf
    >>> angle = uf.MeasuredNumber("angle", 91.3, 0.2)
    >>> angle.name
    'angle'
    """

    quantity: str | Callable[..., float | Quantity]
    value: float
    deviation: float | None = None
    at: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        given = [self.value] if self.deviation is None else [self.value, self.deviation]
        if others := [one for one in given if not is_number(one)]:
            raise _unfit(self.name, others[0])
        _check(self.name, *self.numbers)

    @property
    def name(self) -> str:
        """Its name."""
        return self.quantity if isinstance(self.quantity, str) else getattr(self.quantity, "__name__", "number")

    @property
    def known(self) -> bool:
        """Whether its standard deviation is given."""
        return self.deviation is not None

    @property
    def of(self) -> list[str | Callable[..., float | Quantity]]:
        """The quantity."""
        return [self.quantity]

    @property
    def numbers(self) -> tuple[Floats, Floats]:
        """The number and its standard deviation, each as an array."""
        deviation = RELATIVE * abs(self.value) if self.deviation is None else self.deviation
        return np.array([self.value], dtype=float), np.array([deviation], dtype=float)

    def found(self, run: Derivatives) -> tuple[Floats, Floats]:
        """The number of a run and its derivatives."""
        row = [one.name for one in run.responses].index(self.name)
        value = run.responses[row].value
        if value is None:
            raise InvalidValue(
                "the run has no number for this quantity",
                where=self.name,
                cause="it is not defined at its end",
                remedy="another quantity, or other first values",
            )
        return np.array([value]), run.values[[row]]


@dataclass(frozen=True)
class MeasuredCurve:
    """A measured curve: a column of the history over another one.

    Attributes
    ----------
    x, y : str
        Columns of the history, such as ``"stroke"`` and ``"punch_force"``.
    points : tuple of array_like, shape (m,)
        Abscissae, in the order of time, and ordinates.
    deviation : float or array_like, optional
        Standard deviation of the ordinates.
    step : int, optional
        Step of the run in which it was measured, from 1; default: its first branch is that of the run.
    at : mapping of str to object
        Values of the problem with which it was measured, where they differ.

    Examples
    --------
    >>> import umform as uf
    >>> curve = uf.MeasuredCurve("stroke", "punch_force", ([1.0, 2.0, 3.0], [210.0, 340.0, 410.0]), deviation=5.0)
    >>> curve.name
    'punch_force'
    """

    x: str
    y: str
    points: tuple[ArrayLike, ArrayLike]
    deviation: ArrayLike | None = None
    step: int | None = None
    at: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        given = self.points if isinstance(self.points, list | tuple | np.ndarray) else None
        if given is None or len(given) != 2:
            raise InvalidValue(
                "the points of a curve are its abscissae and its ordinates",
                where=self.name,
                value=type(self.points).__name__ if given is None else f"{len(given)} rows",
                cause="a file, or a row for each point",
                remedy="MeasuredCurve.read for a file; np.transpose of rows",
            )
        try:
            x, y = (np.asarray(one, dtype=float) for one in self.points)
        except (TypeError, ValueError) as error:
            raise _unfit(self.name, str(error)) from None
        if x.ndim != 1 or x.shape != y.shape or len(x) < 2:
            raise InvalidValue(
                "a curve is two or more pairs of numbers",
                where=self.name,
                value=f"{x.shape} abscissae, {y.shape} ordinates",
                remedy="one ordinate for each abscissa",
            )
        _check(self.name, x, np.ones_like(x))
        try:
            deviations = self.numbers[1]
        except (TypeError, ValueError):
            raise InvalidValue(
                "the standard deviation of a curve is one number, or one for each ordinate",
                where=self.name,
                value=self.deviation,
                cause=f"there are {len(y)} ordinates",
                remedy="such as 5.0",
            ) from None
        _check(self.name, y, deviations)

    @classmethod
    def read(
        cls,
        path: str | PathLike[str],
        x: str,
        y: str,
        deviation: float | None = None,
        step: int | None = None,
        at: Mapping[str, Any] | None = None,
    ) -> MeasuredCurve:
        """Read a CSV file whose columns have the names of those of the history.

        Parameters
        ----------
        path : str or PathLike
            The file; a column ``deviation`` has the standard deviation of each row.
        x, y, deviation, step, at
            See above.
        """
        rows = read_rows(path, (x.casefold(), y.casefold()), f"{x},{y} / 1.5,320")
        table = {name: [number(path, row, name.casefold()) for row in rows] for name in (x, y)}
        spread: Any = deviation
        if spread is None and rows and _DEVIATION in rows[0][1]:
            spread = [number(path, row, _DEVIATION) for row in rows]
        try:
            return cls(x, y, (table[x], table[y]), spread, step, at or {})  # type: ignore[arg-type]
        except InvalidValue as error:
            error.where = str(path)
            raise

    @property
    def name(self) -> str:
        """Name of its ordinate."""
        return self.y

    @property
    def known(self) -> bool:
        """Whether its standard deviation is given."""
        return self.deviation is not None

    @property
    def of(self) -> list[str | Callable[..., float | Quantity]]:
        """Nothing: the history has its columns."""
        return []

    @property
    def numbers(self) -> tuple[Floats, Floats]:
        """Ordinates and their standard deviations."""
        y = np.asarray(self.points[1], dtype=float)
        deviation = RELATIVE * float(np.abs(y).max()) if self.deviation is None else self.deviation
        return y, np.broadcast_to(np.asarray(deviation, dtype=float), y.shape)

    @property
    def abscissae(self) -> Floats:
        """Abscissae."""
        return np.asarray(self.points[0], dtype=float)

    def columns(self, run: Derivatives) -> tuple[Floats, Floats]:
        """Both columns of a run, of its step.

        Raises
        ------
        InvalidValue
            There is no such column or step.
        """
        base = run.runs.reference
        for name in (self.x, self.y):
            if name not in base.columns():
                raise InvalidValue(
                    "the history has no such column",
                    where=f"curve {self.x},{self.y}",
                    value=name,
                    cause=slip(name, base.columns()),
                    remedy=f"one of {', '.join(base.columns())}",
                )
        rows = self._rows(base["step"])
        return base[self.x][rows], base[self.y][rows]

    def found(self, run: Derivatives) -> tuple[Floats, Floats]:
        """Ordinates of a run at the abscissae and their derivatives.

        Raises
        ------
        InvalidValue
            The curve goes beyond the run, or turns more often.
        """
        X, Y = self.columns(run)
        rows = self._rows(run.runs.reference["step"])
        paths = [one.path for one in run.parameters]
        dX, dY = (np.column_stack([run.column(name, path)[rows] for path in paths]) for name in (self.x, self.y))
        x = self.abscissae
        turns, of_run = len(branches(x)) - 1, len(branches(X)) - 1
        if turns > of_run:
            raise InvalidValue(
                "the curve turns more often than the run",
                where=f"curve {self.x},{self.y}",
                value=f"{turns} turns of {self.x}, in the run {of_run}",
                cause="a step that is missing in the run, rows that are not in the order of time, or noise",
                remedy="rows in the order of time, of the part that is simulated",
            )
        ends, of_run_ends = ([values[row] for row in branches(values)[0]] for values in (x, X))
        if np.diff(ends) * np.diff(of_run_ends) < 0.0:
            raise InvalidValue(
                "the curve begins the other way than the run",
                where=f"curve {self.x},{self.y}",
                value=f"{self.x} {ends[0]:.6g} to {ends[1]:.6g}; in the run {of_run_ends[0]:.6g} to "
                f"{of_run_ends[1]:.6g}",
                cause="rows that are not in the order of time, a curve of a later step, or another sign",
                remedy=f"rows in the order of time; {self.x},{self.y}@2 for a curve of the second step",
            )
        found = list(at_abscissae(x, (X, Y), (dX, dY)))
        worst = max(range(len(x)), key=lambda row: found[row][2])
        if found[worst][2] > NOISE * float(np.ptp(X)):
            begin, end = found[worst][3]
            raise InvalidValue(
                "the curve goes beyond the run",
                where=f"curve {self.x},{self.y}",
                value=f"{self.x} {x[worst]:.6g}; the run goes there from {begin:.6g} to {end:.6g}",
                cause="another unit or sign, or a run that ends earlier",
                remedy="a longer run, or fewer rows",
            )
        return np.array([one[0] for one in found]), np.array([one[1] for one in found])

    def _rows(self, steps: Floats) -> slice:
        if self.step is None:
            return slice(None)
        inside = np.flatnonzero(steps == self.step)
        if not inside.size:
            raise InvalidValue(
                "the run has no such step",
                where=f"curve {self.x},{self.y}",
                value=self.step,
                remedy=f"1 to {int(steps.max())}",
            )
        return slice(max(int(inside[0]) - 1, 0), int(inside[-1]) + 1)


def _check(name: str, values: Floats, deviations: Floats) -> None:
    numbers = abs(values) <= FARTHEST
    least = np.maximum(1.0, abs(values)) / FARTHEST  # squares over variances stay finite
    wide = (deviations >= least) & (deviations <= FARTHEST)
    if not (numbers.all() and wide.all()):
        raise _unfit(name, values[~numbers][0] if not numbers.all() else deviations[~wide][0])


def _unfit(name: str, value: object) -> InvalidValue:
    return InvalidValue(
        "a measurement is a number with a positive standard deviation",
        where=name,
        value=value,
        cause=f"an empty cell, a number beyond {FARTHEST:g} or of as many standard deviations, or one that is zero and "
        "has no standard deviation",
        remedy="such as 91.3+-.2; in Python 91.3, 0.2",
    )


def numbers_of(data: Iterable[Measured]) -> tuple[Floats, Floats]:
    """All measured numbers and their standard deviations."""
    pairs = [one.numbers for one in data]
    return np.concatenate([one for one, _ in pairs]), np.concatenate([one for _, one in pairs])

"""Slopes that have been found, with their bands and the runs that they are from; as table, files and picture."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue, UmformError
from umform.io.tables import write_csv
from umform.problem.errors import slip
from umform.results.outcome import Outcome
from umform.results.quantity import Quantity
from umform.spec import Scalar
from umform.studies.derivatives.derivative import Derivative
from umform.studies.derivatives.rates import Rates

Floats = NDArray[np.float64]
#: Files: all slopes, the runs, the picture of one response.
TABLE, RUNS, PICTURE = "slopes.csv", "slopes-runs.csv", "slopes.png"
#: Distances from the mean, over the values, that are round-off.
_SAME = 1e-13
#: Probability of the band.
_WITHIN = 0.95


@dataclass(frozen=True)
class Found:
    """Quantities of a run, and the names of those that the process is for."""

    quantities: tuple[Quantity, ...]
    main: tuple[str, ...] = ()

    @classmethod
    def of(cls, outcome: Outcome, wanted: Sequence[Any] | None = None) -> Found:
        """Those of the outcome of a process, all or the wanted ones.

        Raises
        ------
        InvalidValue
            It has no quantity of a wanted name.
        """
        known = {one.name: one for one in outcome.quantities if one.value is not None}
        refuse_unknown(wanted or (), known)
        return cls(tuple(known[one] for one in wanted or known), tuple(outcome.main))


def refuse_unknown(wanted: Sequence[Any], known: Collection[str]) -> None:
    """Refuse what is none of the names of quantities of a process.

    Raises
    ------
    InvalidValue
    """
    for one in wanted:
        if one not in known:
            raise InvalidValue(
                "the process has no such quantity",
                where="of",
                value=one,
                cause=slip(str(one), known, "another process, or a column of the history"),
                remedy=f"one of {', '.join(known)}",
            )


@dataclass(frozen=True)
class Run:
    """A run with another value of one parameter.

    Attributes
    ----------
    path : str
        Path of the parameter.
    value : float
        Its value.
    found : Found or UmformError
        What was found, or why there is nothing.
    """

    path: str
    value: float
    found: Found | UmformError

    def number(self, name: str) -> float | None:
        """A number of the run; None if it has none of this name."""
        known = () if isinstance(self.found, UmformError) else self.found.quantities
        return next((one.value for one in known if one.name == name), None)


@dataclass(frozen=True, repr=False)
class Slopes(Rates):
    """Slopes of all responses over a range of each parameter.

    Attributes
    ----------
    parameters : tuple of Scalar
        The parameters.
    responses : tuple of Quantity
        The responses with their values.
    runs : tuple of Run
        All runs beside that of the case.
    width : float
        Half of the range, over the value of the parameter.
    main : tuple of str
        Names of the responses that the process is for.

    Examples
    --------
    >>> import umform as uf
    >>> def build(E):
    ...     model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=E, nu=0.3))
    ...     model.fix("x0")
    ...     return model, uf.Move(model.prescribe("x1_lower", "z", name="tip"), to=-0.1, steps=2)
    >>> found = uf.slopes(build, {"E": 210e3}, ["tip_force:last"], each_side=1)
    >>> round(found["tip_force:last", "E"].relative, 6)
    1.0
    """

    parameters: tuple[Scalar, ...]
    responses: tuple[Quantity, ...]
    runs: tuple[Run, ...]
    width: float
    main: tuple[str, ...] = ()

    def __getitem__(self, key: tuple[str, str]) -> Derivative:
        """The slope of a response over a parameter, each by its name, with the half of its band of 95 %."""
        response, path = key
        row = self._index([one.name for one in self.responses], response, "response")
        column = self._index([one.path for one in self.parameters], path, "parameter")
        x, y = self.points(response, path).T
        slope, band = _line(x, y) if len(x) > 2 else (None, None)
        why = "" if len(x) > 2 else "fewer than three runs have this number"
        return Derivative(self.responses[row], self.parameters[column], slope, why=why, band=band)

    def points(self, response: str, path: str) -> Floats:
        """Values of a parameter and of a response in all runs that have it, that of the case first; shape (n, 2)."""
        first = next(one for one in self.parameters if one.path == path).value
        base = next(one for one in self.responses if one.name == response).value
        others = [(run.value, run.number(response)) for run in self.runs if run.path == path]
        return np.array([(x, y) for x, y in [(first, base), *others] if y is not None], dtype=float)

    @cached_property
    def failed(self) -> list[Run]:
        """Runs that have failed."""
        return [run for run in self.runs if isinstance(run.found, UmformError)]

    @property
    def notes(self) -> list[str]:
        """What the slopes are from."""
        each = len(self.runs) // len(self.parameters)
        count = f"{'up to ' if self.failed else ''}{each + 1}"
        return [
            f"slopes of lines through {count} whole runs, within {100.0 * self.width:g} % of each parameter; ±: "
            f"{100.0 * _WITHIN:g} % by the distances of the runs from the line"
        ]

    @property
    def warnings(self) -> list[str]:
        """Runs that have failed."""
        return [
            f"the run with {run.path} = {run.value:.6g} has failed: {str(run.found).splitlines()[0]}"
            for run in self.failed
        ]

    def write(self, folder: str | Path) -> list[Path]:
        """Write the slopes, and the numbers of all runs, in files of a folder, with a picture; returns the files."""
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        write_csv(folder / TABLE, self._columns() | {"band": [one.band for one in self]})
        done = [run for run in self.runs if run not in self.failed]
        paths: list[Any] = [run.path for run in done]
        numbers = {one.name: [run.number(one.name) for run in done] for one in self.responses}
        write_csv(folder / RUNS, {"parameter": paths, "parameter_value": [run.value for run in done], **numbers})
        self.plot(self._main, folder / PICTURE)
        return [folder / TABLE, folder / RUNS, folder / PICTURE]


def _line(x: Floats, y: Floats) -> tuple[float, float]:
    """Slope of the line of least squares, and half of its band."""
    from scipy.special import stdtrit  # slow to import

    away = x - x.mean()
    square = float(away @ away)
    beside = y - y.mean()
    if np.abs(beside).max() <= _SAME * np.abs(y).max():
        return 0.0, 0.0
    slope = float(away @ beside) / square
    rest = beside - slope * away
    free = len(x) - 2
    return slope, float(stdtrit(free, 0.5 + 0.5 * _WITHIN)) * math.sqrt(float(rest @ rest) / free / square)

"""Runs of the search: weighted differences from the measurements, and their derivatives."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import groupby
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue, UmformError
from umform.progress import Show
from umform.spec import Scalar
from umform.studies.derivatives import Derivatives, derivatives
from umform.studies.derivatives.derive import paths_of
from umform.studies.derivatives.subjects import Subject
from umform.studies.identification.data import Measured, numbers_of

Floats = NDArray[np.float64]


@dataclass
class Runs:
    """The runs of a search: one for each set of values, and for each setting of the measurements.

    Attributes
    ----------
    thing : Subject
        What is run.
    paths : sequence of str
        What is looked for.
    data : sequence of Measured
        Measurements.
    known : mapping of str to Scalar
        Numbers of the problem by their paths.
    count : int
        Runs so far.
    refused : int
        Sets of values that were refused, or whose run did not converge.
    refusal : UmformError or None
        Why the last set was; None if it was not.
    progress, on_run
        See :func:`umform.identify`.
    """

    thing: Subject
    paths: Sequence[str]
    data: Sequence[Measured]
    known: Mapping[str, Scalar]
    progress: Show = None
    on_run: Callable[[int, float], object] = lambda count, misfit: None
    count: int = 0
    refused: int = 0
    refusal: UmformError | None = None
    _last: dict[bytes, tuple[Floats, Floats, list[Derivatives]]] = field(default_factory=dict)

    def at(self, values: Floats) -> tuple[Floats, Floats, list[Derivatives]]:
        """Numbers of the run, derivatives shape (m, n), and the runs, one for each measurement.

        Values have 12 digits, with which a deck gives elastic constants as E and nu.

        Raises
        ------
        UmformError
            A value is refused, a run does not converge, or a derivative is unknown.
        """
        key = values.tobytes()
        if key not in self._last:
            found = self._run({path: float(f"{value:.12g}") for path, value in zip(self.paths, values, strict=True)})
            self.refusal = None
            self._last = dict([*list(self._last.items())[-1:], (key, found)])
            self.on_run(self.count, float(np.sqrt(np.mean(self._over(found[0]) ** 2))))
        return self._last[key]

    def residuals(self, values: Floats) -> Floats:
        """Differences over their standard deviations; infinite where there is no run."""
        try:
            return self._over(self.at(values)[0])
        except UmformError as error:
            self.refused += 1
            self.refusal = error
            return np.full(len(self.numbers[0]), math.inf)

    def jacobian(self, values: Floats) -> Floats:
        """Derivatives of the residuals."""
        found: Floats = self.at(values)[1] / self.numbers[1][:, None]
        return found

    @property
    def numbers(self) -> tuple[Floats, Floats]:
        """All measured numbers and their standard deviations."""
        return numbers_of(self.data)

    def _over(self, found: Floats) -> Floats:
        measured, deviations = self.numbers
        return (found - measured) / deviations

    def _run(self, values: Mapping[str, float]) -> tuple[Floats, Floats, list[Derivatives]]:
        numbers, slopes, runs = [], [], []
        for setting, group in groupby(self.data, lambda one: self._setting(one.at)):
            some = list(group)
            run = self._derivatives({**setting, **values}, [name for one in some for name in one.of])
            for one in some:
                value, slope = one.found(run)
                numbers.append(value)
                slopes.append(slope)
                runs.append(run)
        slope = np.concatenate(slopes)
        self._check(slope, runs)
        return np.concatenate(numbers), slope, runs

    def _setting(self, at: Mapping[str, Any]) -> dict[str, Any]:
        """Values with which something was measured, by their full paths."""
        setting = {self._path(name): value for name, value in at.items()}
        both = [path for path in self.paths if path in setting]
        if both:
            raise InvalidValue(
                "a number is sought, and given with a measurement",
                where="at",
                value=", ".join(both),
                remedy="look for others",
            )
        return setting

    def _path(self, name: str) -> str:
        found = paths_of(name, self.known) or [name]
        if len(found) > 1:
            raise InvalidValue(
                "a path is ambiguous",
                where="at",
                value=name,
                cause=", ".join(found),
                remedy=f"write more of it, as {found[0]}",
            )
        return found[0]

    def _derivatives(self, values: Mapping[str, Any], of: list[Any]) -> Derivatives:
        self.count += 1
        try:
            return derivatives(self.thing.with_(values), list(self.paths), of, progress=self.progress)
        except InvalidValue as error:
            error.where = "quantity" if error.where == "of" else error.where
            raise

    def _check(self, slopes: Floats, runs: Sequence[Derivatives]) -> None:
        """Refuse unknown derivatives."""
        lost = ~np.isfinite(slopes).all(axis=0)
        if lost.any():
            path = self.paths[int(np.argmax(lost))]
            raise InvalidValue(
                "a derivative is unknown",
                where=path,
                cause=next(
                    (run.runs.kept[path].lost for run in runs if run.runs.kept[path].lost), "a number undefined"
                ),
                remedy="smaller increments, or other first values",
            )

"""Derivatives that have been found: of quantities, of columns, of the displacement; as table and files."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from umform.analysis.run import Result
from umform.analysis.shadows import Shadowed, of_all
from umform.errors import InvalidValue
from umform.io.tables import write_csv
from umform.results.quantity import Quantity
from umform.spec import Scalar
from umform.studies.derivatives.derivative import Derivative
from umform.studies.derivatives.rates import Rates
from umform.studies.derivatives.responses import Response

Floats = NDArray[np.float64]
#: Files: all derivatives, those of the columns of the history, the picture of one response.
TABLE, HISTORY, PICTURE = "derivatives.csv", "derivatives-history.csv", "derivatives.png"


@dataclass(frozen=True, repr=False)
class Derivatives(Rates):
    """All derivatives of a run.

    Attributes
    ----------
    parameters : tuple of Scalar
        The parameters.
    responses : tuple of Quantity
        The responses with their values.
    values : ndarray, shape (responses, parameters)
        The derivatives; NaN: unknown.
    stages : mapping of str to Shadowed
        The run of each operation, with its reference and its shadows.
    sizes : mapping of str to float
        Change of each parameter in its shadow, by its path.
    held : mapping of str to str
        Responses that stay constant, and the parameters that follow.
    measured : tuple of Response
        How each response is taken from a run.
    main : tuple of str
        Names of the responses that the process is for.

    Examples
    --------
    >>> import umform as uf
    >>> def build(E, way):
    ...     model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=E, nu=0.3))
    ...     model.fix("x0")
    ...     return model, uf.Move(model.prescribe("x1_lower", "z", name="tip"), to=-way, steps=2)
    >>> found = uf.derivatives(build, by={"E": 210e3, "way": 0.1}, of=["tip_force"])
    >>> [one.parameter.path for one in found]
    ['E', 'way']
    >>> round(found.holding({"tip_force": "way"})["way", "E"].relative, 2)
    -1.0
    """

    parameters: tuple[Scalar, ...]
    responses: tuple[Quantity, ...]
    values: Floats
    stages: Mapping[str, Shadowed]
    sizes: Mapping[str, float]
    held: Mapping[str, str]
    measured: tuple[Response, ...]
    main: tuple[str, ...] = ()

    @classmethod
    def of(
        cls,
        parameters: Sequence[Scalar],
        sizes: Mapping[str, float],
        wanted: Sequence[Response],
        base: Sequence[float | None],
        rows: Mapping[str, Sequence[float | None]],
        stages: Mapping[str, Shadowed],
        main: Sequence[str] = (),
    ) -> Derivatives:
        """Differences of the shadows from the reference, over the changes of the parameters. eq. (5.161)"""
        values = np.full((len(wanted), len(parameters)), np.nan)
        for column, one in enumerate(parameters):
            for row, (before, after) in enumerate(zip(base, rows.get(one.path, ()), strict=False)):
                if before is not None and after is not None:
                    values[row, column] = (after - before) / sizes[one.path]
        quantities = tuple(one.quantity for one in wanted)
        return cls(tuple(parameters), quantities, values, stages, dict(sizes), {}, tuple(wanted), tuple(main))

    @cached_property
    def runs(self) -> Shadowed:
        """The run of the last operation, with what the shadows have kept in all of them."""
        return of_all(self.stages)

    @property
    def run(self) -> Result:
        """The run, that of the last operation."""
        return self.runs.run

    def __getitem__(self, key: tuple[str, str]) -> Derivative:
        """The derivative of a response with respect to a parameter, each by its name."""
        if not isinstance(key, tuple) or len(key) != 2:
            raise InvalidValue(
                "a derivative is that of a response by a parameter",
                where="derivatives",
                value=key,
                remedy='found["angle", "thickness"]',
            )
        response, path = key
        row = self._index([one.name for one in self.responses], response, "response")
        column = self._index([one.path for one in self.parameters], path, "parameter")
        kept, value = self.runs.kept[path], float(self.values[row, column])
        return Derivative(
            self.responses[row],
            self.parameters[column],
            None if math.isnan(value) else value,
            max(kept.switched, default=0),
            kept.residual,
            kept.lost,
        )

    def column(self, name: str, path: str, stage: str | None = None) -> Floats:
        """Derivative of a column of the history, a value for each row; NaN from where it is unknown.

        Parameters
        ----------
        name, path : str
            Column, and path of the parameter.
        stage : str, optional
            Name of an operation; default: the last one.
        """
        self._index([one.path for one in self.parameters], path, "parameter")
        runs = self.runs if stage is None else self.stages[stage]
        found = np.full(len(runs.run), np.nan)
        if path in runs.shadows:  # else it was lost in an operation before
            base, other = runs.reference[name], runs.shadows[path][name]
            found[: len(other)] = (other - base[: len(other)]) / self.sizes[path]
        return found

    def displacement(self, path: str) -> Floats:
        """Derivative of the displacement of the nodes at the end, shape (n, 3); NaN if it is unknown."""
        self._index([one.path for one in self.parameters], path, "parameter")
        if self.runs.kept[path].lost:
            return np.full((self.run.model.u.size // 3, 3), np.nan)
        found: Floats = (self.runs.shadows[path].model.u - self.runs.reference.model.u) / self.sizes[path]
        return found.reshape(-1, 3)

    def holding(self, held: Mapping[str, str]) -> Derivatives:
        """Derivatives at constant values of some responses, each by a parameter that follows. eq. (5.164)

        Parameters
        ----------
        held : mapping of str to str
            Parameters that follow by the responses that stay constant; their values become responses.

        Raises
        ------
        InvalidValue
            A response does not depend on its parameter.
        """
        names, paths = [one.name for one in self.responses], [one.path for one in self.parameters]
        rows = [self._index(names, name, "response") for name in held]
        columns = [self._index(paths, path, "parameter") for path in held.values()]
        free = [number for number in range(len(paths)) if number not in columns]
        square = self.values[np.ix_(rows, columns)]
        if not np.isfinite(square).all() or np.linalg.cond(square) > 1e12:
            raise InvalidValue(
                "a response cannot be held by its parameter",
                where="hold",
                value=", ".join(f"{name} by {path}" for name, path in held.items()),
                cause="it does not depend on it, or the derivative is unknown",
                remedy="another parameter",
            )
        follow = -np.linalg.solve(square, self.values[np.ix_(rows, free)])
        values = self.values[:, free] + self.values[:, columns] @ follow
        values[rows] = 0.0
        added = [
            Quantity(one.path, one.unit, value=float(one.value), digits=6)
            for one in (self.parameters[number] for number in columns)
            if one.path not in names
        ]
        return replace(
            self,
            parameters=tuple(self.parameters[number] for number in free),
            responses=(*self.responses, *added),
            values=np.vstack([values, follow[[self.parameters[number].path not in names for number in columns]]]),
            held=dict(held),
        )

    @property
    def notes(self) -> list[str]:
        """What is constant, and where derivatives are one-sided."""
        found = [f"{name} is constant: {path} follows" for name, path in self.held.items()]
        switched = {one.path: max(self.runs.kept[one.path].switched, default=0) for one in self.parameters}
        sides = ", ".join(f"{path} {count}" for path, count in switched.items() if count)
        return [*found, f"points at a kink, where the derivative is one-sided: {sides}"] if sides else found

    @property
    def warnings(self) -> list[str]:
        """Unknown derivatives, and parameters without an effect."""
        found = []
        for one in self.parameters:
            kept = self.runs.kept[one.path]
            if kept.lost:
                found.append(f"derivatives by {one.path} are unknown from row {kept.from_row + 1} on: {kept.lost}")
            elif self._idle(one.path):
                found.append(f"{one.path} has no effect on this run")
        return found

    def _idle(self, path: str) -> bool:
        """Whether a shadow is the reference to the last bit."""
        pairs = ((runs.reference, runs.shadows[path]) for runs in self.stages.values())
        return all(
            np.array_equal(base[name], other[name], equal_nan=True) for base, other in pairs for name in base.columns()
        )

    def write(self, folder: str | Path) -> list[Path]:
        """Write the table of all derivatives, and those of the columns of the history of each operation.

        Returns
        -------
        list of Path
            The files.
        """
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        ones = list(self)
        write_csv(
            folder / TABLE,
            self._columns()
            | {
                "one_sided_points": [one.switched for one in ones],
                "residual": [one.residual for one in ones],
            },
        )
        histories = [self._write_history(folder, stage) for stage in self.stages]
        self.plot(self._main, folder / PICTURE)
        return [folder / TABLE, *histories, folder / PICTURE]

    def _write_history(self, folder: Path, stage: str) -> Path:
        """The history of an operation, with its name in that of the file if there are several."""
        path = folder / (HISTORY if len(self.stages) == 1 else HISTORY.replace(".", f"-{stage}."))
        run = self.stages[stage].run
        columns = {name: run[name] for name in run.columns()}
        for one in self.parameters:
            for name in run.columns():
                if name not in ("step", "iterations"):
                    columns[f"d {name} / d {one.path}"] = self.column(name, one.path, stage)
        write_csv(path, columns)
        return path

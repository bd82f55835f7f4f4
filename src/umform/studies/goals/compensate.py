"""Find parameters for wanted results, by derivatives of the first run and corrections from the next ones.

docs/theory, 5.17
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.analysis.newton.options import NewtonOptions
from umform.errors import InvalidValue, SolveError, UmformError
from umform.io.tables import write_csv
from umform.progress import Tick, progress_bar, silent
from umform.results.quantity import Quantity
from umform.spec import Scalar
from umform.studies.derivatives.derive import derivatives, known_parameter, subject_of
from umform.studies.derivatives.responses import Response
from umform.studies.derivatives.subjects import Subject

Floats = NDArray[np.float64]

#: Largest change of a parameter in the first step, relative to its value; later ones are longer after a step that did
#: nearly what was expected of it, and shorter after one that did not.
_STEP, _LONGER, _SHORTER, _EXPECTED = 0.3, 3.0, 0.5, 0.25
#: Steps that are shorter end the search.
_SHORTEST = 1e-4
#: A distance from the wanted results that falls to more than this part asks for new derivatives.
_SLOW = 0.5
#: Halvings of a step whose run fails.
_HALVINGS = 4
#: Smallest singular value, relative to the largest, of parameters that the results determine.
_DETERMINED = 1e-6
#: File of the runs.
TABLE = "compensation.csv"


@dataclass(frozen=True)
class Wanted:
    """A wanted result.

    Attributes
    ----------
    value : float
        The value.
    tolerance : float
        Largest deviation.

    Examples
    --------
    >>> import umform as uf
    >>> uf.Wanted(90.0, 0.05).tolerance
    0.05
    """

    value: float
    tolerance: float

    def __post_init__(self) -> None:
        if not (np.isfinite(self.value) and np.isfinite(self.tolerance) and self.tolerance > 0.0):
            raise InvalidValue(
                "a wanted result has a finite value and a tolerance above zero",
                where="want",
                value=f"{self.value} +- {self.tolerance}",
                remedy="Wanted(90.0, 0.05)",
            )


@dataclass(frozen=True)
class Trial:
    """A run on the way.

    Attributes
    ----------
    parameters : tuple of float
        Values of the parameters.
    results : tuple of float
        The results.
    derived : bool
        Whether it was run with derivatives.
    """

    parameters: tuple[float, ...]
    results: tuple[float, ...]
    derived: bool


@dataclass(frozen=True)
class Compensated:
    """Parameters for wanted results.

    Attributes
    ----------
    subject : Problem, case or callable
        The problem or case with the parameters; a function stays as it is.
    parameters : dict of str to Quantity
        The parameters by their paths.
    results : list of Quantity
        The results; ``limit`` is not used, the band is the tolerance.
    wanted : dict of str to Wanted
        What was wanted.
    trials : tuple of Trial
        All runs.
    reached : bool
        Whether all results are within their tolerances.

    Examples
    --------
    >>> import umform as uf
    >>> def build(way):
    ...     model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=210e3, nu=0.3))
    ...     model.fix("x0")
    ...     return model, uf.Move(model.prescribe("x1_lower", "z", name="tip"), to=-way, steps=2)
    >>> found = uf.compensate(build, {"tip_force": uf.Wanted(-0.2, 1e-6)}, by={"way": 0.5}, progress=False)
    >>> found.table[0]
    ['run', 'way', 'tip_force', 'derivatives']
    """

    subject: Any
    parameters: dict[str, Quantity]
    results: list[Quantity]
    wanted: dict[str, Wanted]
    trials: tuple[Trial, ...]
    reached: bool

    @property
    def table(self) -> list[list[str]]:
        """A header, and a row for each run."""
        names = [*self.parameters, *(one.label for one in self.results)]
        rows = [["run", *names, "derivatives"]]
        for number, trial in enumerate(self.trials, start=1):
            values = [f"{value:.6g}" for value in (*trial.parameters, *trial.results)]
            rows.append([str(number), *values, "yes" if trial.derived else ""])
        return rows

    def write(self, folder: str | Path) -> list[Path]:
        """Write the table of the runs, and the deck of a problem with the parameters."""
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        columns = np.array([(*trial.parameters, *trial.results) for trial in self.trials]).T
        names = [*self.parameters, *(one.name for one in self.results)]
        write_csv(folder / TABLE, dict(zip(names, columns.tolist(), strict=True)))
        files = [folder / TABLE]
        if hasattr(self.subject, "toml"):
            files.append(folder / "compensated.toml")
            files[-1].write_text(self.subject.toml(), encoding="utf-8")
        return files


def compensate(
    subject: Any,
    want: Mapping[str, Wanted],
    by: Sequence[str] | Mapping[str, float],
    *,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    most: int = 8,
    options: NewtonOptions | None = None,
    solver: str | None = None,
    progress: bool | None = None,
) -> Compensated:
    """Find values of parameters for which results are the wanted ones, such as angles after springback.

    The first run gives the derivatives, and these the next parameters; each further run corrects the derivatives by
    what it found (Broyden), and runs that gain little find new ones. More results than parameters are met in the
    least-squares sense, relative to their tolerances.

    Parameters
    ----------
    subject : Problem, case of a process, or callable
        As for :func:`umform.derivatives`.
    want : mapping of str to Wanted
        Wanted results by their names, see ``of`` of :func:`umform.derivatives`.
    by : sequence of str, or mapping of str to float
        Paths of the parameters; with start values for a function.
    bounds : mapping of str to tuple of float, optional
        Least and largest values of parameters.
    most : int
        Largest number of runs.
    options, solver
        Those of the run, for a function.
    progress : bool, optional
        Show a progress bar.

    Returns
    -------
    Compensated
        The parameters, and all runs. ``reached`` is false if the results cannot be met within the bounds or the runs.

    Raises
    ------
    InvalidValue
        A parameter or a result does not exist, or the results do not determine the parameters.
    NoConvergence
        The first run does not converge.

    Examples
    --------
    The force at the tip of a strip:

    >>> import umform as uf
    >>> def build(way):
    ...     model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=210e3, nu=0.3))
    ...     model.fix("x0")
    ...     return model, uf.Move(model.prescribe("x1_lower", "z", name="tip"), to=-way, steps=2)
    >>> found = uf.compensate(build, {"tip_force": uf.Wanted(-0.05, 1e-6)}, by={"way": 0.1})
    >>> found.reached, len(found.trials) <= 4
    (True, True)
    """
    start = subject_of(subject, by, options, solver)
    known = {one.path: one for one in start.parameters()}
    parameters = [known_parameter(name, known) for name in by]
    limits = {known_parameter(name, known).path: limit for name, limit in (bounds or {}).items()}
    search = _Search(start, parameters, dict(want), _limits(parameters, limits))
    with progress_bar(progress) as tick:
        return search.run(most, tick)


class _Search:
    def __init__(
        self,
        start: Subject,
        parameters: Sequence[Scalar],
        want: dict[str, Wanted],
        limits: Floats,
    ) -> None:
        self.start, self.parameters, self.want, self.limits = start, parameters, want, limits
        self.scale = np.array([abs(one.value) or 1.0 for one in parameters])
        self.goal = np.array([one.value for one in want.values()])
        self.tolerance = np.array([one.tolerance for one in want.values()])
        self.trials: list[Trial] = []
        self.responses: list[Response] = []
        self.tick: Tick = silent
        self.longest = _STEP

    def at(self, x: Floats) -> Subject:
        """The subject with some parameters."""
        return self.start.with_({one.path: float(value) for one, value in zip(self.parameters, x, strict=True)})

    def run(self, most: int, tick: Tick) -> Compensated:
        """Iterate."""
        self.tick = tick
        x = np.array([float(one.value) for one in self.parameters])
        y, slopes = self._derived(x)
        exact = True  # whether the slopes are derivatives at x
        while self._error(y) > 1.0 and len(self.trials) < most and self.longest > _SHORTEST:
            step = self._step(x, y, slopes)
            if np.abs(step / self.scale).max() < 1e-12:
                break  # at a bound
            x_new, y_new = self._next(x, step, most)
            moved, found = (x_new - x) / self.scale, y_new - y
            missed = self._distance(found - slopes @ moved)
            good = missed <= _EXPECTED * self._distance(found)
            gain = self._distance(y_new - self.goal) / self._distance(y - self.goal)
            self.longest = _LONGER * self.longest if good else _SHORTER * float(np.abs(moved).max())
            if gain >= 1.0 and exact:
                continue  # the derivatives are right, and the step was too long
            slopes = slopes + np.outer(found - slopes @ moved, moved) / float(moved @ moved)
            if gain < 1.0:
                x, y = x_new, y_new
            exact = not good and gain > _SLOW and len(self.trials) < most
            if exact:
                y, slopes = self._derived(x)
        return self._found(x, y)

    def _distance(self, change: Floats) -> float:
        """Norm of a change of the results relative to their tolerances."""
        return float(np.linalg.norm(change / self.tolerance))

    def _error(self, y: Floats) -> float:
        """Largest deviation relative to the tolerances."""
        return float(np.abs((y - self.goal) / self.tolerance).max())

    def _step(self, x: Floats, y: Floats, slopes: Floats) -> Floats:
        """Least-squares step of the scaled parameters, within bounds; eq. (5.165)"""
        from scipy.optimize import lsq_linear

        low, high = (self.limits.T - x) / self.scale
        box = np.maximum(low, -self.longest), np.minimum(high, self.longest)
        matrix = slopes / self.tolerance[:, None]
        sizes = np.linalg.svd(matrix, compute_uv=False)
        if len(sizes) < len(x) or sizes[-1] <= _DETERMINED * sizes[0]:
            raise InvalidValue(
                "the wanted results do not determine the parameters",
                where="by",
                value=", ".join(one.path for one in self.parameters),
                cause="more parameters than results, one without an effect, or two with the same effect",
                remedy="fewer parameters, or more wanted results",
            )
        open_ended = box[0] < box[1]
        if not open_ended.all():
            box = np.where(open_ended, box[0], box[0] - 1e-12), np.where(open_ended, box[1], box[1] + 1e-12)
        found: Floats = lsq_linear(matrix, (self.goal - y) / self.tolerance, bounds=box).x * self.scale
        return found

    def _next(self, x: Floats, step: Floats, most: int) -> tuple[Floats, Floats]:
        """The run after a step; a shorter one where it fails."""
        for halving in range(_HALVINGS):
            try:
                return x + step * 0.5**halving, self._plain(x + step * 0.5**halving)
            except (SolveError, InvalidValue) as error:
                last: UmformError = error
                if len(self.trials) >= most:
                    break
        raise last

    def _plain(self, x: Floats) -> Floats:
        thing = self.at(x)
        built = thing.build()
        results = built.solve(progress=False)
        numbers = {one.name: one.value for one in thing.quantities(built, *results)}
        return self._keep(x, [one.value(numbers, results[-1]) for one in self.responses], derived=False)

    def _derived(self, x: Floats) -> tuple[Floats, Floats]:
        """Results, and derivatives by the scaled parameters."""
        thing = self.at(x)
        by = dict(zip((one.path for one in self.parameters), x.tolist(), strict=True))
        found = derivatives(thing.given, by, list(self.want), **thing.settings)
        self.responses = list(found.measured)
        y = self._keep(x, [one.value for one in found.responses], derived=True)
        if not np.isfinite(found.values).all():
            raise InvalidValue(
                "a derivative of a wanted result is unknown", where="by", value="; ".join(found.warnings)
            )
        return y, found.values * self.scale

    def _keep(self, x: Floats, values: Sequence[float | None], *, derived: bool) -> Floats:
        if any(value is None for value in values):
            missing = [name for name, value in zip(self.want, values, strict=True) if value is None]
            raise InvalidValue("a run has no value of a wanted result", where="want", value=", ".join(missing))
        y = np.array(values, dtype=float)
        self.trials.append(Trial(tuple(x.tolist()), tuple(y.tolist()), derived))
        self.tick("runs", min(1.0, 1.0 / max(self._error(y), 1.0)), f"{len(self.trials)} runs")
        return y

    def _found(self, x: Floats, y: Floats) -> Compensated:
        parameters = {
            one.path: Quantity(one.path, one.unit, value=float(value), digits=6)
            for one, value in zip(self.parameters, x, strict=True)
        }
        results = [replace(one.quantity, value=float(value)) for one, value in zip(self.responses, y, strict=True)]
        reached = self._error(y) <= 1.0
        return Compensated(self.at(x).given, parameters, results, self.want, tuple(self.trials), reached)


def _limits(parameters: Sequence[Scalar], bounds: Mapping[str, tuple[float, float]]) -> Floats:
    """Least and largest value of each parameter, shape (n, 2)."""
    limits = []
    for one in parameters:
        low, high = bounds.get(one.path, (-np.inf, np.inf))
        if not low <= one.value <= high:
            raise InvalidValue(
                "a parameter starts outside of its bounds",
                where=one.path,
                value=one.value,
                cause=f"{low:g} to {high:g}",
            )
        limits.append((low, high))
    return np.array(limits, dtype=float)

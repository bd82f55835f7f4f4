"""Find parameters for wanted results, by derivatives of the first run and corrections from the next ones.

docs/theory, 5.17
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import Result
from umform.errors import InvalidPath, InvalidValue, UmformError
from umform.processes.rules import bound
from umform.progress import Tick, progress_bar, silent
from umform.results.quantity import Quantity
from umform.spec import Scalar, check_value
from umform.spec.types import Count
from umform.studies.derivatives.derive import derivatives, known_parameter, names_of, subject_of
from umform.studies.derivatives.responses import Response, responses
from umform.studies.derivatives.subjects import Built, OfCase, Subject
from umform.studies.goals.found import Compensated, Trial, Wanted
from umform.studies.goals.sequences import bent, by_rigid_legs, rigid_slopes
from umform.studies.goals.shapes import Shapes, Tools

Floats = NDArray[np.float64]

#: Largest change of a parameter in the first step, relative to its value; later ones are longer after a step that did
#: nearly what was expected of it, and shorter after one that led away from the wanted results.
_STEP, _LONGER, _SHORTER, _EXPECTED = 0.3, 3.0, 0.5, 0.25
#: The same relative to the range of a parameter with two bounds.
_RANGE = 0.5
#: Part of a change that derivatives may miss; beyond, secants take their place.
_WAVY = 0.5
#: Change of a parameter whose derivative is unknown, relative to the longest first step.
_PROBE = 0.3 * _STEP
#: Steps that are shorter end the search.
_SHORTEST = 1e-4
#: A distance from the wanted results that falls to more than this part asks for new derivatives.
_SLOW = 0.5
#: Effect of a change relative to the tolerances below which it says nothing of slopes, unless it led away from the
#: wanted results: it may be that of waves.
_SAYS = 3.0
#: Sine of the angle between changes, about, below which they are one.
_PARALLEL = 0.1
#: Halvings of a step whose run fails.
_HALVINGS = 4
#: Smallest singular value, relative to the largest, of parameters that the results determine.
_DETERMINED = 1e-6


def compensate(
    subject: Any,
    want: Mapping[str, Wanted],
    by: str | Sequence[str] | Mapping[str, float],
    *,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    most: Count = 8,
    options: NewtonOptions | None = None,
    solver: str | None = None,
    progress: bool | None = None,
) -> Compensated:
    """Find values of parameters for which results are the wanted ones, such as angles after springback.

    The first run gives the derivatives, and these the next parameters; each further run corrects the derivatives by
    what it found (secants), and runs that gain little find new ones. More results than parameters are met in the
    least-squares sense, relative to their tolerances.

    Parameters
    ----------
    subject : Problem, case of a process, or callable
        As for :func:`umform.derivatives`.
    want : mapping of str to Wanted
        Wanted results by their names, see ``of`` of :func:`umform.derivatives`.
    by : str, sequence of str, or mapping of str to float
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
        The parameters, and all runs. ``reached`` is false if the results cannot be met within the bounds or the runs,
        or the next run fails.

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
    for name, value in {"want": want, "by": by, "bounds": bounds, "most": most}.items():
        check_value(compensate, name, value)
    _check_wanted(want)
    start = _steady(subject_of(subject, by, options, solver))
    known = {one.path: one for one in start.parameters()}
    parameters = [known_parameter(name, known) for name in names_of(start, by)]
    _check_parameters(parameters, want)
    limits = {known_parameter(name, known, "bounds").path: limit for name, limit in (bounds or {}).items()}
    search = _Search(start, parameters, dict(want), _limits(parameters, limits))
    try:
        with progress_bar(progress) as tick:
            return search.run(most, tick)
    except InvalidValue as error:
        error.where = "want" if error.where == "of" else error.where  # as an argument of `derivatives`
        raise
    except KeyboardInterrupt as stop:
        if search.trials:
            stop.add_note(search.so_far())
        raise


def _check_wanted(want: Mapping[str, Wanted]) -> None:
    others = [name for name, one in want.items() if not isinstance(one, Wanted)]
    if not want or others:
        raise InvalidValue(
            "wanted results have values and tolerances" if want else "no result is wanted",
            where="want",
            value=", ".join(others) or None,
            remedy='want={"angle": Wanted(90.0, 0.05)}',
        )


def _check_parameters(parameters: Sequence[Scalar], want: Mapping[str, Wanted]) -> None:
    paths = [one.path for one in parameters]
    twice = sorted({path for path in paths if paths.count(path) > 1})
    if twice:
        raise InvalidValue("a parameter follows twice", where="by", value=", ".join(twice), remedy="once")
    if not paths or len(paths) > len(want):
        raise InvalidValue(
            "more parameters follow than results are wanted" if paths else "no parameter follows",
            where="by",
            value=", ".join(paths) or None,
            remedy="fewer parameters, or more wanted results" if paths else 'by=["stroke"], for instance',
        )


class _Search:
    def __init__(
        self,
        start: Subject,
        parameters: Sequence[Scalar],
        want: dict[str, Wanted],
        limits: Floats,
    ) -> None:
        self.start, self.parameters, self.want, self.limits = start, parameters, want, limits
        spans = np.diff(limits, axis=1)[:, 0] * _RANGE / _STEP
        sizes = [abs(one.value) or 1.0 for one in parameters]
        self.scale = np.where(np.isfinite(spans) & (spans > 0.0), spans, sizes)
        self.goal = np.array([one.value for one in want.values()])
        self.tolerance = np.array([one.tolerance for one in want.values()])
        #: Whether slopes are those of rigid legs.
        self.rigid = by_rigid_legs(start.given, list(want), [one.path for one in parameters])
        self.trials: list[Trial] = []
        self.responses: list[Response] = []
        self.tick: Tick = silent
        self.longest = _STEP
        self.missed = 0.0
        self.stopped = ""
        self.tools: Tools | None = None

    def so_far(self) -> str:
        """The best run up to now in a line; the parameters are the start of another search."""
        best = min(self.trials, key=lambda one: self._error(np.array(one.results)))
        values = zip((one.path for one in self.parameters), best.parameters, strict=True)
        named = [*values, *zip(self.want, best.results, strict=True)]
        said = ", ".join(f"{name} = {value:.6g}" for name, value in named)
        return f"  the best of {len(self.trials)} runs so far: {said}"

    def at(self, x: Floats) -> Subject:
        """The subject with some parameters."""
        return self.start.with_({one.path: float(value) for one, value in zip(self.parameters, x, strict=True)})

    def run(self, most: int, tick: Tick) -> Compensated:
        """Iterate."""
        self.tick = tick
        x = np.array([float(one.value) for one in self.parameters])
        exact = not self.rigid  # slopes: derivatives at x
        y, slopes = self._derived(x) if exact else self._foreseen(x)
        while self._error(y) > 1.0 and len(self.trials) < most and self.longest > _SHORTEST:
            step = self._step(x, y, slopes)
            if np.abs(step / self.scale).max() < 1e-12:
                break  # at a bound
            try:
                x_new, y_new = self._next(x, step, most)
            except UmformError as error:
                self.stopped = " ".join(str(error).split())
                break
            moved, found = (x_new - x) / self.scale, y_new - y
            if not found.any():
                raise InvalidValue(
                    "a step changes no wanted result",
                    where="by",
                    value=", ".join(one.path for one in self.parameters),
                    cause="the part does not respond, as with numbers in other units",
                    remedy="look at a run without wanted results first",
                )
            missed = self._distance(found - slopes @ moved)
            good = missed <= _EXPECTED * self._distance(found)
            gain = self._distance(y_new - self.goal) / self._distance(y - self.goal)
            if good:
                self.longest *= _LONGER
            elif gain >= 1.0:
                self.longest = _SHORTER * float(np.abs(moved).max())
            if exact and missed > _WAVY * self._distance(found):
                self.missed = max(self.missed, missed / self._distance(found))
            slopes = self._corrected(slopes, least=_SAYS if gain < 1.0 else 0.0)
            if gain < 1.0 or self._error(y_new) <= 1.0:
                x, y = x_new, y_new
            exact = not self.missed and not good and _SLOW < gain < 1.0 and len(self.trials) < most
            if exact:
                y, slopes = self._derived(x)
        return self._found(x, y)

    def _corrected(self, slopes: Floats, least: float) -> Floats:
        """The nearest slopes with which the last runs agree, as many as there are parameters.

        Changes count by their effects on the results; those below the least do not, of nearly parallel ones the
        mean does.
        """
        *before, last = self.trials[-1 - len(self.parameters) :]
        moved = np.array([np.subtract(one.parameters, last.parameters) / self.scale for one in before]).T
        found = np.array([np.subtract(one.results, last.results) for one in before]).T
        effect = np.linalg.norm(slopes / self.tolerance[:, None], axis=0)
        sizes = np.linalg.norm(effect[:, None] * moved, axis=0)
        known = sizes > least
        ways = effect[:, None] * moved[:, known] / sizes[known]
        missed = (found - slopes @ moved)[:, known] / sizes[known]
        corrected: Floats = slopes + missed @ np.linalg.pinv(ways, rcond=_PARALLEL) * effect
        return corrected

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
        if sizes[-1] <= _DETERMINED * sizes[0]:
            raise InvalidValue(
                "the wanted results do not determine the parameters",
                where="by",
                value=", ".join(one.path for one in self.parameters),
                cause="one without an effect, or two with the same effect",
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
            except UmformError as error:
                last = error
                if len(self.trials) >= most:
                    break
        raise last

    def _plain(self, x: Floats) -> Floats:
        thing = self.at(x)
        if self.rigid:
            return self._sequence(x)
        built = thing.build()
        results = built.solve(progress=False)
        numbers = {one.name: one.value for one in thing.quantities(built, *results)}
        values = [one.value(numbers, results[-1]) for one in self.responses]
        return self._keep(x, values, *self._shown(built, results[-1]))

    def _shown(self, built: Built, result: Result) -> tuple[Shapes | None, Result | None]:
        """Shapes of a run, and the run, which has the tools; none of several operations."""
        return (None, None) if built.after else (Shapes.of(built.steps, result), result)

    def _foreseen(self, x: Floats) -> tuple[Floats, Floats]:
        """Results of a sequence of bends, and slopes of rigid legs by the scaled strokes."""
        y = self._sequence(x)
        slopes = rigid_slopes(self.at(x).given, list(self.want), [one.path for one in self.parameters])
        return y, slopes * self.scale

    def _sequence(self, x: Floats) -> Floats:
        part = bent(self.at(x).given)
        known = {one.name: one for one in part.quantities if one.value is not None}
        self.responses = self.responses or responses(list(self.want), list(known.values()), part.bends[-1].result)
        values = [known[name].value if name in known else None for name in self.want]
        return self._keep(x, values, Shapes.of_part(part), None)

    def _derived(self, x: Floats) -> tuple[Floats, Floats]:
        """Results, and derivatives by the scaled parameters."""
        thing = self.at(x)
        found = derivatives(thing, [one.path for one in self.parameters], list(self.want))
        self.responses = list(found.measured)
        shown = self._shown(thing.build(), found.run)
        y = self._keep(x, [one.value for one in found.responses], *shown, derived=True)
        slopes = found.values * self.scale
        for column in np.flatnonzero(~np.isfinite(slopes).all(axis=0)):
            moved, y_new = self._probed(x, int(column))
            slopes[:, column] = (y_new - y) / moved
        return y, slopes

    def _probed(self, x: Floats, column: int) -> tuple[float, Floats]:
        """A change of one scaled parameter, and the results with it."""
        low, high = self.limits[column]
        size = _PROBE * self.scale[column]
        change = size if x[column] + size <= high else -size if x[column] - size >= low else high - x[column]
        step = np.zeros(len(x))
        step[column] = change
        return change / self.scale[column], self._plain(x + step)

    def _keep(
        self,
        x: Floats,
        values: Sequence[float | None],
        shapes: Shapes | None,
        result: Result | None,
        *,
        derived: bool = False,
    ) -> Floats:
        if any(value is None for value in values):
            missing = [name for name, value in zip(self.want, values, strict=True) if value is None]
            raise InvalidValue(
                "a run has no value of a wanted result",
                where="want",
                value=", ".join(missing),
                cause="it cannot be measured there: a part that tears, or springs back flat",
                remedy="another start, or narrower bounds",
            )
        y = np.array(values, dtype=float)
        before = min((self._distance(np.array(one.results) - self.goal) for one in self.trials), default=np.inf)
        if result is not None and self._distance(y - self.goal) <= before:
            self.tools = Tools.of(result)
        self.trials.append(Trial(tuple(x.tolist()), tuple(y.tolist()), derived, shapes))
        self.tick("runs", min(1.0, 1.0 / max(self._error(y), 1.0)), f"{len(self.trials)} runs")
        return y

    def _found(self, x: Floats, y: Floats) -> Compensated:
        parameters = {
            one.path: Quantity(one.path, one.unit, value=float(value), digits=6)
            for one, value in zip(self.parameters, x, strict=True)
        }
        results = [replace(one.quantity, value=float(value)) for one, value in zip(self.responses, y, strict=True)]
        reached = self._error(y) <= 1.0
        best = max(n for n, one in enumerate(self.trials) if one.parameters == tuple(x.tolist()))
        return Compensated(
            self.at(x).given,
            parameters,
            results,
            self.want,
            tuple(self.trials),
            reached,
            best,
            self.tools,
            self.missed,
            self.stopped,
        )


def _steady(start: Subject) -> Subject:
    """A case whose results are smooth functions of its parameters, if it has such a variant."""
    if isinstance(start, OfCase) and hasattr(start.case, "steady"):
        return replace(start, case=start.case.steady())
    return start


def _limits(parameters: Sequence[Scalar], bounds: Mapping[str, tuple[float, float]]) -> Floats:
    """Least and largest value of each parameter, shape (n, 2)."""
    others = sorted(set(bounds) - {one.path for one in parameters})
    if others:
        raise InvalidValue(
            "only a parameter that follows has bounds",
            where="bounds",
            value=", ".join(others),
            cause="it is missing in by, or another one was meant",
            remedy=f"name it in by, or bounds of {', '.join(one.path for one in parameters)}",
        )
    limits = []
    for one in parameters:
        given = bounds.get(one.path, (-np.inf, np.inf))
        if not isinstance(given, Collection) or [isinstance(end, Real) for end in given] != [True, True]:
            raise InvalidValue(
                "bounds are two numbers",
                where="bounds",
                value=f"{one.path}: {given}",
                cause="one number, a text, or None for no bound",
                remedy="(2.0, 5.0), with -math.inf or math.inf for none",
            )
        low, high = given
        if not low < high:
            raise InvalidValue(
                "the least value is below the largest one",
                where="by",
                value=f"{one.path}, {low:g} to {high:g}",
                cause="the two exchanged" if high < low else "both are equal, or one is nan",
                remedy="the least value first",
            )
        if not low <= one.value <= high:
            raise InvalidPath(
                "a parameter starts outside of its bounds",
                where=one.path,
                value=one.value,
                cause=f"they are {low:g} and {high:g}",
                remedy="a start between them, or wider bounds",
            )
        limits.append((bound(low), bound(high)))
    return np.array(limits, dtype=float)

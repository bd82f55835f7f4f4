"""Numbers of a problem from measurements: least squares with the derivatives of its runs. docs/theory, 5.17"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.analysis.newton.options import NewtonOptions
from umform.errors import InvalidValue
from umform.progress import Show
from umform.sheet_metals import Fit
from umform.sheet_metals.least_squares import uncertainty
from umform.studies.derivatives.derive import known_parameter, subject_of
from umform.studies.derivatives.subjects import OfFunction
from umform.studies.identification.data import Measured
from umform.studies.identification.found import Identified
from umform.studies.identification.runs import Runs
from umform.studies.identification.sought import Sought

Floats = NDArray[np.float64]
#: A part of the effect that is none: of a number compared to the largest, and of a combination of them.
_IDLE, _BLIND = 1e-6, 1e-3
#: Share of a number in a combination from which it is named.
_NAMED = 0.1
#: The search ends at this change of the sum of squares over that of one measurement, which has at least the second
#: number of standard deviations; and at this change of the numbers.
_ENOUGH, _FLOOR, _STEP = 1e-3, 0.3, 1e-6


def identify(
    subject: Any,
    find: Mapping[str, Any],
    data: Sequence[Measured] | Measured,
    *,
    most: int = 30,
    options: NewtonOptions | None = None,
    solver: str | None = None,
    progress: Show = None,
    on_run: Callable[[int, float], object] = lambda count, misfit: None,
) -> Identified:
    """Find numbers of a problem from measurements of what it simulates, by least squares.

    Each trial is a run with its derivatives; the sum of squares is eq. (5.172). The misfit is measured in standard
    deviations of the measurements.

    Parameters
    ----------
    subject : Problem, case of a process, or callable
        As of :func:`umform.derivatives`.
    find : mapping of str to Sought, pair of float, float or None
        Bounds, or a first value, by path; see `Problem.paths`. What was known before is another measurement:
        ``Sought(400.0, 700.0, start=520.0, deviation=30.0)``.
    data : sequence of MeasuredCurve or MeasuredNumber
        Measurements. Either all of them, and what was known before, have standard deviations or none: these are then
        1 % of the largest number of each, and the errors of the result follow from the scatter.
    most : int
        Largest number of trials.
    options, solver
        Those of the run, for a function.
    progress : bool or callable, optional
        Show a progress bar for each run.
    on_run : callable
        Called after each trial with the number of runs and the misfit.

    Returns
    -------
    Identified
        Values, standard deviations, correlations, residuals, and the problem with them.

    Raises
    ------
    InvalidValue
        Something is named wrongly, or the measurements do not determine what is looked for.
    NoConvergence
        The first run does not converge, or no other one.

    Examples
    --------
    >>> import umform as uf
    >>> def build(E):
    ...     model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=E, nu=0.3))
    ...     model.fix("x0")
    ...     return model, uf.Move(model.prescribe("x1_lower", "z", name="tip"), to=-0.1, steps=2)
    >>> stiff = uf.derivatives(build, {"E": 206e3}, ["tip_force"]).responses[0].value
    >>> found = uf.identify(build, {"E": (150e3, 250e3)}, [uf.MeasuredNumber("tip_force", stiff, 1e-4)])
    >>> round(found.values["E"], -1)
    206000.0
    """
    measured = list(data) if isinstance(data, Iterable) else [data]
    if not find or not measured:
        raise InvalidValue(
            "there is nothing to find, or nothing was measured",
            where="find" if not find else "data",
            cause="an empty list",
            remedy="bounds by path, and at least one measured curve or number",
        )
    if not most >= 1:
        raise InvalidValue("one trial at least is needed", where="most", value=most, remedy="30, for instance")
    thing = subject_of(subject, dict.fromkeys(find, 0.0), options, solver)
    known = {one.path: one for one in thing.parameters()}
    sought: dict[str, Sought] = {}
    for name, given in find.items():
        path = known_parameter(name, known, "find").path
        if path in sought:
            raise InvalidValue("a number is looked for twice", where="find", value=f"{path}, {name}", remedy="once")
        sought[path] = Sought.of(given, path)
    _refuse_mixed(measured, sought)
    present = {} if isinstance(thing, OfFunction) else {path: float(known[path].value) for path in sought}
    start = np.array([one.begin(present.get(path), path) for path, one in sought.items()])
    scale = np.array([one.scale(first) for one, first in zip(sought.values(), start, strict=True)])
    runs = Runs(thing, list(sought), sorted(measured, key=lambda one: repr(one.at)), known, progress, on_run)
    search = _Search(runs, sought, start, scale)
    search.refuse_blind()
    before = runs.at(start)[0]
    values, at_bound, enough = search.run(most)
    if runs.refusal is not None and (values == start).all():
        raise runs.refusal
    return _identified(search, values, at_bound, before, enough=enough)


class _Search:
    """Residuals and derivatives in steps of the search; what was known before is measured, too."""

    def __init__(self, runs: Runs, sought: Mapping[str, Sought], start: Floats, scale: Floats) -> None:
        self.runs, self.sought, self.start, self.scale = runs, sought, start, scale
        self.prior = np.array([0.0 if one.deviation is None else 1.0 / one.deviation for one in sought.values()])

    def values(self, x: Floats) -> Floats:
        """The numbers at a point of the search."""
        return self.start + self.scale * x

    def residuals(self, x: Floats) -> Floats:
        """Differences over their standard deviations, from measurements and from what was known."""
        own = (self.prior * self.scale * x)[self.prior > 0]
        found = self.runs.residuals(self.values(x))
        return np.concatenate([found, own, [_FLOOR * math.sqrt(len(found))]])

    def jacobian(self, x: Floats) -> Floats:
        """Derivatives of the residuals."""
        own = np.diag(self.prior * self.scale)[self.prior > 0]
        return np.concatenate([self.runs.jacobian(self.values(x)) * self.scale, own, np.zeros((1, len(x)))])

    def run(self, most: int) -> tuple[Floats, Floats, bool]:
        """Values with the least sum of squares, whether each is at a bound, and whether the search has ended."""
        from scipy.optimize import least_squares  # the import is slow

        low = np.array([one.low for one in self.sought.values()])
        high = np.array([one.high for one in self.sought.values()])
        found = least_squares(
            self.residuals,
            np.zeros(len(self.start)),
            self.jacobian,
            bounds=((low - self.start) / self.scale, (high - self.start) / self.scale),
            x_scale=1.0,
            method="dogbox",  # full steps between the bounds; "trf" shortens them near a bound and needs more runs
            ftol=_ENOUGH / len(self.runs.numbers[0]),
            xtol=_STEP,
            max_nfev=most,
        )
        return self.values(found.x), found.active_mask != 0, found.status > 0

    def refuse_blind(self) -> None:
        """Refuse numbers, and combinations of them, on which the measurements do not depend.

        Raises
        ------
        InvalidValue
        """
        names = list(self.sought)
        jacobian = self.jacobian(np.zeros(len(names)))[:-1]
        effects = np.linalg.norm(jacobian, axis=0)
        idle = [name for name, effect in zip(names, effects, strict=True) if effect <= _IDLE * effects.max()]
        if idle:
            raise _undetermined(
                "the measurements do not depend on this number", idle, "no effect on the run, or before"
            )
        if len(jacobian) < len(names):
            raise _undetermined("fewer measurements than numbers", names, f"{len(jacobian)} for {len(names)}")
        _, sizes, directions = np.linalg.svd(jacobian / effects)
        if sizes[-1] < _BLIND:
            tied = [name for name, share in zip(names, directions[-1], strict=True) if abs(share) > _NAMED]
            raise _undetermined(
                "the measurements determine only a combination of these numbers",
                tied,
                "the effect of one is that of the others",
            )


def _undetermined(what: str, names: Sequence[str], cause: str) -> InvalidValue:
    return InvalidValue(
        what,
        where="find",
        value=", ".join(names),
        cause=cause,
        remedy="look for fewer, measure something else too, or say what was known before: "
        "+-DEVIATION behind the bounds",
    )


def _refuse_mixed(data: Sequence[Measured], sought: Mapping[str, Sought]) -> None:
    """Refuse measurements without standard deviations beside others, or beside what was known before."""
    given = [*(one.known for one in data), *(True for one in sought.values() if one.deviation is not None)]
    if any(given) and not all(given):
        raise InvalidValue(
            "some measurements have a standard deviation, others have none",
            where="data",
            value=", ".join(one.name for one in data if not one.known),
            cause="their weights cannot be compared",
            remedy="give each of them its standard deviation, or none, also to what was known before",
        )


def _identified(search: _Search, values: Floats, at_bound: Floats, before: Floats, *, enough: bool) -> Identified:
    runs = search.runs
    x = (values - search.start) / search.scale
    residual, jacobian = search.residuals(x)[:-1], search.jacobian(x)[:-1] / search.scale
    free = len(residual) - len(values)
    given = all(one.known for one in runs.data)
    unknown = not given and free <= 0  # the residual is round-off
    scatter = 1.0 if given or unknown else float(residual @ residual) / free
    spread, correlation = uncertainty(jacobian * search.scale, scatter)
    spread = np.where(np.logical_or(at_bound, unknown), np.inf, spread * search.scale)
    names = list(search.sought)
    stopped = "" if runs.refusal is None else str(runs.refusal).splitlines()[0]
    number, _, last = runs.at(values)
    rounded = {name: float(f"{value:.7g}") for name, value in zip(names, values.tolist(), strict=True)}
    law = runs.thing.with_(rounded)
    fit = Fit(
        law,
        dict(zip(names, values.tolist(), strict=True)),
        dict(zip(names, spread.tolist(), strict=True)),
        float(np.sqrt(np.mean(residual**2))),
        correlation,
        {name: one.size for name, one in search.sought.items()},
    )
    return Identified(
        fit=fit,
        sought=search.sought,
        start=dict(zip(names, search.start.tolist(), strict=True)),
        data=tuple(runs.data),
        before=before,
        after=number,
        last=tuple(last),
        runs=runs.count,
        refused=runs.refused,
        unfinished=stopped or ("" if enough else "more trials are needed"),
        given=given,
        unknown_errors=unknown,
    )

"""Scatter of the results of a run from the scatter of its parameters. docs/scatter.md"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import Result
from umform.errors import InvalidValue, UmformError
from umform.progress import Show
from umform.results.quantity import Quantity
from umform.spec import Scalar, check_value, each
from umform.studies.derivatives import Derivatives, derivatives
from umform.studies.derivatives.derive import held_by, known_parameter, names_of, subject_of
from umform.studies.derivatives.subjects import Subject
from umform.studies.scatter.correlations import covariance
from umform.studies.scatter.found import Scattered
from umform.studies.scatter.limits import Limits
from umform.studies.scatter.second_run import STEPS, SecondRun, second_run
from umform.studies.scatter.source import Scatter, Source
from umform.studies.scatter.spread import Spread

Floats = NDArray[np.float64]
#: What a result may be named by.
Wanted = Sequence[str | Callable[[Result], float | Quantity]]


def scatter(
    subject: Any,
    sources: Mapping[str, Scatter | float | str],
    of: str | Wanted | None = None,
    *,
    correlations: Mapping[tuple[str, str], float] | None = None,
    limits: Mapping[str, Limits | tuple[float | None, float | None] | str] | None = None,
    hold: Mapping[str, str] | None = None,
    values: Mapping[str, float] | None = None,
    options: NewtonOptions | None = None,
    solver: str | None = None,
    progress: Show = None,
) -> Scattered:
    """Standard deviations of the results of a run, the share of each source, and the capability for limits.

    The derivatives of one run give them to first order. A second run, with the largest source of the first result (or
    of each result with limits) two standard deviations higher or lower, shows whether the first order holds.

    Parameters
    ----------
    subject : Problem, case of a process, or callable
        See :func:`umform.derivatives`.
    sources : mapping of str to Scatter, float or str
        Scatter of each parameter by its path: a standard deviation, or a text such as ``"5%"``.
    of : str, or sequence of str or callable, optional
        Results, see :func:`umform.derivatives`. Default: those with limits, or all.
    correlations : mapping of tuple of str to float, optional
        Coefficients by pairs of sources; other pairs are independent.
    limits : mapping of str to Limits, tuple or str, optional
        Smallest and largest allowed value of results, such as ``"89:91"``.
    hold : mapping of str to str, optional
        Results that stay constant, each by a parameter that follows: ``{"angle": "stroke"}``.
    values : mapping of str to float, optional
        Values of all parameters, for a function.
    options, solver
        Those of the run, for a function.
    progress : bool or callable, optional
        Show a progress bar.

    Returns
    -------
    Scattered
        A :class:`Spread` for each result.

    Raises
    ------
    InvalidValue
        A parameter or result does not exist; a scatter, correlation or limit is invalid.
    NoConvergence
        The run does not converge.

    Examples
    --------
    >>> import umform as uf
    >>> def build(E, deflection):
    ...     model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=E, nu=0.3))
    ...     model.fix("x0")
    ...     return model, uf.Move(model.prescribe("x1_lower", "z", name="tip"), to=-deflection, steps=2)
    >>> scattered = {"E": "3%", "deflection": uf.Scatter(0.012, tolerance=True)}
    >>> found = uf.scatter(build, scattered, of=["tip_force"], values={"E": 210e3, "deflection": 0.1})
    >>> {path: round(share.value) for path, share in found["tip_force"].shares.items()}
    {'E': 36, 'deflection': 64}
    """
    plan = Plan.of(
        subject,
        sources,
        of,
        correlations=correlations,
        limits=limits,
        hold=hold,
        values=values,
        options=options,
        solver=solver,
    )
    return plan.run(progress)


@dataclass(frozen=True)
class Plan:
    """A study that is ready to run: all that can be checked before the run has been checked.

    Attributes
    ----------
    subject : object
        What a user gives.
    thing : Subject
        The same, as it can be built and varied.
    by : sequence of str or mapping
        Paths of the sources, then of the parameters that follow.
    sources : tuple of Source
        The parameters that scatter.
    covariance : ndarray
        Their covariance.
    wanted : sequence of str or callable, optional
        Results whose derivatives are wanted; None for all.
    limits : dict of str to Limits
        Limits by results.
    held : dict of str to str
        Results that stay constant, and the parameters that follow.
    settings : dict
        Options and solver.
    """

    subject: Any
    thing: Subject
    by: Sequence[str] | Mapping[str, float]
    sources: tuple[Source, ...]
    covariance: Floats
    wanted: Wanted | None
    limits: Mapping[str, Limits]
    held: Mapping[str, str]
    settings: Mapping[str, Any]

    @classmethod
    def of(
        cls,
        subject: Any,
        sources: Mapping[str, Scatter | float | str],
        of: str | Wanted | None = None,
        *,
        correlations: Mapping[tuple[str, str], float] | None = None,
        limits: Mapping[str, Limits | tuple[float | None, float | None] | str] | None = None,
        hold: Mapping[str, str] | None = None,
        values: Mapping[str, float] | None = None,
        **settings: Any,
    ) -> Self:
        """The plan for what a user wants; see :func:`scatter`.

        Raises
        ------
        InvalidValue
            A parameter does not exist; a scatter, correlation or limit is invalid.
        """
        given = {"sources": sources, "of": each(of), "correlations": correlations, "limits": limits, "hold": hold}
        for name, value in (given | {"values": values}).items():
            check_value(scatter, name, value)
        subject = getattr(subject, "as_made", subject)  # tools do not follow a sheet that scatters
        allowed = {name: Limits.of(one) for name, one in (limits or {}).items()}
        thing = subject_of(subject, values, settings.get("options"), settings.get("solver"))
        if values is not None:
            names_of(thing, values, "values", "leave them out")
        numbers = {one.path: one for one in thing.parameters()}
        held = held_by(hold or {}, numbers)
        made = _sources(sources, numbers, held)
        matrix = covariance(made, correlations or {}, lambda name: known_parameter(name, numbers, "correlations").path)
        by: Any = [*(one.path for one in made), *held.values()]
        if values is not None:
            subject = partial(subject, **{name: value for name, value in values.items() if name not in by})
            by = {name: values[name] for name in by}
        wanted = _wanted(each(of), allowed, held)
        lead, known = thing.build(), {*held.values(), *(_name(one) for one in each(of) or () if callable(one))}
        for where, names in {"of": each(of) or (), "limits": allowed, "hold": held}.items():
            thing.refuse_unknown(lead, [one for one in names if one not in known], where)
        return cls(subject, thing, by, tuple(made), matrix, wanted, allowed, held, settings)

    def run(self, progress: Show = None) -> Scattered:
        """Run it."""
        try:
            free = derivatives(self.subject, self.by, self.wanted, progress=progress, **self.settings)
        except InvalidValue as error:
            error.where = "limits" if error.where == "of" and error.value in self.limits else error.where
            raise
        kept = free.holding(self.held) if self.held else free
        runs: list[SecondRun] = []
        failures = []
        for path in _largest(self._spreads(kept, []), self.limits):
            step = STEPS * next(one.deviation for one in self.sources if one.path == path)
            try:
                runs.append(second_run(self.thing, free, kept, path, step, self.wanted, progress))
            except UmformError as error:
                failures.append(f"a second run at {path} ± {STEPS:g} sigma failed: {str(error).splitlines()[0]}")
        spreads = tuple(self._spreads(kept, runs))
        return Scattered(spreads, self.sources, self.covariance, kept, tuple(runs), tuple(failures))

    def _spreads(self, found: Derivatives, runs: Sequence[SecondRun]) -> list[Spread]:
        """The spread of each result, with the second run of its largest source."""
        by_source = {one.path: one for one in runs}
        spreads: dict[str, Spread] = {}
        for response, slopes in zip(found.responses, found.values, strict=True):
            limits = self.limits.get(response.name)
            one = Spread.of(response, slopes, self.sources, self.covariance, limits)
            second = by_source.get(one.largest or "")
            one = one if second is None else one.checked(second, slopes, self.covariance)
            spreads.setdefault(one.name, one)
        return list(spreads.values())


def _sources(
    given: Mapping[str, Scatter | float | str], numbers: Mapping[str, Scalar], held: Mapping[str, str]
) -> list[Source]:
    """The sources with their standard deviations.

    Raises
    ------
    InvalidValue
        A parameter is unknown, given twice, or follows; a scatter is invalid.
    """
    found: dict[str, Source] = {}
    for name, one in given.items():
        parameter = known_parameter(name, numbers, "sources")
        if parameter.path in found or parameter.path in held.values():
            raise InvalidValue(
                "a parameter cannot scatter twice"
                if parameter.path in found
                else "a parameter that follows has no scatter",
                where=parameter.path,
                value=name,
                cause="two names of the same number" if parameter.path in found else "it is adjusted to keep a result",
                remedy="leave one of them out",
            )
        try:
            size = Scatter.of(one).deviation(parameter)
        except InvalidValue as error:
            error.where = parameter.path
            raise
        found[parameter.path] = Source(parameter, size)
    if not found:
        raise InvalidValue("no parameter scatters", where="sources", remedy="name at least one, such as thickness=2%")
    return list(found.values())


def _wanted(of: Wanted | None, limits: Mapping[str, Limits], held: Mapping[str, str]) -> Wanted | None:
    """Results whose derivatives are wanted; None for all. A parameter that follows is one in any case."""
    if of is None and not limits:
        return None
    given = list(limits if of is None else of)
    taken = [*map(_name, given), *held.values()]
    return [*given, *(name for name in dict.fromkeys([*limits, *held]) if name not in taken)]


def _name(result: str | Callable[[Result], Any]) -> str:
    return result if isinstance(result, str) else getattr(result, "__name__", "number")


def _largest(spreads: Sequence[Spread], limits: Mapping[str, Limits]) -> list[str]:
    """The largest source of each result with limits, or of the first result that scatters."""
    paths = [one.largest for one in spreads if one.largest and (not limits or one.name in limits)]
    return list(dict.fromkeys(paths)) if limits else paths[:1]

"""A second run with the largest source two standard deviations off: it shows whether the first order holds."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from umform.analysis.run import Result
from umform.errors import UmformError
from umform.model import Model
from umform.progress import Show
from umform.results.quantity import Quantity
from umform.studies.derivatives import Derivatives
from umform.studies.derivatives.responses import responses
from umform.studies.derivatives.subjects import Built, Subject

#: Change of the source in standard deviations.
STEPS = 2.0
#: Difference of the predicted and the found change, relative to the larger of them, above which there is a warning.
ALLOWED = 0.2


@dataclass(frozen=True)
class SecondRun:
    """Changes of results by a larger change of one source.

    Attributes
    ----------
    path : str
        Path of the source.
    step : float
        Its change: two standard deviations up, or down if only that is allowed or leaves the number of elements.
    predicted, found : dict of str to float or None
        Changes of the results, by the derivative and in the run.
    elements : tuple of int
        Number of elements of the first run and of this one.
    """

    path: str
    step: float
    predicted: Mapping[str, float | None]
    found: Mapping[str, float | None]
    elements: tuple[int, int]

    @property
    def title(self) -> str:
        """The run in words."""
        return f"a second run at {self.place}"

    @property
    def place(self) -> str:
        """The parameter and its deviation."""
        return f"{self.path} {'+' if self.step > 0.0 else '-'} {STEPS:g} sigma"

    @property
    def note(self) -> str:
        """Other difference from the first run; empty without one."""
        one, other = self.elements
        return "" if one == other else f"it has {other} elements in place of {one}, whose error is in the difference"

    def change(self, name: str) -> tuple[float, float] | None:
        """Predicted and found change of a result; None if one of them is unknown."""
        predicted, found = self.predicted.get(name), self.found.get(name)
        return None if predicted is None or found is None else (predicted, found)

    def difference(self, name: str) -> float | None:
        """Difference of both, relative to the larger of them."""
        change = self.change(name)
        if change is None or not any(change):
            return None
        return abs(change[1] - change[0]) / max(map(abs, change))


def second_run(
    thing: Subject,
    free: Derivatives,
    held: Derivatives,
    path: str,
    step: float,
    of: Sequence[str | Callable[[Result], float | Quantity]] | None,
    progress: Show = None,
) -> SecondRun:
    """Run with another value of a source, and compare the changes with the derivatives.

    Parameters that keep results constant follow by their derivatives; then what is left of these results is corrected
    with the derivatives of the first run.

    Parameters
    ----------
    thing : Subject
        What was run.
    free, held : Derivatives
        Derivatives without and with held results; the same without any.
    path : str
        The source.
    step : float
        Size of its change.
    of : sequence of str or callable, optional
        Wanted results.
    progress : bool or callable, optional
        Show a progress bar.

    Raises
    ------
    UmformError
        The value is refused, or the run does not converge.
    """
    other, built, step = _varied(thing, free, held, path, step)
    results = built.solve(progress)
    after = {one.name: one.quantity.value for one in responses(of, other.quantities(built, *results), results[-1])}
    before = {one.name: one.value for one in free.responses}
    found = {name: _difference(after.get(name), value) for name, value in before.items()}
    follow = _followers(held, path, step)
    if follow:
        found = _corrected(free, held.held, found, follow)
    names = [one.name for one in held.responses]
    predicted = {name: _times(held[name, path].value, step) for name in names}
    elements = _elements(free.run.model), _elements(results[-1].model)
    return SecondRun(path, step, predicted, {name: found.get(name) for name in names}, elements)


def _varied(
    thing: Subject, free: Derivatives, held: Derivatives, path: str, size: float
) -> tuple[Subject, Built, float]:
    """The thing with a larger value, or with a smaller one if only that is allowed or leaves the number of elements.

    Raises
    ------
    UmformError
        Both are refused.
    """
    values = {one.path: float(one.value) for one in free.parameters}
    elements = _elements(next(iter(free.stages.values())).run.model)  # of the first operation, which is built here
    found: list[tuple[Subject, Built, float]] = []
    refusal: UmformError | None = None
    for step in (size, -size):
        changes = {path: step} | _followers(held, path, step)
        try:
            other = thing.with_({name: values[name] + change for name, change in changes.items()})
            found.append((other, other.build(), step))
        except UmformError as error:
            refusal = refusal or error
        else:
            if _elements(found[-1][1].model) == elements:
                return found[-1]
    if not found and refusal is not None:
        raise refusal
    return found[0]


def _elements(model: Model) -> int:
    return len(model.mesh.connectivity)


def _followers(held: Derivatives, path: str, step: float) -> dict[str, float]:
    """Changes of the parameters that keep results constant."""
    return {name: step * (held[name, path].value or 0.0) for name in held.held.values()}


def _corrected(
    free: Derivatives, held: Mapping[str, str], found: Mapping[str, float | None], follow: Mapping[str, float]
) -> dict[str, float | None]:
    """Changes at the values of the followers that keep the held results."""
    matrix = np.array([[free[name, path].value for path in held.values()] for name in held], dtype=float)  # None is nan
    rest = np.array([np.nan if found[name] is None else found[name] for name in held], dtype=float)
    more = dict(zip(held.values(), np.linalg.solve(matrix, -rest), strict=True))
    corrected: dict[str, float | None] = {}
    for name, change in found.items():
        parts = [_times(free[name, path].value, size) for path, size in more.items()]
        known = change is not None and None not in parts
        corrected[name] = float(change + sum(filter(None, parts))) if known else None  # type: ignore[operator]
    return corrected | {path: float(follow[path] + size) for path, size in more.items()}


def _difference(one: float | None, other: float | None) -> float | None:
    return None if one is None or other is None else one - other


def _times(one: float | None, factor: float) -> float | None:
    return None if one is None else one * factor


__all__ = ["ALLOWED", "STEPS", "SecondRun", "second_run"]

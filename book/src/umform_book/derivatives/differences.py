"""Derivatives by shadows beside whole runs with changed parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import umform as uf
from umform.analysis.run.open_run import OpenRun

Floats = NDArray[np.float64]

#: Whole runs are solved to round-off.
TIGHT = uf.NewtonOptions(residual=1e-12, increment=1e-9, max_iterations=60)
#: Largest error of a shadow: the round-off of whole runs over a change of 3e-5 gives 4e-5 to 1.1e-4 with the processor.
SHADOW = 2e-4
#: Smallest derivative that counts, relative to the value of the column over that of the parameter.
_FAINT = 1e-3


@dataclass(frozen=True)
class Example:
    """A model with parameters.

    Attributes
    ----------
    build : callable
        Takes the parameters; returns the model and its steps.
    values : mapping of str to float
        The parameters.
    columns : sequence of str
        Columns of the history to compare.
    ends : bool
        Whether only the last rows are compared: the increments of the whole runs depend on the parameters.
    replays : bool
        Whether the whole runs repeat increments and growth of penalties of the run, which depend on the parameters.
    size : float
        Change of a parameter in central differences, relative to its value.
    limit : float
        Largest error of a derivative: its change over the change of the parameter, or what the ends of the whole runs
        are known to.
    """

    build: Callable[..., tuple[uf.Model, Any]]
    values: Mapping[str, float]
    columns: Sequence[str]
    ends: bool = False
    replays: bool = False
    size: float = 1e-4
    limit: float = 3e-4


@dataclass(frozen=True)
class Compared:
    """Largest errors of the derivatives of all columns with respect to one parameter.

    Attributes
    ----------
    parameter : str
        The parameter.
    shadow : float
        Of the change in the shadow from that of a whole run with the same change.
    derivative : float
        Of the derivative from central differences.
    switched : int
        Points in another state in the shadow than in the run.
    """

    parameter: str
    shadow: float
    derivative: float
    switched: int


def compared(example: Example, names: Sequence[str] | None = None) -> Iterator[Compared]:
    """Errors for each parameter, relative to the largest derivative of a column.

    Parameters
    ----------
    example : Example
        The model.
    names : sequence of str, optional
        Its parameters to vary; default: all.
    """
    chosen = {name: example.values[name] for name in names or example.values}

    def build(**changed: float) -> tuple[uf.Model, Any]:
        return example.build(**{**example.values, **changed})

    found = uf.derivatives(build, by=chosen, of=[], options=TIGHT, progress=False)
    for name, value in chosen.items():
        size, step = found.sizes[name], example.size * (abs(value) or 1.0)
        same = _whole(example, build(**{name: value + size}), found.run)
        after, before = (_whole(example, build(**{name: value + change}), found.run) for change in (step, -step))
        shadow = derivative = 0.0
        for column in example.columns:
            rows = slice(-1, None) if example.ends else slice(None)
            wanted = (after[column][rows] - before[column][rows]) / (2.0 * step)
            own = (same[column][rows] - found.runs.reference[column][rows]) / size
            had = found.column(column, name)[rows]
            faint = _FAINT * float(np.abs(found.run[column]).max()) / (abs(value) or 1.0)
            shadow = max(shadow, _error(had, own, faint))
            derivative = max(derivative, _error(had, wanted, faint))
        yield Compared(name, shadow, derivative, max(found.runs.kept[name].switched))


def _error(had: Floats, wanted: Floats, faint: float) -> float:
    error = float(np.abs(had - wanted).max() / max(float(np.abs(wanted).max()), faint, 1e-300))
    return error if np.isfinite(error) else np.inf


def _whole(example: Example, built: tuple[uf.Model, Any], run: uf.Result) -> uf.Result:
    """A whole run, in its own increments or in those of another run."""
    model, steps = built
    contacts, initial = model.system.penalised, [contact.initial_penalty for contact in model.system.penalised]
    if not example.replays:
        return uf.solve(model, steps, options=TIGHT, frames=0, progress=False)
    again = OpenRun(model, options=TIGHT, frames=0)
    for number, step in enumerate(steps if isinstance(steps, list) else [steps], start=1):
        starts, since = [control.value for control in step.moved()], model.system.time
        rows = [row for row in run.rows if row["step"] == number]
        for before, row in zip([since, *(one["time"] for one in rows)], rows, strict=False):
            for contact, start, other in zip(contacts, initial, run.model.system.penalised, strict=True):
                if other.adapts:  # what is set does not grow by itself as well
                    contact.penalty = row[f"{contact.name}_penalty"] / other.initial_penalty * start
            values = step.values((row["time"] - since) / step.time, starts)
            again.take(uf.Move(step.moved(), values, steps=1, time=row["time"] - before))
    return again.close()

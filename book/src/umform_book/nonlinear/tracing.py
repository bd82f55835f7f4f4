"""A load-displacement curve: a model, its loads, where displacements are read off, and following the load."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.analysis.run import Result
from umform.analysis.steps import Move
from umform.analysis.steps.arc_length.arc import Arc
from umform.mesh import Ids
from umform.model import Model
from umform.model.terms.dead_load import Load

Floats = NDArray[np.float64]

#: Columns by name: :data:`LOAD` and the probes.
Curve = Mapping[str, Floats]
LOAD = "load_fraction"


class Solve(Protocol):
    """Function that solves a step: :func:`umform.solve`, or that of a page, which records the balance."""

    def __call__(self, model: Model, steps: Move | Arc, *, frames: int) -> Result:
        """Solve."""


@dataclass(frozen=True)
class Probe:
    """Where a displacement is measured.

    Attributes
    ----------
    nodes : ndarray of int
        The displacement is the mean of these nodes, a lower and an upper one for instance.
    direction : tuple of float
        Unit vector of the direction that counts as positive.
    """

    nodes: Ids
    direction: tuple[float, float, float]

    def read(self, u: Floats) -> float:
        """The displacement, from all displacements (n, 3)."""
        return float(u[self.nodes].mean(axis=0) @ np.array(self.direction))


@dataclass(frozen=True)
class Setup:
    """A model that is ready to be loaded.

    Attributes
    ----------
    model : Model
        Mesh, element, material and supports.
    loads : mapping of Load to float or callable
        Loads with their values at full load, or with their values as functions of the load fraction.
    probes : mapping of str to Probe
        What is measured, by the names of the columns of the reference.
    """

    model: Model
    loads: Mapping[Load, float | Callable[[float], float]]
    probes: Mapping[str, Probe]


def trace(setup: Setup, fractions: ArrayLike, solve: Solve) -> dict[str, Floats]:
    """Follow the load and measure at load fractions.

    Parameters
    ----------
    setup : Setup
        The model, unloaded.
    fractions : array_like, shape (k,)
        Load fractions above zero in ascending order, each of which an increment meets.
    solve : callable
        Takes the model, a step and the number of frames to keep.

    Returns
    -------
    dict of str to ndarray, shape (k + 1,)
        Load fractions, zero first, and the probes there.
    """
    marks = np.concatenate([[0.0], np.asarray(fractions, dtype=float)])
    count = len(marks) - 1

    def along(to: float | Callable[[float], float]) -> Callable[[float], float]:
        def at(time: float) -> float:
            fraction = float(np.interp(time * count, np.arange(count + 1), marks))
            return to(fraction) if callable(to) else fraction * to

        return at

    move = Move(list(setup.loads), [along(to) for to in setup.loads.values()], steps=count, cuts=8)
    result = solve(setup.model, move, frames=count)
    met = [frame for frame in result.frames if abs(frame.time * count - round(frame.time * count)) < 1e-6]
    states = [frame.points["displacement"] for frame in met]
    return {LOAD: marks} | {name: np.array([probe.read(u) for u in states]) for name, probe in setup.probes.items()}


def trace_arc(setup: Setup, fractions: ArrayLike, solve: Solve) -> dict[str, Floats]:
    """Follow the path of equilibria by its arc length, through maxima and minima of the load.

    Parameters
    ----------
    setup : Setup
        The model, unloaded; its loads go up in proportion.
    fractions : array_like
        Load fractions of the reference; the path is followed to the largest, or to full load.
    solve : callable
        As for :func:`trace`.

    Returns
    -------
    dict of str to ndarray
        Load fractions and probes at all increments, zero first.
    """
    loads = list(setup.loads)
    end = max(1.0, float(np.max(fractions)))
    full = [float(to) for to in setup.loads.values() if not callable(to)]
    rows = [[0.0] * (1 + len(setup.probes))]

    def keep(model: Model) -> bool:
        u = model.u.reshape(-1, 3)
        rows.append([loads[0].value / full[0], *(probe.read(u) for probe in setup.probes.values())])
        return False

    solve(setup.model, Arc(loads, [end * to for to in full], increment=0.04, grow=2.0, until=keep), frames=0)
    return dict(zip((LOAD, *setup.probes), np.array(rows).T, strict=True))

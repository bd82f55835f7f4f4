"""Timing of a run: seconds and calls of its parts, at the cost of two readings of the clock per call.

>>> timing = Timing()
>>> with timing.elements:
...     _ = sum(range(1000))
>>> timing.elements.calls
1
"""

from __future__ import annotations

import time as clock
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from types import TracebackType

from umform.attempts import Attempts


class Part:
    """Accumulates the time of its ``with`` blocks, which are never nested.

    Attributes
    ----------
    name : str
        For tables.
    seconds : float
        Wall time so far.
    calls : int
        Number of blocks so far.
    """

    __slots__ = ("_start", "calls", "name", "seconds")

    def __init__(self, name: str) -> None:
        self.name, self.seconds, self.calls, self._start = name, 0.0, 0, 0.0

    def __enter__(self) -> None:
        self._start = clock.perf_counter()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.seconds += clock.perf_counter() - self._start
        self.calls += 1


class Timing:
    """Seconds and calls of the parts of a run; parts are not nested, and all lie within `run` or in `files`.

    Attributes
    ----------
    run : Part
        The whole run: :func:`umform.solve`.
    elements : Part
        Residual and tangent of the elements with their scatter into the matrix; one call an evaluation.
    recovery : Part
        Enhanced parameters after an increment.
    contact : Part
        Facets against tools, and follower pressures.
    ties : Part
        Reduction of the matrix by the ties.
    analysis : Part
        Elimination order, once per pattern.
    factorisation, solve : Part
        Factorisation, and solution with the factors.
    output : Part
        Rows and frames of the result, checkpoints.
    files : Part
        Tables, fields, pictures and pages after the run.
    attempts : Attempts
        Evaluations, discarded ones, and strategies.
    """

    def __init__(self) -> None:
        self.run = Part("run")
        self.elements = Part("elements")
        self.recovery = Part("enhanced parameters")
        self.contact = Part("contact and pressure")
        self.ties = Part("reduction of ties")
        self.analysis = Part("analysis")
        self.factorisation = Part("factorisation")
        self.solve = Part("solve")
        self.output = Part("history, frames")
        self.files = Part("files")
        self.attempts = Attempts()

    @property
    def parts(self) -> list[Part]:
        """All parts of the run and the files, without the total."""
        return [part for name, part in self._clocks() if name != "run"]

    def _clocks(self) -> list[tuple[str, Part]]:
        return [(name, part) for name, part in vars(self).items() if isinstance(part, Part)]

    def of(self, name: str) -> Part:
        """The part with the name of an attribute."""
        part: Part = getattr(self, name)
        return part

    @property
    def total(self) -> float:
        """Seconds of run and files."""
        return self.run.seconds + self.files.seconds

    @property
    def rest(self) -> float:
        """Seconds of the run outside of all parts: Python code."""
        return self.total - sum(part.seconds for part in self.parts)

    def rows(self) -> list[tuple[str, float, float, int | None]]:
        """Name, seconds, fraction of the total and calls of each part that was called, and of the rest of Python."""
        whole = self.total or 1.0
        rows: list[tuple[str, float, float, int | None]] = [
            (part.name, part.seconds, part.seconds / whole, part.calls) for part in self.parts if part.calls
        ]
        return [*rows, ("rest of Python", self.rest, self.rest / whole, None)]

    def record(self) -> dict[str, dict[str, float]]:
        """Seconds and calls by the names of the attributes, for JSON."""
        parts = {name: {"seconds": part.seconds, "calls": part.calls} for name, part in self._clocks()}
        return {**parts, "rest": {"seconds": self.rest}}

    @classmethod
    def sum(cls, timings: Iterable[Timing]) -> Timing:
        """Sum of several runs."""
        whole = cls()
        for timing in timings:
            whole.attempts.add(timing.attempts)
            for (_, into), (_, part) in zip(whole._clocks(), timing._clocks(), strict=True):
                into.seconds += part.seconds
                into.calls += part.calls
        return whole


_listening: ContextVar[list[Timing] | None] = ContextVar("_listening", default=None)


@contextmanager
def timings() -> Iterator[list[Timing]]:
    """List the timings of all runs that begin in the ``with`` block, in this process."""
    found: list[Timing] = []
    token = _listening.set(found)
    try:
        yield found
    finally:
        _listening.reset(token)


def new_timing() -> Timing:
    """Timing of a new run, also passed to the observers."""
    timing = Timing()
    found = _listening.get()
    if found is not None:
        found.append(timing)
    return timing

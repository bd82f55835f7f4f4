"""Live data of a running job in a small file: progress, curve, section of the sheet."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from umform.analysis.steps import Release
from umform.bench.folders import LIVE
from umform.processes.air_bending.brake import force_per_width
from umform.processes.air_bending.branches import Brake
from umform.processes.air_bending.section import Section

if TYPE_CHECKING:
    from umform.analysis.steps.loop import Run
    from umform.results.history import History

#: Seconds between two files, at least.
_OFTEN = 0.1
#: Seconds before the first shape in space; those that follow take at most this part of the time.
_FIRST_SHAPE, _SHARE = 1.2, 0.05
#: Most points of a curve.
_MOST = 500
#: Shares of the work: loading, each unloading of a search, and what there is at most before the files are written.
_LOADING, _TRIAL, _BEFORE_FILES = 0.7, 0.08, 0.95


def write_live(folder: Path, content: dict[str, Any]) -> None:
    """Write the file in one step; it need not outlive the machine."""
    waiting = folder / f".{LIVE}.{os.getpid()}"
    waiting.write_text(json.dumps(content, allow_nan=False), encoding="utf-8")
    waiting.replace(folder / LIVE)


class Watch:
    """Writes down what a run has reached, between its increments.

    Parameters
    ----------
    folder : Path
        Folder of the job.
    title : str
        For the page of the shape.
    tell : callable
        Makes the part of the file that is of the process; ``fraction`` and ``phase`` are in it.
    """

    def __init__(self, folder: Path, title: str, tell: Callable[[Run], dict[str, Any]]) -> None:
        self.folder, self.title, self.tell = folder, title, tell
        self.content: dict[str, Any] = {"fraction": 0.0, "phase": "start", "increments": 0, "shape": 0}
        self._start = time.monotonic()
        self._next, self._next_shape = 0.0, self._start + _FIRST_SHAPE
        self._run: Run | None = None
        self._over = False

    def __call__(self, run: Run) -> None:
        """Look at a run between two increments; those of an error budget are none of the job's."""
        now = time.monotonic()
        if self._over:
            return
        self._run = run
        if now < self._next:
            return
        self._take(run)
        if now > self._next_shape and len(run.result) > 1:
            self.shape(run.result)
            self._next_shape = time.monotonic() + (time.monotonic() - now) / _SHARE
        self.write()
        self._next = time.monotonic() + _OFTEN

    def phase(self, name: str, fraction: float) -> None:
        """Begin another phase after the end of the run, and write the last increments."""
        self._over = True
        if self._run is not None:
            self._take(self._run)
            self._run = None
        self.content |= {"phase": name, "fraction": fraction}
        self.write()

    def shape(self, result: History) -> None:
        """Write the shape in space."""
        from umform.bench.shape import write_shape  # loads the report and its pictures: late

        write_shape(self.folder, result, self.title)
        self.content["shape"] += 1
        self.write()

    def _take(self, run: Run) -> None:
        content = {"increments": len(run.result) - 1, **self.tell(run)}
        content["fraction"] = max(content["fraction"], self.content["fraction"])
        self.content |= content

    def write(self) -> None:
        """Write the file now."""
        write_live(self.folder, self.content | {"seconds": round(time.monotonic() - self._start, 2)})


class BendTold:
    """Curve, section and progress of a bend on its brake."""

    def __init__(self, brake: Brake, angle: float | None, stroke: float | None) -> None:
        self.brake, self.angle, self.goal = brake, angle, stroke
        self._trials = 0
        self._back = False

    def __call__(self, run: Run) -> dict[str, Any]:
        """Live data of the present state."""
        brake, result = self.brake, run.result
        section = Section.of(run.model.mesh, run.model.u)
        back = bool(brake.run.steps) and isinstance(brake.run.steps[-1], Release)
        self._trials += back and not self._back
        self._back = back
        stroke = result["stroke"]
        force = force_per_width(brake.case, result["stroke_force"])
        thin = max(1, -(-len(stroke) // _MOST))
        return {
            "phase": "unloading" if back else "loading",
            "trial": self._trials,
            "fraction": self._fraction(float(stroke[-1]), section.angle),
            "stroke": round(float(stroke[-1]), 4),
            "angle": round(section.angle, 3),
            "force": round(float(force[-1]), 3),
            "curve": {"x": stroke[::thin].round(4).tolist(), "y": force[::thin].round(3).tolist()},
            "section": [section.fibre(height).round(4).tolist() for height in (0.0, 1.0)],
        }

    def _fraction(self, stroke: float, angle: float) -> float:
        if self._trials:
            return min(_BEFORE_FILES, _LOADING + _TRIAL * self._trials)
        done = stroke / self.goal if self.goal else (180.0 - angle) / (180.0 - (self.angle or 90.0))
        return _LOADING * min(1.0, max(0.0, done))


class DeckTold:
    """Curve and progress of the run of a deck."""

    def __init__(self, increments: int, steps: int) -> None:
        self.increments, self.steps = max(1, increments), max(1, steps)

    def __call__(self, run: Run) -> dict[str, Any]:
        """Live data of the present state."""
        result, number = run.result, min(run.number, self.steps)
        done = max((len(result) - 1) / self.increments, (number - 1) / self.steps)
        told: dict[str, Any] = {"phase": "loading", "fraction": min(_BEFORE_FILES, done)}
        told |= {"step": number, "steps": self.steps}
        if run.model.controls:
            name = run.model.controls[0].name
            x, y = result[name], result[f"{name}_force"]
            thin = max(1, -(-len(x) // _MOST))
            told["curve"] = {"x": x[::thin].tolist(), "y": y[::thin].tolist(), "names": [name, f"{name}_force"]}
        return told

"""Live data of a running job in a file: progress, curve, section of the sheet."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from umform.analysis.steps import Release
from umform.bench.folders import LIVE
from umform.processes.air_bending.brake import Brake
from umform.processes.air_bending.loading import force_per_width
from umform.processes.air_bending.section import Section
from umform.processes.air_bending.stack import edges_of
from umform.report.looks import UNKNOWN, Units
from umform.report.words import column_text
from umform.results.quantity import FORCE_PER_LENGTH

if TYPE_CHECKING:
    from umform.analysis.steps.run_state import Run
    from umform.results.history import History

#: Least number of seconds between two files.
_INTERVAL = 0.1
#: Seconds before the first 3D view; the next ones take at most this share of the time.
_FIRST_SHAPE, _SHARE = 1.2, 0.05
#: Largest number of points of a curve.
_MOST = 500
#: Progress after loading, of each unloading of a search, and at most before the files are written.
_LOADING, _TRIAL, _BEFORE_FILES = 0.7, 0.08, 0.95


def write_live(folder: Path, content: dict[str, Any]) -> None:
    """Write the file in one step; it is not flushed to the disk."""
    waiting = folder / f".{LIVE}.{os.getpid()}"
    waiting.write_text(json.dumps(content, allow_nan=False), encoding="utf-8")
    waiting.replace(folder / LIVE)


class Watch:
    """Writes the state of a run between its increments.

    Parameters
    ----------
    folder : Path
        Folder of the job.
    title : str
        For the page of the shape.
    progress : callable
        Returns the data of the process, with ``fraction`` and ``phase``.
    units : Units
        Names of the units, for the page of the shape.
    force : callable, optional
        Returns the force per length of a bend, which the page of the shape shows.
    """

    def __init__(
        self,
        folder: Path,
        title: str,
        progress: Callable[[Run], dict[str, Any]],
        *,
        units: Units = UNKNOWN,
        force: Callable[[History], NDArray[np.float64]] | None = None,
    ) -> None:
        self.folder, self.title, self.progress, self.units, self.force = folder, title, progress, units, force
        self.content: dict[str, Any] = {"fraction": 0.0, "phase": "start", "increments": 0, "shape": 0}
        self._start = time.monotonic()
        self._next, self._next_shape = 0.0, self._start + _FIRST_SHAPE
        self._run: Run | None = None
        self._finished = False

    def __call__(self, run: Run) -> None:
        """Write the state of a run; runs of an error budget are left out."""
        now = time.monotonic()
        if self._finished:
            return
        self._run = run
        if now < self._next:
            return
        self._update(run)
        if now > self._next_shape and len(run.result) > 1:
            self.shape(run.result)
            self._next_shape = time.monotonic() + (time.monotonic() - now) / _SHARE
        self.write()
        self._next = time.monotonic() + _INTERVAL

    def phase(self, name: str, fraction: float) -> None:
        """Start another phase after the end of the run, and write the last increments."""
        self._finished = True
        if self._run is not None:
            self._update(self._run)
            self._run = None
        self.content |= {"phase": name, "fraction": fraction}
        self.write()

    def shape(self, result: History) -> None:
        """Write the 3D view."""
        from umform.bench.shape import write_shape  # slow: it loads the report and its pictures

        more = {} if self.force is None else {f"force {FORCE_PER_LENGTH}": self.force(result)}
        write_shape(self.folder, result, self.title, units=self.units, more=more)
        self.content["shape"] += 1
        self.write()

    def _update(self, run: Run) -> None:
        content = {"increments": len(run.result) - 1, **self.progress(run)}
        content["fraction"] = max(content["fraction"], self.content["fraction"])
        self.content |= content

    def write(self) -> None:
        """Write the file now."""
        write_live(self.folder, self.content | {"seconds": round(time.monotonic() - self._start, 2)})


class BendProgress:
    """Curve, section and progress of a bend on its brake."""

    def __init__(self, brake: Brake, angle: float | None, stroke: float | None) -> None:
        self.brake, self.angle, self.goal = brake, angle, stroke
        self._trials = 0
        self._back = False

    def __call__(self, run: Run) -> dict[str, Any]:
        """Live data of the present state."""
        brake, result = self.brake, run.result
        section, top = (Section.of(run.model.mesh, run.model.u, edges_of(brake.case, group)) for group in (0, -1))
        back = bool(brake.run.steps) and isinstance(brake.run.steps[-1], Release)
        self._trials += back and not self._back
        self._back = back
        stroke = result["stroke"]
        force = self.force(result)
        thin = max(1, -(-len(stroke) // _MOST))
        return {
            "phase": "unloading" if back else "loading",
            "trial": self._trials,
            "fraction": self._fraction(float(stroke[-1]), section.angle),
            "stroke": round(float(stroke[-1]), 4),
            "angle": round(section.angle, 3),
            "force": round(float(force[-1]), 3),
            "curve": {"x": stroke[::thin].round(4).tolist(), "y": force[::thin].round(3).tolist()},
            "section": [face.round(4).tolist() for face in (section.fibre(0.0), top.fibre(1.0))],
        }

    def force(self, result: History) -> NDArray[np.float64]:
        """Force per length of bend."""
        return force_per_width(self.brake.case, result["stroke_force"])

    def _fraction(self, stroke: float, angle: float) -> float:
        if self._trials:
            return min(_BEFORE_FILES, _LOADING + _TRIAL * self._trials)
        done = stroke / self.goal if self.goal else (180.0 - angle) / (180.0 - (self.angle or 90.0))
        return _LOADING * min(1.0, max(0.0, done))


class DeckProgress:
    """Curve and progress of the run of a deck."""

    def __init__(self, increments: int, steps: int) -> None:
        self.increments, self.steps = max(1, increments), max(1, steps)

    def __call__(self, run: Run) -> dict[str, Any]:
        """Live data of the present state."""
        result, number = run.result, min(run.number, self.steps)
        done = max((len(result) - 1) / self.increments, (number - 1) / self.steps)
        content: dict[str, Any] = {"phase": "loading", "fraction": min(_BEFORE_FILES, done)}
        content |= {"step": number, "steps": self.steps}
        if run.model.controls:
            name = run.model.controls[0].name
            x, y = result[name], result[f"{name}_force"]
            thin = max(1, -(-len(x) // _MOST))
            content["curve"] = {
                "x": x[::thin].tolist(),
                "y": y[::thin].tolist(),
                "names": [column_text(name), column_text(f"{name}_force")],
            }
        return content

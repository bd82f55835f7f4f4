"""Jobs that draw a part, by the calls of `umform draw`, and the sketch of their tools."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from umform.analysis.run.observers import watching
from umform.bench.folders import RESULTS
from umform.bench.live import Watch
from umform.bench.wanted import Wanted
from umform.io.staging import staging
from umform.processes.draw.cup import Cup
from umform.processes.draw.files import FILES, record, write_files
from umform.processes.draw.u_bend import UBend
from umform.processes.early_end import what_was_reached

if TYPE_CHECKING:
    from umform.analysis.steps.run_state import Run

#: Entries of a record that the page shows.
_SHOWN = ("ending", "about_errors", "quantities", "checks", "warnings", "increments", "seconds")
#: Progress at the end of the stroke, and at most before the files are written.
_DRAWN, _BEFORE_FILES = 0.85, 0.95
#: Largest number of points of a curve.
_MOST = 300
#: Points of a quarter of a circle of the sketch.
_ARC = 12


def run_draw(folder: Path, title: str, wanted: Wanted) -> dict[str, Any]:
    """Draw a part and write its files; one that tears, wrinkles or is stopped has its results up to there.

    Parameters
    ----------
    folder : Path
        Folder of the job.
    title : str
        For the page of the shape.
    wanted : Wanted
        The form.

    Returns
    -------
    dict
        The summary of the page.
    """
    from umform.processes.draw.case import draw

    case, note = wanted.draw(), wanted.law()[1]
    watch = Watch(folder, title, DrawProgress(case))
    results = folder / RESULTS
    with staging(results, FILES):
        with watching(watch), what_was_reached(results, "draw.vtkhdf"):
            drawn = draw(case, progress=False)
        watch.phase("files", _BEFORE_FILES)
        watch.shape(drawn.result)
        write_files(results, drawn, note)
    watch.phase("end", 1.0)
    found = record(drawn)
    return {"note": note, "unfinished": drawn.released is None, **{name: found[name] for name in _SHOWN}}


class DrawProgress:
    """Curve and progress of a drawn part."""

    def __init__(self, case: Cup | UBend) -> None:
        self.case = case
        self.curve: dict[str, list[float]] = {"x": [], "y": []}

    def __call__(self, run: Run) -> dict[str, Any]:
        """Live data of the present state."""
        stroke = run.result["stroke"]
        opening = float(stroke[0]) > 0.0  # the run that opens the tools begins at the end of the stroke
        if not opening:
            force = 1e-3 * self.case.parts * np.abs(run.result["punch_fz"])
            thin = max(1, -(-len(stroke) // _MOST))
            self.curve = {"x": stroke[::thin].round(3).tolist(), "y": force[::thin].round(3).tolist()}
        return {
            "phase": "opening" if opening else "drawing",
            "fraction": _DRAWN * min(1.0, float(stroke.max()) / self.case.way),
            "stroke": round(float(stroke[-1]), 3),
            "curve": {**self.curve, "of": "draw"},
        }


def facts(case: Cup | UBend) -> dict[str, Any]:
    """Ratios that a toolmaker looks at first: drawing ratio, gap beside the punch, pressure of the holder."""
    if isinstance(case, Cup):
        ratio: float | None = case.blank_radius / case.punch_radius
        flange = math.pi * (case.blank_radius**2 - (case.throat + case.die_edge) ** 2)
        height: float | None = case.constant_thickness_height
    else:
        ratio, height = None, None
        flange = case.width * (case.length - case.throat - 2.0 * case.die_edge)
    pressure = case.holder_force / flange if case.holder_force and flange > 0.0 else None
    return {"ratio": ratio, "gap": case.clearance, "pressure": pressure, "stroke": case.way, "height": height}


def follow(case: Cup | UBend) -> dict[str, float]:
    """Values of empty fields of the form, by their names."""
    if isinstance(case, Cup):
        found = {"cup_opening": 2.0 * case.throat, "cup_holder_gap": case.gap, "cup_stroke": case.way}
    else:
        found = {"u_opening": case.throat, "u_stroke": case.way}
    return {name: round(value, 3) for name, value in found.items()}


def sketch(case: Cup | UBend) -> dict[str, Any]:
    """Section of tools and blank where the punch touches the sheet, to scale; z = 0 is the top of the die."""
    t, half = case.thickness, case.blank_radius if isinstance(case, Cup) else 0.5 * case.length
    punch = case.punch_radius if isinstance(case, Cup) else 0.5 * case.punch_width
    throat = case.throat if isinstance(case, Cup) else 0.5 * case.throat
    gap = case.gap if isinstance(case, Cup) else t
    far, deep = 1.08 * max(half, throat + 2.0 * case.die_edge), case.way + 2.0 * t
    high = max(0.4 * case.way, 3.0 * case.punch_edge, 6.0 * t)
    edge, nose = case.die_edge, case.punch_edge
    die = [(far, 0.0), *_arc((throat + edge, -edge), edge, 90.0, 180.0), (throat, -deep), (far, -deep)]
    inner = max(throat, punch + 0.5 * t)
    holder = [(far, gap), (inner, gap), (inner, gap + 0.6 * high), (far, gap + 0.6 * high)]
    side = [*_arc((punch - nose, t + nose), nose, 270.0, 360.0), (punch, t + high)]
    return {
        "kind": "draw",
        "tools": [_closed(die), _closed(_mirrored(die)), _closed(holder), _closed(_mirrored(holder)),
                  _closed([*_mirrored(side), *side])],
        "sheet": _closed([(-half, 0.0), (half, 0.0), (half, t), (-half, t)]),
        "box": [-far, far, -deep, t + high],
        "sizes": [
            {"text": 2.0 * half, "from": [-half, 0.0], "to": [half, 0.0], "name": "blank"},
            {"text": 2.0 * punch, "from": [-punch, 0.0], "to": [punch, 0.0], "name": "punch"},
            {"text": 2.0 * throat, "from": [-throat, 0.0], "to": [throat, 0.0], "name": "opening"},
        ],
        "round": isinstance(case, Cup),
        "thickness": t,
    }  # fmt: skip


def _arc(centre: tuple[float, float], radius: float, first: float, last: float) -> list[tuple[float, float]]:
    """Points of an arc, angles in degrees from x to z."""
    angles = np.radians(np.linspace(first, last, _ARC + 1))
    return [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in angles]


def _mirrored(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    return [(-x, z) for x, z in reversed(points)]


def _closed(points: list[tuple[float, float]]) -> list[list[float]]:
    return [[round(x, 4), round(z, 4)] for x, z in points]

"""The files of a part: numbers, profile, curves, fields, pictures, report."""

from __future__ import annotations

import math
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.io.staging import staging
from umform.io.tables import write_csv, write_json
from umform.processes.air_bending.files import parameters
from umform.processes.air_bending.remarks import coarse_mesh
from umform.processes.bend_sequence.part import BendDone, Part
from umform.processes.bend_sequence.spec import MOST_BENDS
from umform.report.versions import versions
from umform.results.outcome import QUANTITIES
from umform.results.quantity import FORCE_PER_LENGTH, quantities_of, values

_DATA = ("sequence.json", QUANTITIES, "profile.csv", "curves.csv", "part.vtkhdf")
_PICTURES = ("part.png", "part.svg")
_PAGE = "report.html"
_DECKS = tuple(f"bend{number}.toml" for number in range(1, MOST_BENDS + 1))
#: Files of a part.
FILES = (*_DATA, *_DECKS, *_PICTURES, _PAGE)
#: Those, and what a run that ends early leaves.
RESULTS = (*FILES, "history.csv", *(f"bend{number}.csv" for number in range(1, MOST_BENDS + 1)))


def write_files(out: str | Path, part: Part, note: str = "") -> list[Path]:
    """Write all files of a part.

    Parameters
    ----------
    out : str or Path
        Folder for sequence.json, quantities.csv, profile.csv, curves.csv, part.vtkhdf (the last bend), part.png,
        part.svg and report.html; bend1.toml, ... are decks of the bends.
    part : Part
        The part.
    note : str
        Source of the material data; may be empty.
    """
    from umform.plotting import save
    from umform.processes.bend_sequence.page import write_page
    from umform.processes.bend_sequence.pictures import picture

    with staging(out, FILES) as stage:
        here = stage.waiting
        write_json(here / "sequence.json", record(part) | {"note": note})
        part.write(here)
        write_csv(here / "profile.csv", {"x": part.profile[:, 0], "z": part.profile[:, 1]})
        number = np.concatenate([np.full(len(done.stroke), k) for k, done in enumerate(part.bends, start=1)])
        stroke, force = (np.concatenate([getattr(done, name) for done in part.bends]) for name in ("stroke", "force"))
        write_csv(here / "curves.csv", {"bend": number, "stroke mm": stroke, f"force {FORCE_PER_LENGTH}": force})
        part.bends[-1].result.write(here / "part.vtkhdf")
        decks = part.decks()
        for name, text in decks.items():
            (here / name).write_text(text, encoding="utf-8")
        files = stage.commit([*_DATA, *decks])
        figure = picture(part)
        for name in _PICTURES:
            save(figure, here / name)
        write_page(here / _PAGE, part, figure, note)
        return [*files, *stage.commit([*_PICTURES, _PAGE])]


def record(part: Part) -> dict[str, Any]:
    """Parameters and results as JSON data; None for unknown values.

    ``profile`` and ``outline`` are lists of [x, z]: the part with its first leg on x, and the part in the tools of a
    bend (die at z = 0, bend line at x = 0, punch tip at thickness - stroke) with stroke 0 and with the largest one.
    """
    sequence = part.sequence
    return {
        "parameters": {
            "length": sequence.length,
            "sheet": parameters(sequence.sheet),
            "bodies": asdict(sequence.bodies),
            "bends": [
                {
                    "position": bend.position,
                    "angle": bend.angle,
                    "stroke": bend.stroke,
                    "direction": bend.direction,
                    "tools": dict(bend.tools),
                }
                for bend in sequence.bends
            ],
        },
        "bends": [_bend(done, angle) for done, angle in zip(part.bends, part.angles, strict=True)],
        "flanges": part.flanges,
        "length_balance": _number(part.length_balance),
        "profile": _points(part.profile),
        **part.record(),
        "collisions": part.collisions,
        "coarse_mesh": coarse_mesh(sequence.sheet),
        "versions": versions(),
    }


def _bend(done: BendDone, angle: float) -> dict[str, Any]:
    """One bend."""
    loaded = max(done.states[:-1] or done.states, key=lambda state: state[0])
    return {
        "measures": values(quantities_of(done.measures)),
        "final_angle": _number(angle),
        "collisions": [asdict(hit) for hit in done.collisions],
        "trials": [list(trial) for trial in done.trials],
        "curve": {"stroke": done.stroke.tolist(), "force": done.force.tolist()},
        "outline": {
            name: {"stroke": stroke, "points": _points(strip.outline)}
            for name, (stroke, strip) in {"before": done.states[0], "loaded": loaded}.items()
        },
        "warnings": list(done.warnings),
    }


def _points(points: NDArray[np.float64]) -> list[list[float]]:
    return [[float(value) for value in row] for row in np.round(points, 4)]


def _number(value: float) -> float | None:
    return None if math.isnan(value) else float(value)

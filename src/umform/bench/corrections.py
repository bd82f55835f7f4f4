"""Jobs that correct a metal by one measured bend, by the calls of `umform bend correct`."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from umform.bench.bend_tables import computed_table, rows_of, written
from umform.bench.folders import METAL, RESULTS, TABLE
from umform.bench.live import write_live
from umform.bench.shelf import Shelf
from umform.bench.wanted import Wanted
from umform.io.staging import staging
from umform.materials import J2, Metal
from umform.problem.metal_file import write_metal
from umform.processes.air_bending.search import find_stroke
from umform.processes.air_bending.spec import AirBending
from umform.results.quantity import quantities_of
from umform.studies.bend_table import Corrected, Setup, correct
from umform.studies.bend_table.formats.table_json import issued

#: Progress after the correction, and after the bend with it.
_CORRECTED, _BENT = 0.5, 0.7
#: Plastic strains of the flow curves that are shown.
_STRAINS = np.linspace(0.0, 0.5, 101)


def run_correction(folder: Path, wanted: Wanted) -> dict[str, Any]:
    """Correct the metal of a measured bend; bend to the wanted angle with it, and issue a table again.

    Parameters
    ----------
    folder : Path
        Folder of the job.
    wanted : Wanted
        The form.

    Returns
    -------
    dict
        The summary of the page.
    """
    case, (law, note), measured = wanted.case(Shelf(folder)), wanted.law(), wanted.measured
    name, angle, results = wanted.choices.material, wanted.goal.angle, folder / RESULTS
    assert measured.measured_angle is not None

    def say(phase: str, fraction: float) -> None:
        write_live(folder, {"phase": phase, "fraction": fraction, "shape": 0})

    def search(name: str, fraction: float, detail: str = "", /) -> None:
        runs[0] += fraction >= 1.0
        say("correcting", _CORRECTED * (1.0 - 0.8 ** runs[0]))

    runs = [0]
    say("correcting", 0.0)
    numbers = {"force": measured.measured_force, "radius": measured.measured_radius}
    known = {key: value for key, value in numbers.items() if value is not None}
    done = correct(case, measured.measured_angle, **known, name=name, progress=search)
    with staging(results, [METAL]):
        write_metal(results / METAL, done.law, [*done.notes, note])
    summary: dict[str, Any] = {
        "corrected": _factors(done),
        "notes": list(done.notes),
        "misfit": _finite(done.found.fit.misfit),
        "curves": [_curve(one) for one in (law, done.law)],
    }
    if angle is not None:
        say("loading", _CORRECTED)
        summary["bends"] = [_bend(case, one, angle, wanted.goal.tolerance) for one in (law, done.law)]
    if (folder / TABLE).is_file():
        summary |= _again(folder, name, law, done)
    return summary


def _factors(done: Corrected) -> list[dict[str, Any]]:
    found = done.found
    return [
        {"name": name, "value": value, "error": _finite(found.deviations[name])} for name, value in found.values.items()
    ]


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _curve(law: J2 | Metal) -> dict[str, list[float]]:
    """The flow curve of a law in MPa over the plastic strain."""
    assert law.hardening is not None
    curve = law.hardening.curve()
    return {"x": _STRAINS.tolist(), "y": [float(curve(strain)[0]) for strain in _STRAINS]}


def _bend(case: AirBending, law: J2 | Metal, angle: float, tolerance: float) -> list[dict[str, Any]]:
    """Numbers of the bend to the wanted angle of a law."""
    found = find_stroke(replace(case, material=law, stroke=None), angle, tolerance=tolerance, progress=False)
    return [one.record() for one in quantities_of(found.bend.measures)]


def _again(folder: Path, name: str, law: J2 | Metal, done: Corrected) -> dict[str, Any]:
    """The table of another job with the law of the card, whose bends are stored, and with the corrected one."""
    before = issued(folder / TABLE)
    own = [AirBending(**parameters, material=law) for metal, parameters in before.setups if metal == name]
    first = [Setup(name, case) for case in own]
    second = [Setup(f"{name}-corrected", replace(case, material=done.law)) for case in own]
    old = computed_table(folder, first, before.angles, check=False, begin=_BENT)
    new = computed_table(folder, second, before.angles, check=before.checked, notes=done.notes, begin=_BENT)
    return written(folder, new) | {"table": rows_of(new), "table_before": rows_of(old)}

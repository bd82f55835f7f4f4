"""Jobs that bend a strip more than once: several bends in one part, a hem."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.bench.folders import RESULTS
from umform.bench.live import Watch
from umform.bench.live_strips import StripTold
from umform.bench.wanted import Wanted
from umform.io.staging import staging
from umform.io.tables import write_csv, write_json
from umform.processes.air_bending.files import parameters
from umform.processes.air_bending.parameters import AirBending
from umform.processes.bend_sequence import Part, bend_sequence
from umform.processes.hemming import Hem, Hemming, hemming
from umform.run.watching import watching

#: Files of such a job.
FILES = ("part.json", "profile.csv", "curve.csv")
#: Most points of an outline on the page.
_MOST = 400


def run_strip(folder: Path, title: str, wanted: Wanted, sheet: AirBending) -> dict[str, Any]:
    """Bend a strip as it is wanted, and write what comes out of it.

    Parameters
    ----------
    folder : Path
        Folder of the job.
    title : str
        For the page of the shape.
    wanted : Wanted
        The form, of a part with several bends or of a hem.
    sheet : AirBending
        Sheet and tools.

    Returns
    -------
    dict
        What the page shows; in ``part.json`` with all digits too.
    """
    case = wanted.strip(sheet)
    first = case.first if isinstance(case, Hemming) else case
    watch = Watch(folder, title, StripTold(first, hem=isinstance(case, Hemming)))
    with staging(folder / RESULTS, FILES) as stage, watching(watch):
        done: Hem | Part = (
            hemming(case, progress=False) if isinstance(case, Hemming) else bend_sequence(case, progress=False)
        )
        watch.phase("files", 0.95)
        watch.shape(done.result if isinstance(done, Hem) else done.bends[-1].result)
        summary = _of_hem(done) if isinstance(done, Hem) else _of_part(done)
        profile = done.profile
        write_json(stage.waiting / "part.json", summary | {"sheet": parameters(sheet)})
        write_csv(stage.waiting / "profile.csv", {"x": profile[:, 0], "z": profile[:, 1]})
        write_csv(stage.waiting / "curve.csv", _curves(done))
        stage.commit(FILES)
    watch.phase("end", 1.0)
    thin = max(1, -(-len(profile) // _MOST))
    return summary | {"profile": profile[::thin].round(4).tolist()}


def _of_part(part: Part) -> dict[str, Any]:
    rows = [
        {"position": done.bend.position, "wanted": done.bend.angle, "over": done.bend.over, "final_angle": angle}
        | told(asdict(done.measures))
        for done, angle in zip(part.bends, part.angles, strict=True)
    ]
    return {
        "bends": rows,
        "flanges": part.flanges,
        "flat_length": part.sequence.length,
        "length_balance": part.length_balance,
        "warnings": part.warnings,
        "seconds": sum(done.result.seconds for done in part.bends),
    }


def _of_hem(hem: Hem) -> dict[str, Any]:
    first = hem.first.bends[0]
    return {
        "hem": told(asdict(hem.measures)),
        "first": told(asdict(first.measures)),
        "flat_length": hem.case.flange + hem.case.base,
        "warnings": list(hem.warnings),
        "seconds": first.result.seconds + hem.result.seconds,
    }


def told(numbers: Mapping[str, float]) -> dict[str, float | None]:
    """Numbers by name, None for one that cannot be told."""
    return {name: None if math.isnan(number) else number for name, number in numbers.items()}


def _curves(done: Hem | Part) -> dict[str, NDArray[np.float64]]:
    """Way and force of each operation, one below the other."""
    pairs = list(_operations(done))
    count = np.concatenate([np.full(len(stroke), number + 1.0) for number, (stroke, _) in enumerate(pairs)])
    stroke, force = (np.concatenate(columns) for columns in zip(*pairs, strict=True))
    return {"operation": count, "stroke": stroke, "force": force}


def _operations(done: Hem | Part) -> Iterator[tuple[NDArray[np.float64], NDArray[np.float64]]]:
    part = done.first if isinstance(done, Hem) else done
    yield from ((one.stroke, one.force) for one in part.bends)
    if isinstance(done, Hem):
        yield done.stroke, done.force

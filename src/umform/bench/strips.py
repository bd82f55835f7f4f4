"""Jobs with a whole strip: several bends in one part, or a hem, by the calls of `umform bend` and `umform hem`."""

from __future__ import annotations

from itertools import chain
from pathlib import Path
from typing import Any

from umform.analysis.run.observers import watching
from umform.bench.folders import RESULTS
from umform.bench.forces import computed_forces, largest, largest_of
from umform.bench.live import Watch, write_live
from umform.bench.live_strips import StripProgress
from umform.bench.wanted import Wanted
from umform.io.staging import staging
from umform.processes.air_bending.formulas import shop_forces
from umform.processes.air_bending.spec import AirBending
from umform.processes.bend_sequence import BendSequence, Part, bend_sequence
from umform.processes.bend_sequence import files as part_files
from umform.processes.early_end import what_was_reached
from umform.processes.hemming import Hem, Hemming, hemming
from umform.processes.hemming import files as hem_files
from umform.report.looks import MILLIMETRES

#: Files of such jobs.
FILES = (*part_files.RESULTS, *hem_files.RESULTS)
#: Largest number of points of a profile on the page.
_MOST = 400
#: Entries of a record that the page shows unchanged.
_AS_IT_IS = (
    "collisions",
    "coarse_mesh",
    "flanges",
    "length_balance",
    "increments",
    "warnings",
    "seconds",
    "contacts",
    "balance",
    "quantities",
    "checks",
)


def run_strip(folder: Path, title: str, wanted: Wanted, sheet: AirBending, note: str) -> dict[str, Any]:
    """Bend a strip and write its results.

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
    note : str
        Source of the material.

    Returns
    -------
    dict
        The summary of the page.
    """
    if wanted.choices.work == "outside":
        write_live(folder, {"phase": "bends", "fraction": 0.02, "increments": 0, "shape": 0})
        case: BendSequence | Hemming = wanted.developed(sheet).sequence(sheet)
    else:
        case = wanted.strip(sheet)
    hems = isinstance(case, Hemming)
    progress = StripProgress(case)
    watch = Watch(folder, title, progress, units=MILLIMETRES, force=progress.force)
    results = folder / RESULTS
    with staging(results, hem_files.FILES if hems else part_files.FILES), watching(watch):
        with what_was_reached(results, "hem.vtkhdf" if hems else "part.vtkhdf"):
            done = hemming(case, progress=False) if isinstance(case, Hemming) else bend_sequence(case, progress=False)
        watch.phase("files", 0.95)
        watch.shape(done.result if isinstance(done, Hem) else done.bends[-1].result)
        if isinstance(done, Hem):
            hem_files.write_files(results, done, note)
        else:
            part_files.write_files(results, done, note)
    watch.phase("end", 1.0)
    part = done.first if isinstance(done, Hem) else done
    forces = {"bend": largest_of(chain.from_iterable(part.of_bends.values()))}
    if isinstance(done, Hem):
        forces["flatten"] = largest_of(done.quantities)
    needed = largest(computed_forces(wanted, sheet, forces)).over(wanted.choices.length)
    if isinstance(done, Hem):
        return _of_hem(done) | {"press": needed}
    return _of_part(done) | {"press": needed, "shop_forces": list(shop_forces(sheet))}


def _of_part(part: Part) -> dict[str, Any]:
    record = part_files.record(part)
    bends = [
        {"position": given["position"], "wanted": given["angle"], "over": given["direction"] == "down"}
        | {"final_angle": found["final_angle"], **found["measures"]}
        for given, found in zip(record["parameters"]["bends"], record["bends"], strict=True)
    ]
    columns = [[one.record() for one in column] for column in part.of_bends.values()]
    sizes = [one.record() for one in part.of_part]
    return {"bends": bends, "columns": columns, "sizes": sizes, "flat_length": part.sequence.length, **_shown(record)}


def _of_hem(hem: Hem) -> dict[str, Any]:
    record = hem_files.record(hem)
    return {"hem": record["measures"], "first": record["first"], **_shown(record)}


def _shown(record: dict[str, Any]) -> dict[str, Any]:
    """The common entries of records, and the profile with fewer points."""
    thin = max(1, -(-len(record["profile"]) // _MOST))
    shown = {name: record[name] for name in _AS_IT_IS if name in record}
    return shown | {"profile": record["profile"][::thin]}

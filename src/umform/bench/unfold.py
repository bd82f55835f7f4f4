"""Jobs that unfold a part, by the calls of `umform flat`."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from umform.bench.folders import RESULTS
from umform.bench.live import write_live
from umform.bench.wanted import Wanted
from umform.errors import UmformError
from umform.flat_pattern import FILES, Allowance, AllowanceProvider, ComputedBends, KFactor, Orders, bend_part, flat
from umform.flat_pattern.bending import BentPart
from umform.flat_pattern.files import record, write_files
from umform.io.staging import staging
from umform.io.store import Store
from umform.processes.bend_sequence import Bodies

#: Progress after the bends, and before the files are written.
_BENDS, _BEFORE_FILES = 0.8, 0.95


def run_flat(folder: Path, wanted: Wanted, part: Mapping[str, Any]) -> dict[str, Any]:
    """Unfold the part of a job, which has a copy of it, and write its files.

    Parameters
    ----------
    folder : Path
        Folder of the job.
    wanted : Wanted
        The form.
    part : mapping
        The row of the part in `Parts`.

    Returns
    -------
    dict
        The summary of the page.
    """
    name, k = wanted.values["part"], wanted.values["k_factor"]
    try:
        thickness = float(part["thickness"])
        tooling, bodies = wanted.tooling(thickness), Bodies()
        provider: AllowanceProvider = ComputedBends(tooling, Store()) if k is None else KFactor(k)
        watched = _Watched(folder, provider, len(part["bends"]))
        pattern = flat(folder / name, allowance=watched, tooling=tooling, bodies=bodies)
        orders = Orders(pattern, tooling, bodies)
        bent: BentPart | None = None
        if wanted.values["simulated"]:
            write_live(folder, watched.content("simulation", _BENDS))
            bent = bend_part(orders, progress=watched.simulated)
        write_live(folder, watched.content("files", _BEFORE_FILES))
        with staging(folder / RESULTS, FILES):
            write_files(folder / RESULTS, orders, bent, wanted.law(thickness)[1])
    except UmformError as error:
        error.where = name if str(folder) in error.where else error.where
        raise
    found = record(orders, bent)
    found.pop("versions")
    collisions = [] if bent is None else bent.part.collisions
    forces = [step["force"] for step in found["steps"] if step["force"] is not None]
    return {
        "flat": found,
        "collisions": collisions,
        "press": max(forces, default=None),
        "prismatic": orders.is_prismatic,
    }


class _Watched:
    """Lengths of bends, with the progress of the job in its folder."""

    def __init__(self, folder: Path, provider: AllowanceProvider, count: int) -> None:
        self.folder, self.provider, self.count = folder, provider, max(1, count)
        self.done = 0

    def __call__(self, angle: float, radius: float, thickness: float) -> Allowance:
        """The length of a bend."""
        write_live(self.folder, self.content("bends", _BENDS * min(1.0, self.done / self.count)))
        self.done += 1
        return self.provider(angle, radius, thickness)

    def simulated(self, name: str, fraction: float, detail: str = "", /) -> None:
        """Progress of the simulation of the whole part."""
        if re.search(r"\d", name):
            number = int(re.findall(r"\d+", name)[0])
            done = min(1.0, (number - 1 + fraction) / self.count)
            write_live(self.folder, self.content("simulation", _BENDS + (_BEFORE_FILES - _BENDS) * done))

    def content(self, phase: str, fraction: float) -> dict[str, Any]:
        """Live data."""
        return {
            "phase": phase,
            "fraction": fraction,
            "done": min(self.done, self.count),
            "count": self.count,
            "shape": 1,
        }

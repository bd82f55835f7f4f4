"""Balances of the jobs of the corpus: forces, moments, energies, volume, penetration, symmetry, work of each tool.

python benchmarks/balances.py --json build/balances.json --page docs/balances.md
python benchmarks/balances.py --job "wiping, augmented"
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np

import record
import umform as uf
from balances_page import page, summary
from corpus import JOBS, Watched
from corpus.answers import Answer
from imbalance import FORCES, largest_drift
from umform.model.tools.tool_controls import ToolMotion
from umform.results.penetration import penetrations


@dataclass(frozen=True)
class Limit:
    """The largest value of a quantity, what it is, and why the limit is that."""

    most: float
    what: str
    why: str


#: Part to which a drift falls, with increments of half the size, if it falls with their square: a quarter, and some
#: room for points that touch in another increment.
SECOND_ORDER = 0.35
#: All limits, by the names of the quantities.
LIMITS = {
    "forces": Limit(FORCES, "resultant of all external forces over their magnitudes", "what Newton's method leaves"),
    "moments": Limit(FORCES, "resultant of their moments", "the same"),
    "energies": Limit(
        0.005,
        "work less energies over the largest energy (drift)",
        "the promise for default increments; where a job gives a number of increments, a larger drift must fall with "
        f"their square: with twice as many to {SECOND_ORDER:g} of it",
    ),
    "volume of the law": Limit(1e-9, "volume by the strains less that by the mean stress", "round-off"),
    "volume of the mesh": Limit(
        0.002,
        "volume of the mesh less that by the mean stress",
        "plastic flow keeps the volume; what the assumed and enhanced strains of coarse meshes may add",
    ),
    "penetration": Limit(1.01, "largest penetration over the allowed one", "the promise, and 1 % as in the warning"),
    "symmetry": Limit(
        1e-3,
        "answer less its image, or less that of the reflected or scaled job, over the largest displacement",
        "staggered heights belong to the numbering of a cell and are no images of each other: the error of the rule; "
        "scaled jobs have the same bits",
    ),
    "tools": Limit(FORCES, "sum of the forces of tools that carry each other, over the largest", "as forces"),
    "work of tools": Limit(
        1e-6,
        "work of a tool by its column of forces less that in the balance, and their sum less the external work",
        "both are trapezoids over the same rows; forces of pressed tools are as exact as Newton's method",
    ),
    "trim": Limit(0.0, "elastic energy that a cut adds, over that before", "metal cut off has no negative energy"),
}


@dataclass(frozen=True)
class Known:
    """A limit that a job misses for a known reason, and how far it may."""

    quantity: str
    job: str
    most: float
    cause: str


_SHARP = (
    "sharp bends: the thickness strain is a Green-Lagrange strain, so the thickness of the mesh is the root mean "
    "square of the thickness stretches; a cell of curvature k in the reference is larger by (k t)^2 / 8"
)
KNOWN = (
    Known("volume of the mesh", "air bend, DP600, 18 nodes", 0.006, _SHARP),
    Known("volume of the mesh", "bottoming, 88 degrees", 0.009, _SHARP),
    Known("volume of the mesh", "hem, over an insert", 0.015, _SHARP),
    Known(
        "volume of the mesh", "bulge, unloaded", 0.011, "three by six elements over a clamped edge that bends sharply"
    ),
    Known(
        "volume of the law",
        "trim, edge on the line, on a bend",
        8e-4,
        "new elements across the bend cut the corner between two chords: their total strain differs from that of the "
        "metal, also in its trace, and all of the difference is plastic (docs/theory, 1.7)",
    ),
)
#: Jobs that the ordinary tests run: cheap ones of many kinds.
SAMPLE = (
    "air bend, DC04",
    "air bend, DP600, 18 nodes",
    "bottoming, 8 nodes",
    "two bends, one after the other",
    "L-bend with pad, pad at a gap, no friction",
    "turning tool, friction 0.1",
    "press, cup of aluminium",
    "bulge, unloaded",
    "plate, on a ring under a plunger, augmented",
    "wide strip, both halves",
    "arch, over two limit points",
    "bend and free, 18 nodes",
)


def works(result: uf.Result) -> float:
    """Largest difference of the work of a tool by its controls from that of the balance, over the external work."""
    balance = result.balance()
    scale, off = float(np.abs(balance.external_work).max()), 0.0
    for tool in result.model.tools:
        own = [control for control in result.model.controls if getattr(control, "tool", None) is tool]
        if own and all(isinstance(control, ToolMotion) for control in own):
            off = max(off, abs(sum(_work(result, control) for control in own) - balance.works[tool.name][-1]))
    if not any(name.endswith("_left") for name in result.columns()):  # an opened tool keeps the energy of its contact
        begun = balance.external_work[-1] - balance.external_work[0]
        off = max(off, abs(sum(work[-1] for work in balance.works.values()) - begun))
    return off / scale if scale else 0.0


def _work(result: uf.Result, control: Any) -> float:
    """Integral of the force of a control over its value, by trapezoids."""
    return float(np.trapezoid(result[f"{control.name}_force"], result[control.name]))


def penetration(result: uf.Result) -> float:
    """Largest penetration over the allowed one; zero where nothing is promised."""
    promised = [pair.name for pair in result.model.contacts if pair.allowed is not None]
    found = penetrations(result.model, result)
    return max((found[name].reached / found[name].allowed for name in promised), default=0.0)


def measured(answer: Answer) -> dict[str, float]:
    """All quantities of a job that it has."""
    results = answer.results
    force, moment = np.max([result.balance().largest_imbalances for result in results], axis=0).tolist()
    volumes = [result.volume_change() for result in results]
    found = {
        "forces": force,
        "moments": moment,
        "energies": largest_drift(results),
        "volume of the law": max(abs(volume.strain - volume.elastic) for volume in volumes),
        "volume of the mesh": max(abs(volume.mesh - volume.elastic) for volume in volumes),
        "penetration": max(map(penetration, results)),
        "work of tools": max(map(works, results)),
        **{name: max(values) for name, values in (("symmetry", answer.symmetry), ("tools", answer.tools)) if values},
        **({} if answer.trim is None else {"trim": answer.trim}),
    }
    return {name: value for name, value in found.items() if not np.isnan(value)}


def watch(job: Watched) -> dict[str, Any]:
    """Run a job, and say what it gave and what misses its limit."""
    uf.set_threads(1)
    start = time.process_time()
    try:
        answer = job.run()
        found = measured(answer)
        misses = [name for name, value in found.items() if not _kept(job, name, value)]
        increments = sum(len(result) - 1 for result in answer.results)
        ended = ""
    except uf.UmformError as error:
        found, misses, increments, ended = {}, ["end"], 0, " ".join(str(error).split())
    seconds = round(time.process_time() - start, 1)
    return {
        "name": job.name,
        "kind": job.kind,
        "CPU s": seconds,
        "increments": increments,
        "found": found,
        "misses": misses,
        "error": ended,
    }


def _kept(job: Watched, name: str, value: float) -> bool:
    """Whether a quantity of a job is within its limit, or misses it as far as is known."""
    known = max((one.most for one in KNOWN if (one.quantity, one.job) == (name, job.name)), default=0.0)
    return value <= max(LIMITS[name].most, known) or (name == "energies" and _falls(job, value))


def _falls(job: Watched, drift: float) -> bool:
    """Whether the drift of a job falls with the square of its increments."""
    return job.finer is not None and largest_drift(job.finer().results) <= SECOND_ORDER * drift


def line(one: Mapping[str, Any]) -> str:
    """What is printed of a job as it ends."""
    missed = ", ".join(f"{name} {one['found'][name]:.2g}" if name in one["found"] else name for name in one["misses"])
    return f"{one['CPU s']:6.1f} s  {one['name']:<58} {missed or 'all kept'} {one['error']}"


def _of(number: int) -> dict[str, Any]:
    return watch(JOBS[number])


def run(numbers: Sequence[int], processes: int) -> list[dict[str, Any]]:
    """Some of the jobs, so many at a time, with a line for each as it ends."""
    outcomes = []
    with ProcessPoolExecutor(processes, mp_context=get_context("spawn")) as pool:
        for one in pool.map(_of, numbers):
            outcomes.append(one)
            print(line(one), flush=True)
    return outcomes


def main() -> int:
    """Run the jobs, print the largest of each quantity, write the page; 1 if a limit is missed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--job", metavar="TEXT", help="only jobs whose names have this text")
    parser.add_argument("--processes", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--page", type=Path, metavar="FILE", help="write the page")
    record.add_option(parser)
    given = parser.parse_args()
    numbers = [number for number, job in enumerate(JOBS) if given.job is None or given.job in job.name]
    if not numbers:
        parser.error(f"no job has {given.job!r} in its name")
    outcomes = run(numbers, given.processes)
    print(summary(outcomes, LIMITS))
    record.write(given.json, "balances", {"jobs": outcomes})
    if given.page is not None:
        if given.job is not None:
            parser.error("the page is of all jobs")
        given.page.write_text(page(outcomes, LIMITS, KNOWN), encoding="utf-8")
    return int(any(one["misses"] for one in outcomes))


if __name__ == "__main__":
    raise SystemExit(main())

"""How many random jobs arrive, each in a process with a time limit: 300 bends, or 200 jobs of drawing and forming.

    python benchmarks/robust.py --json build/robust.json --page docs/robust-rate.md
    python benchmarks/robust.py --job 117
    python benchmarks/robust.py --lot draws --page docs/robust-draws.md

A job has arrived if its steps are at their end and all that is known of its answer is right: forces and energies
balance, and what else a kind knows.
"""

from __future__ import annotations

import argparse
import json
import logging
import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import record
import umform as uf
from imbalance import MISSED, MISSED_FORCES, largest_drift
from jobs import Done, Job
from robust_lots import LOTS, Rated
from robust_page import failures, page, table
from umform.errors import NoConvergence, UmformError
from umform.timing import Timing, timings

#: CPU seconds after which a job counts as one that hangs; wall seconds may be as many times more.
LIMIT, PATIENCE = 100, 10
#: Part to which a large drift of the energies must fall by increments of half the size.
FALLS = 0.6
#: What the warning of a jump says.
JUMPED = "jumped to the next stable state"


class OutOfTime(BaseException):
    """The limit of CPU seconds is reached."""


def outcome(task: Job) -> dict[str, Any]:
    """Run a job in this process and return its outcome."""
    logging.getLogger("umform").addHandler(logging.NullHandler())
    uf.set_threads(1)
    start, done = time.process_time(), Done([])
    ended, reason = "arrived", ""
    try:
        with timings() as runs:
            done = task.run()
        reason = imbalance(task, done)
        ended = "wrong" if reason else "arrived"
    except NoConvergence as error:
        ended, reason = "no convergence", f"{error.where}: {error.cause}; {error.value}"
    except UmformError as error:
        ended, reason = ("error" if Timing.sum(runs).attempts.evaluations else "refused"), " ".join(str(error).split())
    except OutOfTime:
        ended, reason = "out of time", "the limit of CPU seconds is reached"
    made = Timing.sum(runs).attempts
    return {
        "number": task.number,
        "kind": task.kind,
        "outcome": ended,
        "reason": reason,
        "CPU s": round(time.process_time() - start, 2),
        "increments": sum(len(result) - 1 for result in done.results),
        "iterations": int(sum(result["iterations"].sum() for result in done.results)),
        "evaluations": made.evaluations,
        "share discarded": round(made.share, 3),
        "jumps": sum(JUMPED in warning for result in done.results for warning in result.warnings),
        "warnings": [warning for result in done.results for warning in result.warnings],
        "failed attempts": dict(made.causes.most_common()),
        "drift": drift(done),
    }


def drift(done: Done) -> float:
    """Largest drift of the energies in all runs of a job."""
    return largest_drift(done.results)


def imbalance(task: Job, done: Done) -> str:
    """What does not balance in what a job gave; nothing if all does."""
    found = []
    for result in done.results:
        force, moment = result.balance().largest_imbalances
        most = max(done.forces, MISSED_FORCES) if any(MISSED in text for text in result.warnings) else done.forces
        found += [("forces", force, most), ("moments", moment, most)]
    found += [(name, *pair) for name, pair in done.deviations.items()]
    coarse = drift(done)
    if coarse > done.energies:
        found.append(("energies with increments of half the size", drift(task.finer().run()), FALLS * coarse))
    return "; ".join(f"{name} off by {off:.2g}, {most:.2g} allowed" for name, off, most in found if not off <= most)


def in_a_process(rated: Rated, number: int, limit: int = LIMIT) -> dict[str, Any]:
    """Run a job in a process of its own, which may die or hang."""
    threads = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    command = [sys.executable, __file__, "--lot", rated.name, "--inside", str(number), "--limit", str(limit)]
    lost = {
        "number": number,
        "kind": rated.lot.job(number).kind,
        "CPU s": float(limit),
        "evaluations": 0,
        "share discarded": 0.0,
    }
    try:
        done = subprocess.run(
            command,
            capture_output=True,
            text=True,
            env={**os.environ, **threads},
            timeout=limit * PATIENCE,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return {**lost, "outcome": "hang", "reason": f"no answer in {limit * PATIENCE} s"}
    if done.returncode == -signal.SIGKILL:
        return {**lost, "outcome": "hang", "reason": "killed: it did not hear that its CPU time was over"}
    if done.returncode != 0:
        last = (done.stderr.strip().splitlines() or ["nothing said"])[-1]
        return {**lost, "outcome": "crash", "reason": f"ended with {done.returncode}: {last}"}
    answer: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return answer


def inside(task: Job, limit: int) -> None:
    """What the process of a job does: the answer is its last line."""

    def stop(signum: int, frame: object) -> None:
        signal.signal(signal.SIGXCPU, signal.SIG_IGN)  # it comes again each second
        raise OutOfTime

    signal.signal(signal.SIGXCPU, stop)
    resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 20))
    print(json.dumps(outcome(task)))


def run(rated: Rated, numbers: Sequence[int], processes: int, limit: int) -> list[dict[str, Any]]:
    """All of some jobs, so many at a time, with a line for each as it ends."""
    outcomes = []
    with ThreadPoolExecutor(processes) as pool:
        for one in pool.map(lambda number: in_a_process(rated, number, limit), numbers):
            outcomes.append(one)
            print(
                f"{one['number']:4d}  {one['kind']:<28}{one['CPU s']:>7.1f} s  {one['outcome']}  {one['reason']}",
                flush=True,
            )
    return outcomes


def known(rated: Rated, path: Path | None) -> dict[int, dict[str, Any]]:
    """What a file has of earlier runs of the same jobs, by their numbers."""
    if path is None or not path.is_file():
        return {}
    kept = json.loads(path.read_text()).get("benchmarks", {}).get(rated.benchmark, {}).get("numbers", {})
    return {one["number"]: one for one in kept["jobs"]} if kept.get("drawn") == rated.lot.drawn else {}


def show(task: Job) -> None:
    """Print the random choices of one job, and its outcome."""
    print(json.dumps(task.keys, indent=1))
    print(json.dumps(outcome(task), indent=1))


def main() -> None:
    """Run the jobs, print the table and the failures, write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lot", choices=LOTS, default="bends", help="which jobs")
    parser.add_argument("--job", type=int, metavar="NUMBER", help="one job in this process, with all its numbers")
    parser.add_argument("--jobs", type=int, nargs="*", metavar="NUMBER",
                        help="default: all; those that are in the file of --json already stay there")  # fmt: skip
    parser.add_argument("--sample", action="store_true", help="those that the tests run")
    parser.add_argument("--processes", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--limit", type=int, default=LIMIT, help="CPU seconds of a job")
    parser.add_argument("--page", type=Path, metavar="FILE", help="write the page with the explanations of failures")
    parser.add_argument("--inside", type=int, help=argparse.SUPPRESS)
    record.add_option(parser)
    arguments = parser.parse_args()
    rated = LOTS[arguments.lot]
    if arguments.job is not None:
        return show(rated.lot.job(arguments.job))
    if arguments.inside is not None:
        return inside(rated.lot.job(arguments.inside), arguments.limit)
    numbers = rated.sample if arguments.sample else arguments.jobs
    numbers = range(rated.lot.count) if numbers is None else numbers
    found = known(rated, arguments.json)
    found |= {one["number"]: one for one in run(rated, numbers, arguments.processes, arguments.limit)}
    outcomes = [found[number] for number in sorted(found)]
    print(f"{table(rated, outcomes)}\n\n{failures(outcomes)}")
    record.write(arguments.json, rated.benchmark, {"drawn": rated.lot.drawn, "jobs": outcomes})
    if arguments.page is not None:
        if len(outcomes) < rated.lot.count:
            parser.error(f"the page is of all jobs, {rated.lot.count - len(outcomes)} are missing")
        arguments.page.write_text(page(rated, outcomes), encoding="utf-8")
    return None


if __name__ == "__main__":
    main()

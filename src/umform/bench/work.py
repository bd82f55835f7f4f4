"""The process of a job: ``python -m umform.bench.work FOLDER``; without FOLDER, standard input names it.

It writes its state into the folder of the job, and goes on without the server.
"""

from __future__ import annotations

import importlib
import json
import select
import signal
import sys
import traceback
from dataclasses import replace
from pathlib import Path
from typing import Any

from umform.analysis.run.observers import watching
from umform.bench.errors_as_json import error_record
from umform.bench.folders import DECK, ORDER, OUTCOME, RESULTS, locked
from umform.bench.forces import computed_forces, largest, largest_of
from umform.bench.form import DRAWS
from umform.bench.limits import limit_memory
from umform.bench.live import BendProgress, DeckProgress, Watch, write_live
from umform.bench.shelf import Shelf
from umform.bench.strips import run_strip
from umform.bench.wanted import Wanted
from umform.errors import UmformError
from umform.io.atomic import write_text
from umform.io.staging import staging
from umform.processes.air_bending.bottoming import press_to_force
from umform.processes.air_bending.brake import FRAMES, Brake
from umform.processes.air_bending.budget import error_budget
from umform.processes.air_bending.case import air_bending
from umform.processes.air_bending.files import FILES, record, write_files
from umform.processes.air_bending.search import find_stroke
from umform.processes.early_end import what_was_reached
from umform.processes.plausible import accepted
from umform.report.key_numbers import key_numbers
from umform.report.looks import MILLIMETRES, Units
from umform.report.words import column_text

#: Modules that a run needs after its first increments: pictures, 3D view and report.
_PRELOAD = (
    "matplotlib",
    "matplotlib.transforms",
    "matplotlib.text",
    "matplotlib.figure",
    "umform.bench.shape",
    "umform.processes.air_bending.page",
    "umform.processes.air_bending.pictures",
)


#: Work with a run of its own.
_OTHERS = ("flat", "table", "correct", *DRAWS)


def main(arguments: list[str]) -> int:
    """Run the job of a folder and write its outcome there."""
    text = arguments[0] if arguments else _read_folder()
    if not text:
        return 0  # the server has ended
    folder = Path(text)
    with locked(folder) as mine:
        if not mine or (folder / OUTCOME).exists():
            return 0
        limit_memory()
        # a stop between two runs, too, keeps what was reached
        signal.signal(signal.SIGTERM, signal.default_int_handler)
        outcome = _outcome(folder)
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        write_text(folder / OUTCOME, json.dumps(outcome, allow_nan=False))
    return 0


def _read_folder() -> str:
    """The folder from standard input; meanwhile modules are loaded, one at a time."""
    for name in _PRELOAD:
        if sys.platform != "win32" and select.select([sys.stdin], [], [], 0.0)[0]:  # Windows asks sockets only
            break
        importlib.import_module(name)
    return sys.stdin.readline().strip()


def _outcome(folder: Path) -> dict[str, Any]:
    """Run a job and return its outcome, also of a failure."""
    try:
        order = json.loads((folder / ORDER).read_text(encoding="utf-8"))
        write_live(folder, {"fraction": 0.0, "phase": "start", "increments": 0, "shape": 0})
        work = _bend if order["kind"] == "bend" else _deck
        return {"state": "done", "reason": "", "summary": work(folder, order)}
    except UmformError as error:
        return _failed(error)
    except KeyboardInterrupt:
        return {"state": "stopped", "reason": "", "summary": {}}
    except MemoryError:
        return _failed(
            UmformError(
                "the job needs more memory than this machine has",
                where="job",
                cause="too many elements: a fine mesh, or a long part",
                remedy="a coarser mesh, or a shorter part",
            )
        )
    except Exception as error:
        traceback.print_exc()
        return {"state": "failed", "reason": f"{type(error).__name__}: {error}"[:2000], "summary": {}}


def _failed(error: UmformError) -> dict[str, Any]:
    """The outcome of a job with an error."""
    return {"state": "failed", "reason": str(error), "summary": {"error": error_record(error)}}


def _bend(folder: Path, order: dict[str, Any]) -> dict[str, Any]:
    """A bend, by the calls of `umform bend`: the numbers are equal."""
    wanted = Wanted.read(order["parameters"])
    for one in wanted.cases(Shelf(folder)):
        accepted(one)
    if wanted.choices.work in _OTHERS:
        return _other(folder, order, wanted)
    case, note, length = wanted.case(Shelf(folder)), wanted.law()[1], wanted.choices.length
    if wanted.of_strip:
        return run_strip(folder, order["title"], wanted, case, note) | {"length": length, "note": note}
    brake = Brake(case, frames=FRAMES)
    angle, force = wanted.goal.angle, wanted.goal.force_per_metre
    progress = BendProgress(brake, angle, case.bottom_stroke if case.bottoming else case.stroke)
    watch = Watch(folder, order["title"], progress, units=MILLIMETRES, force=progress.force)

    results = folder / RESULTS
    with staging(results, FILES), watching(watch):
        with what_was_reached(results, "bend.vtkhdf", brake.run.result):
            if force is not None:
                done = press_to_force(case, force, brake=brake, progress=False).bend
            elif case.stroke is not None:
                done = air_bending(case, brake=brake, progress=False)
            else:
                assert angle is not None
                done = find_stroke(case, angle, tolerance=wanted.goal.tolerance, brake=brake, progress=False).bend
        try:
            if wanted.choices.budget:
                watch.phase("budget", 0.75)
                done = replace(done, budget=error_budget(done, progress=False))
        finally:  # even if the budget is stopped
            watch.phase("files", 0.95)
            watch.shape(done.result)
            write_files(results, done, note)
    watch.phase("end", 1.0)
    needed = largest(computed_forces(wanted, case, {wanted.choices.work: largest_of(done.quantities)}))
    return {**record(done), "length": length, "note": note, "press": needed.over(length)}


def _other(folder: Path, order: dict[str, Any], wanted: Wanted) -> dict[str, Any]:
    """Work of other commands, which need modules of their own."""
    if wanted.choices.work == "flat":
        from umform.bench.unfold import run_flat

        return run_flat(folder, wanted, order["part"])
    if wanted.choices.work == "table":
        from umform.bench.bend_tables import run_table

        return run_table(folder, wanted)
    if wanted.is_drawn:
        from umform.bench.draws import run_draw

        return run_draw(folder, order["title"], wanted)
    from umform.bench.corrections import run_correction

    return run_correction(folder, wanted)


def _deck(folder: Path, order: dict[str, Any]) -> dict[str, Any]:
    """A deck, by the calls of `umform run`, or of `umform resume` if there is a checkpoint."""
    from umform.problem import running
    from umform.problem.deck_in_checkpoint import Kept
    from umform.problem.problem import Problem
    from umform.problem.results import CHECKPOINT

    results = folder / RESULTS
    checkpoint = results / CHECKPOINT
    taken_up = checkpoint.is_file()
    kept = Kept.read(checkpoint) if taken_up else None
    files = folder.parent.parent  # of the bench; paths in a deck start there, as in the check
    deck = kept.deck if kept else Problem.read((folder / DECK).read_text(encoding="utf-8"), DECK, files)
    steps = deck.contents.steps
    progress = DeckProgress(sum(step.expected for step in steps), len(steps))
    names = deck.contents.units
    units = Units(names.length, names.force)
    watch = Watch(folder, order["title"], progress, units=units)
    with watching(watch):
        every = float(order.get("every", 10.0))
        if kept is not None:
            outcome = running.resume(checkpoint, kept, results, every=every, progress=False, overwrite=True)
        else:
            solver = deck.contents.solution.solver
            problem = running.prepared(deck, solver, lambda built: running.refuse_implausible(deck, built))
            outcome = running.run(deck, problem, results, every=every, progress=False, overwrite=True)
    watch.shape(outcome.result)
    if outcome.ended_by is not None:
        raise outcome.ended_by
    watch.phase("end", 1.0)
    result = outcome.result
    last = {
        column_text(name): float(value) for name, value in result.rows[-1].items() if abs(float(value)) < float("inf")
    }
    record = outcome.record()
    numbers = {kind: record[kind] for kind in ("quantities", "checks")}
    key = [one.record() for one in key_numbers(result, units)]
    return {**result.summary(), **numbers, "key": key, "last": last, "resumed": taken_up}


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

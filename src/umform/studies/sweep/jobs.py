"""Jobs of a sweep: deck, folder and fingerprint; and running a job in any process."""

from __future__ import annotations

import hashlib
import json
import re
import time
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import umform
from umform.analysis.run.fingerprint import text as text_of
from umform.digest import floats
from umform.errors import FileProblem, UmformError
from umform.io.tables import write_json
from umform.problem import Problem, running
from umform.problem.deck_in_checkpoint import Kept
from umform.problem.own_classes import modules_of, texts
from umform.problem.results import CHECKPOINT
from umform.problem.unloading import loading_steps
from umform.studies.sweep.measures import Function, Record, number_of, springback, stats

#: Record of a job in its folder.
RECORD = "job.json"
#: Output that a job omits by default: pictures and pages.
_NUMBERS_ONLY = {"output.frames": 1, "output.vtkhdf": False, "output.report": False, "output.pictures": False}


@dataclass(frozen=True)
class Job:
    """A deck with other values of some of its keys.

    Attributes
    ----------
    deck : Problem
        The deck with its changes.
    varied : dict of str to object
        The varied values, by the names of the sweep.
    folder : Path
        Folder of its files; its name depends on the values and on the whole deck.
    functions : tuple of callable
        User-defined measures.
    force : bool
        Whether it runs in spite of numbers that are certainly wrong.
    """

    deck: Problem
    varied: Mapping[str, Any]
    folder: Path
    functions: tuple[Function, ...] = ()
    force: bool = False

    def record(self) -> Record | None:
        """Record of the job, if it was finished with all requested functions."""
        try:
            kept: Record = json.loads((self.folder / RECORD).read_text(encoding="utf-8"))
            missing = {function.__name__ for function in self.functions} - set(kept["functions"])
        except (OSError, ValueError, KeyError, TypeError):
            return None
        return None if missing and kept["outcome"] == "done" else kept


def job(
    deck: Problem, changes: Mapping[str, Any], varied: Mapping[str, Any], folder: Path, *, files: bool, **options: Any
) -> Job:
    """The job for some values.

    Parameters
    ----------
    deck : Problem
        The deck to vary.
    changes : mapping of str to object
        Other values of some of its keys.
    varied : mapping of str to object
        The same by the names of the sweep.
    folder : Path
        The folder of all jobs.
    files : bool
        Whether to write all files that the deck asks for.
    **options
        See :class:`Job`.

    Raises
    ------
    DeckError
        With all mistakes in it.
    """
    changed = deck.with_({**changes, **({} if files else _NUMBERS_ONLY)}).at(deck.source.folder.resolve())
    words = "_".join(f"{name.split('.')[-1]}-{_word(value)}" for name, value in varied.items())
    name = f"{re.sub(r'[^A-Za-z0-9_.+-]+', '-', words)[:60]}-{_fingerprint(changed)}"
    return Job(changed, varied, folder / name, **options)


def run_numbered(task: tuple[int, Job]) -> tuple[int, Record]:
    """Run a job that has a number."""
    number, job = task
    return number, run_job(job)


def run_job(job: Job) -> Record:
    """Run or resume a job, and keep its record in its folder.

    Raises
    ------
    KeyboardInterrupt
        At Ctrl-C; the checkpoint stays.
    Exception
        Anything unexpected, such as a full disk: then no record is kept, and the job runs again next time.
    """
    start = time.perf_counter()
    try:
        outcome = _outcome(job)
        if outcome.ended_by is not None and not isinstance(outcome.ended_by, UmformError):
            raise outcome.ended_by
        record = record_of("done", "") if outcome.ended_by is None else record_of("stopped", outcome.ended_by)
        record |= _numbers(job, outcome) if outcome.ended_by is None else {}
        record["warnings"] = len(outcome.result.warnings)
    except FileProblem:
        raise
    except UmformError as error:
        record = record_of("refused", error)
    record["seconds"] = round(time.perf_counter() - start, 2)
    job.folder.mkdir(parents=True, exist_ok=True)
    write_json(job.folder / RECORD, record)
    return record


def record_of(outcome: str, reason: BaseException | str) -> dict[str, Any]:
    """A record without numbers.

    Parameters
    ----------
    outcome : str
        done, stopped (no convergence), refused (an error of the deck or the model), failed (anything else), open.
    reason : exception or str
        Why it is not done.
    """
    if isinstance(reason, BaseException) and not isinstance(reason, UmformError):
        reason = f"{type(reason).__name__}: {reason}"
    text = " ".join(str(reason).split())
    return {"outcome": outcome, "reason": text, "warnings": 0, "seconds": None, "functions": {}}


def _outcome(job: Job) -> running.ProblemOutcome:
    """Outcome of the run of a job, from its checkpoint if there is a valid one."""
    checkpoint = job.folder / CHECKPOINT
    if checkpoint.is_file():
        try:
            return running.resume(
                checkpoint, Kept.read(checkpoint, job.deck.source.trust), job.folder, progress=False, overwrite=True
            )
        except FileProblem:  # a run from the start needs no checkpoint
            checkpoint.unlink(missing_ok=True)
    refuse = partial(running.refuse_implausible, job.deck, force=job.force)
    problem = running.prepared(job.deck, job.deck.contents.solution.solver, refuse)
    return running.run(job.deck, problem, job.folder, progress=False, overwrite=True)


def _numbers(job: Job, outcome: running.ProblemOutcome) -> dict[str, Any]:
    """All numbers of a finished job that may become measures."""
    result = outcome.result
    contents = job.deck.contents
    loading = loading_steps(contents)
    return {
        "controls": [control.name for control in result.model.controls],
        "history": stats(result),
        "quantities": [one.record() for one in outcome.quantities],
        "checks": [one.record() for one in outcome.checks],
        "springback": None if loading == len(contents.steps) else springback(result, loading),
        "functions": {function.__name__: number_of(function, result) for function in job.functions},
    }


def _word(value: Any) -> str:
    if isinstance(value, Mapping):
        return "-".join(map(_word, value.values()))
    return f"{value:.10g}" if isinstance(value, float) else str(value)


def _fingerprint(deck: Problem) -> str:
    """Digest of everything that affects the numbers of a deck: its values, the files that it reads, the version."""
    data = floats({key: value for key, value in deck.source.data.items() if key != "title"})
    check = hashlib.sha256(json.dumps([umform.__version__, data], sort_keys=True, default=text_of).encode())
    for text in sorted(set(texts(data))):
        try:
            check.update((deck.source.folder / text).read_bytes())
        except (OSError, ValueError):  # no file
            continue
    for module in modules_of(data).values():
        check.update(module)
    return check.hexdigest()[:8]

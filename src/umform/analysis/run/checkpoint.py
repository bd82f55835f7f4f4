"""Checkpoints: the complete state of a run between two increments in one file, and its restoration.

The next increment recovers its enhanced parameters with the blocks of the last evaluation (2.19), which are not saved:
the evaluation is repeated from its input history. docs/long-runs.md
"""

from __future__ import annotations

import time as clock
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from umform.analysis.newton.strategy_statistics import StrategyStatistics
from umform.analysis.steps.run_state import Run
from umform.analysis.steps.trail import Trail
from umform.errors import FileProblem, InvalidValue
from umform.io.atomic import PendingFile
from umform.io.trees import kind_of, read_tree, write_tree
from umform.model import Evaluation, Snapshot
from umform.model.contact import ContactPoints
from umform.model.equations.frame import Frame
from umform.ranks import ONE, Ranks
from umform.results.history import History
from umform.results.records import Iteration
from umform.solvers.protocol import Remembering

CHECKPOINT_KIND = "checkpoint of umform"

#: Large checkpoints may take at most one part in this number of the time.
_SHARE = 20


class Checkpoints:
    """Writes the checkpoints of a run, each replacing the previous one.

    Parameters
    ----------
    path : str or PathLike
        The file.
    every : float
        Least seconds between two of them; 0: one after each increment.
    fingerprint : dict of str to str
        Fingerprint of the run.
    note : dict, optional
        Additional content of the file, see :func:`umform.io.trees.write_tree`: the deck that the run was built from.

    Attributes
    ----------
    problem : str
        Why the last one could not be written; empty without a failure.

    Raises
    ------
    FileProblem
        If no file can be written there.
    InvalidValue
        If the seconds are negative or not finite.
    """

    def __init__(
        self,
        path: str | PathLike[str],
        every: float,
        fingerprint: dict[str, str],
        note: Mapping[str, Any] | None = None,
        ranks: Ranks = ONE,
    ) -> None:
        if not isinstance(every, int | float) or not 0.0 <= every < np.inf:
            raise InvalidValue(
                "checkpoints are written every so many seconds, 0 or more",
                where="every",
                value=every,
                cause="a sign, a text, or a number that is not finite",
                remedy="0 writes one after each increment; leave the checkpoint out to write none",
            )
        self.path, self.every, self.fingerprint = Path(path), every, fingerprint
        self.note = dict(note or {})
        self._writes = ranks.rank == 0  # one rank writes for all
        self._last, self._cost, self.problem = clock.perf_counter(), 0.0, ""
        ranks.agree(_problem_of_writing(self.path) if self._writes else None)  # fail now rather than after an hour

    def due(self) -> bool:
        """Whether it is time for the next one."""
        wait = max(self.every, _SHARE * self._cost) if self.every > 0.0 else 0.0
        return clock.perf_counter() - self._last >= wait

    def write(self, run: Run) -> None:
        """Write the state of a run between two increments; after a failure the run continues with a warning."""
        start = clock.perf_counter()
        tree = {"fingerprint": self.fingerprint, "note": self.note, **memory_of(run)}
        if run.follower is not None:
            tree["follower"] = run.follower.memory()
        try:
            if self._writes:
                write_tree(self.path, tree, CHECKPOINT_KIND)
        except FileProblem as problem:
            if problem.cause != self.problem:  # warn once
                run.result.warn(f"no checkpoint was written to {self.path}: {problem.cause}; what was there stays")
            self.problem = problem.cause
        else:
            self.problem = ""
        self._last = clock.perf_counter()
        self._cost = self._last - start


def read_checkpoint(path: str | PathLike[str]) -> dict[str, Any]:
    """Content of a checkpoint; its ``note`` is that given to :func:`umform.solve`.

    Raises
    ------
    FileProblem
        If the file cannot be read, is damaged, or is no checkpoint.
    """
    return read_tree(path, CHECKPOINT_KIND)


def read_note(path: str | PathLike[str], kind: str = CHECKPOINT_KIND) -> dict[str, Any]:
    """The note of a checkpoint, or of another file with one, without the state, which may be large.

    Raises
    ------
    FileProblem
        If the file cannot be read, or is no checkpoint.
    """
    return read_tree(path, kind, part="note")


def other_file(path: Path) -> FileProblem | None:
    """Why a run must not write its checkpoint here: a file of another kind would be lost. None if there is none."""
    if not path.is_file() or path.stat().st_size == 0 or kind_of(path) == CHECKPOINT_KIND:
        return None
    return FileProblem(
        "this file is no checkpoint",
        where=str(path),
        cause="another file has this name, and would be lost",
        remedy="another name, such as run.h5; or move the file away",
    )


def _problem_of_writing(path: Path) -> FileProblem | None:
    trial = PendingFile(path)
    try:
        trial.__enter__()
        trial.discard()
    except FileProblem as problem:
        return problem
    return None


def take_up(run: Run, checkpoints: Checkpoints) -> dict[str, Any] | None:
    """Restore a run that has not begun from its checkpoint.

    Parameters
    ----------
    run : Run
        The run, with its model.
    checkpoints : Checkpoints
        Path, and fingerprint of the run; gets the note of the checkpoint.

    Returns
    -------
    dict or None
        State of the loop of the step ``run.number``; None if the run is complete.

    Raises
    ------
    FileProblem
        If the file cannot be read, or belongs to another run.
    """

    def read() -> dict[str, Any]:
        whole = read_checkpoint(checkpoints.path)
        _refuse_another_run(checkpoints.path, whole["fingerprint"], checkpoints.fingerprint)
        return whole

    tree = run.model.system.whole.own_state(read)
    checkpoints.note = tree["note"]
    memory = recall(run, tree)
    if run.follower is not None:
        run.follower.recall(run, tree["follower"])
    return memory


def recall(run: Run, tree: Mapping[str, Any]) -> dict[str, Any] | None:
    """Restore a run that has not begun from what :func:`memory_of` gave; the state of its loop."""
    run.model.system.restore(Snapshot(**tree["model"]))
    run.evaluation = run.model.system.repeat(tree["before"])
    run.number, run.statistics = tree["number"], StrategyStatistics(**tree["statistics"])
    run.trail = None if tree["trail"] is None else Trail(**tree["trail"])
    solver = run.newton.ready_solver().solver.solver
    if isinstance(solver, Remembering):
        solver.recall(tree["factors"])
    _recall_result(run.result, tree["result"], run.evaluation)
    memory: dict[str, Any] | None = tree["loop"]
    return memory


def memory_of(run: Run) -> dict[str, Any]:
    """Complete state of a run between two increments."""
    model, solver = run.model, run.newton.ready_solver().solver.solver
    return model.system.whole.state(
        {
            "number": run.number,
            # After an indefinite matrix, a solver with state uses other factors than those of Cholesky.
            "factors": solver.memory() if isinstance(solver, Remembering) else None,
            "loop": None if run.loop is None else run.loop.memory(),
            "model": vars(model.system.snapshot()),
            "before": model.system.inputs,
            "trail": None if run.trail is None else vars(run.trail),
            "statistics": vars(run.statistics),
            "result": _result_tree(run.result),
        }
    )


#: Name of the version in the fingerprint of a run.
_VERSION = "version of umform"


def _refuse_another_run(path: str | PathLike[str], there: dict[str, str], here: dict[str, str]) -> None:
    different = [part for part in {**here, **there} if there.get(part) != here.get(part)]
    if different == ["solver"] and "petsc" in (there.get("solver"), here["solver"]):
        return  # with another number of ranks: the same up to round-off
    if not different:
        return
    part = different[0]
    older = f"resume with umform {there[_VERSION]}, which wrote it" if part == _VERSION and part in there else ""
    same = "resume with the same deck, model and files as at the start"
    raise FileProblem(
        "the checkpoint belongs to another run",
        where=str(path),
        value="different: " + ", ".join(different),
        cause=f"{part}: {_around(there.get(part, ''), here.get(part, ''))}",
        remedy=f"{older or same}, or start again without the checkpoint",
    )


def _around(there: str, here: str, width: int = 60) -> str:
    """First difference of two texts."""
    same = next((k for k, (a, b) in enumerate(zip(there, here, strict=False)) if a != b), min(len(there), len(here)))
    first = max(0, same - width // 2)
    before = "... " if first else ""
    return f"{before}{there[first : same + width]} in the file, {before}{here[first : same + width]} here"


# The result -------------------------------------------------------------------------------------------------


def _result_tree(result: History) -> dict[str, Any]:
    columns = result.columns()
    records = [record for records in result.iterations for record in records]
    return {
        "columns": columns,
        "history": [result[name] for name in columns],
        "iterations": {
            "counts": [len(records) for records in result.iterations],
            "records": [list(vars(record).values()) for record in records],
        },
        "frames": _stacked([_frame_tree(frame) for frame in result.frames]),
        "events": result.events,
        "warnings": result.warnings,
        "seconds": result.seconds,
        "work": result.work_memory(),
    }


def _recall_result(result: History, tree: dict[str, Any], evaluation: Evaluation) -> None:
    columns = [column.tolist() for column in tree["history"]]
    result.rows = [dict(zip(tree["columns"], row, strict=True)) for row in zip(*columns, strict=True)]
    records = iter(tree["iterations"]["records"])
    result.iterations = [[Iteration(*next(records)) for _ in range(count)] for count in tree["iterations"]["counts"]]
    result.frames = [_frame(one) for one in _unstacked(tree["frames"])]
    result.events, result.warnings, result.seconds = tree["events"], tree["warnings"], tree["seconds"]
    result.recall_work(tree["work"], evaluation)


def _frame_tree(frame: Frame) -> dict[str, Any]:
    return {**vars(frame), "contacts": {name: points.known() for name, points in frame.contacts.items()}}


def _frame(tree: dict[str, Any]) -> Frame:
    contacts = {name: ContactPoints(**points) for name, points in tree["contacts"].items()}
    return Frame(**{**tree, "number": int(tree["number"]), "time": float(tree["time"]), "contacts": contacts})


def _stacked(trees: list[dict[str, Any]]) -> dict[str, Any] | None:
    """Stack trees of the same structure to one tree of longer arrays; None for no trees."""
    if not trees:
        return None
    columns = {key: [tree[key] for tree in trees] for key in trees[0]}
    return {key: _stacked(parts) if isinstance(parts[0], dict) else np.stack(parts) for key, parts in columns.items()}


def _unstacked(tree: dict[str, Any] | None) -> list[dict[str, Any]]:
    """Split a tree made by `_stacked`."""
    if tree is None:
        return []
    return [_slice(tree, k) for k in range(len(tree["number"]))]


def _slice(tree: dict[str, Any], k: int) -> dict[str, Any]:
    return {key: _slice(part, k) if isinstance(part, dict) else part[k] for key, part in tree.items()}

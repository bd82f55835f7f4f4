"""The queue: each job in a process of its own, which may be stopped, and taken up again when the server restarts."""

from __future__ import annotations

import json
import logging
import os
import secrets
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from umform.bench.folders import DECK, LIVE, LOCK, NAME, ORDER, OUTCOME, RESULTS, SHAPE, is_owned
from umform.bench.index import UNFINISHED, Index, Job
from umform.bench.limits import Disk
from umform.bench.ready import Ready
from umform.bench.shelf import Shelf
from umform.errors import InvalidValue, UmformError
from umform.io.atomic import PendingFile

log = logging.getLogger("umform.bench")

#: Jobs that may wait, bytes of a deck, and starts of a job whose process dies without an outcome.
MOST_WAITING, LONGEST_DECK, MOST_STARTS = 200, 400_000, 3
#: Bytes that a folder may have if nothing else is said.
USUAL_DISK = 10e9
#: Seconds between two looks at the processes, and those that a process has to end gently.
_LOOK, _GENTLE = 0.05, 10.0


class Queue:
    """Runs jobs one after the other, or some at a time; what it knows is in the index and in the folders of the jobs.

    Parameters
    ----------
    folder : Path
        Folder of the bench.
    at_once : int
        Jobs at a time.
    disk : float
        Bytes that all files of the folder may have.

    Attributes
    ----------
    index : Index
        The index.
    disk : Disk
        Room for more files.
    shelf : Shelf
        Drawn tools.
    ready : Ready
        The process that waits for the next job.
    """

    def __init__(self, folder: Path, at_once: int = 1, disk: float = USUAL_DISK) -> None:
        self.folder, self.at_once = folder, at_once
        self.disk, self.shelf = Disk(folder, disk), Shelf(folder)
        self.ready = Ready([sys.executable, "-m", "umform.bench.work"], folder / "jobs.log")
        (folder / "jobs").mkdir(parents=True, exist_ok=True)
        self.index = Index(folder)
        self._lock = threading.RLock()
        self._running: dict[str, subprocess.Popen[bytes] | None] = {}  # None: of a server before this one
        self._asked: dict[str, float] = {}  # jobs that were asked to stop, and until when they may do so gently
        self._wake, self._over = threading.Event(), threading.Event()
        self._thread = threading.Thread(target=self._go, name="umform-bench-queue", daemon=True)

    def start(self) -> None:
        """Take up what a server before this one has left, and begin."""
        for job in self.index.jobs(*UNFINISHED):
            if is_owned(self.place(job.id)):
                self._running[job.id] = None
            elif not self._settle(job):
                self.index.change(job.id, "waiting")
        self._thread.start()

    def close(self) -> None:
        """Stop all jobs gently; those that had not ended are taken up by the next server."""
        self._over.set()
        self._wake.set()
        self._thread.join(timeout=2 * _GENTLE)
        with self._lock:
            for name in self._running:
                self._signal(name, signal.SIGTERM)
            until = time.monotonic() + _GENTLE
            while any(self._lives(name) for name in self._running) and time.monotonic() < until:
                time.sleep(_LOOK)
            for name in self._running:
                self._signal(name, signal.SIGKILL)
                process = self._running[name]
                if process is not None:
                    with suppress(subprocess.TimeoutExpired):
                        process.wait(timeout=_GENTLE)
                job = self.index.job(name)
                asked = name in self._asked
                if job is not None and not self._settle(job, took_up=not asked):
                    self.index.change(name, "stopped" if asked else "waiting")
            self.ready.let_go()
            self.index.close()

    def place(self, name: str) -> Path:
        """Folder of a job."""
        if not NAME.fullmatch(name):
            raise InvalidValue("there is no such job", where="job", value=name[:40])
        return self.folder / "jobs" / name

    def add(
        self,
        kind: str,
        title: str,
        parameters: Mapping[str, Any],
        *,
        series: str = "",
        deck: str = "",
        tools: Mapping[str, str | None] | None = None,
    ) -> str:
        """Add a job, and return its name; ``tools``: drawn tools by kind, of which it gets copies.

        Raises
        ------
        InvalidValue
            If too many wait already, or the deck is too long.
        DiskFull
            If there is no room.
        """
        full = self.disk.problem()
        if full is not None:
            raise full
        with self._lock:
            if len(self.index.jobs("waiting")) >= MOST_WAITING:
                raise InvalidValue(
                    f"{MOST_WAITING} jobs wait already", where="queue", remedy="stop some, or let them run first"
                )
            if len(deck) > LONGEST_DECK:
                raise InvalidValue(
                    f"a deck has at most {LONGEST_DECK} letters here",
                    where="deck",
                    value=len(deck),
                    remedy="umform run",
                )
            name = secrets.token_hex(6)
            folder = self.place(name)
            folder.mkdir()
            if deck:
                (folder / DECK).write_text(deck, encoding="utf-8")
            self.shelf.copy_to(folder, tools or {})
            order = {"kind": kind, "title": title, "series": series, "parameters": dict(parameters)}
            with PendingFile(folder / ORDER) as waiting:
                waiting.write_text(json.dumps(order | {"created": time.time()}), encoding="utf-8")
            self.index.add(name, kind, title, series, parameters)
        self._wake.set()
        return name

    def stop(self, name: str) -> None:
        """Stop a job: one that waits at once, one that runs after its increment."""
        with self._lock:
            job = self.index.job(name)
            if job is None or job.state not in UNFINISHED:
                return
            if name in self._running:
                self._asked.setdefault(name, time.monotonic() + _GENTLE)
                self._signal(name, signal.SIGTERM)
            else:
                self.index.change(name, "stopped")

    def resume(self, name: str) -> None:
        """Take a job up that was stopped or has failed: a deck from its checkpoint, a bend from its beginning."""
        with self._lock:
            job = self.index.job(name)
            if job is None or job.state not in ("stopped", "failed"):
                return
            (self.place(name) / OUTCOME).unlink(missing_ok=True)
            self.index.change(name, "waiting")
        self._wake.set()

    def remove(self, name: str) -> None:
        """Forget a job that does not run, with its files."""
        with self._lock:
            if self.index.job(name) is None or name in self._running:
                return
            self.index.remove(name)
            place = self.place(name)
            (place / ORDER).unlink(missing_ok=True)  # first, lest it come back
            shutil.rmtree(place, ignore_errors=True)
            self.disk.forget()

    def live(self, name: str) -> dict[str, Any]:
        """Live data of a running job."""
        with suppress(OSError, ValueError):
            content: dict[str, Any] = json.loads((self.place(name) / LIVE).read_text(encoding="utf-8"))
            return content
        return {}

    # ---- the thread ----

    def _go(self) -> None:
        while not self._over.is_set():
            try:
                full = self.disk.problem()
                with self._lock:
                    self._reap()
                    if full is None:
                        self._begin()
                    else:
                        for name in self._running.keys() - self._asked.keys():
                            self.stop(name)
                    idle = not self._running
            except Exception:  # the queue must outlive whatever one job does
                log.exception("the queue of the bench")
                idle = False
            self._wake.wait(1.0 if idle else _LOOK)
            self._wake.clear()

    def _reap(self) -> None:
        """Store the outcomes of processes that have ended; kill those that do not stop."""
        for name in list(self._running):
            if self._lives(name):
                if time.monotonic() > self._asked.get(name, float("inf")):
                    self._signal(name, signal.SIGKILL)
                continue
            del self._running[name]
            asked = self._asked.pop(name, None) is not None
            job = self.index.job(name)
            if job is None or self._settle(job):
                continue
            if is_owned(self.place(name)):  # by a process that an earlier server has started
                self._running[name] = None
            elif asked:
                self.index.change(name, "stopped")
            elif job.starts < MOST_STARTS:
                self.index.change(name, "waiting")
            else:
                self.index.change(name, "failed", reason=f"its process has died {job.starts} times without a word")

    def _begin(self) -> None:
        """Start waiting jobs while there is room; keep a process ready where nothing runs, or more jobs wait."""
        for job in self.index.jobs("waiting")[: max(0, self.at_once - len(self._running))]:
            process = self.ready.take()
            self.index.change(job.id, "running", start=True)
            self._running[job.id] = process
            assert process.stdin is not None
            with suppress(OSError):  # a process that has died meanwhile is found when it is reaped
                process.stdin.write(f"{self.place(job.id).resolve()}\n".encode())
                process.stdin.close()
        if not self._running or self.index.jobs("waiting"):
            self.ready.keep()

    def _lives(self, name: str) -> bool:
        process = self._running[name]
        return is_owned(self.place(name)) if process is None else process.poll() is None

    def _signal(self, name: str, number: signal.Signals) -> None:
        """Send a signal to the process of a job, if it lives; that of an earlier server says who it is in its lock.

        SIGKILL goes to its whole group; on SIGTERM the job ends its children itself.
        """
        process = self._running[name]
        with suppress(OSError, ValueError):
            if not self._lives(name):
                return
            pid = process.pid if process is not None else int((self.place(name) / LOCK).read_text())
            of_group = number == signal.SIGKILL and os.getpgid(pid) == pid
            (os.killpg if of_group else os.kill)(pid, number)

    def _settle(self, job: Job, *, took_up: bool = False) -> bool:
        """Write down the outcome of a job if there is one; ``took_up``: one that was stopped is to go on later."""
        path = self.place(job.id) / OUTCOME
        try:
            outcome = json.loads(path.read_text(encoding="utf-8"))
            state, reason, summary = outcome["state"], outcome["reason"], outcome["summary"]
            if state == "stopped" and took_up:
                path.unlink()
                return False
            self.index.change(job.id, state, reason=reason, summary=summary)
        except (OSError, ValueError, KeyError, AssertionError):
            return False
        return True


def result_file(queue: Queue, name: str, file: str, known: frozenset[str]) -> Path:
    """A file of a job by its name.

    Raises
    ------
    UmformError
        If there is none, or its name is none of those that jobs write.
    """
    place = queue.place(name)
    path = place / file if file == SHAPE else place / RESULTS / file
    if file not in known or path.is_symlink() or not path.is_file():
        raise UmformError("there is no such file", where="file", value=file[:60])
    return path

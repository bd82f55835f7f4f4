"""The queue: each job runs in its own process, can be stopped, and is resumed when the server restarts."""

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
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from umform.bench.errors_as_json import error_record
from umform.bench.folders import DECK, LIVE, LOCK, NAME, ORDER, OUTCOME, RESULTS, SHAPE, is_locked
from umform.bench.gone import gone
from umform.bench.index import UNFINISHED, Index, Job
from umform.bench.limits import Disk
from umform.bench.shelf import Shelf
from umform.bench.spare_process import SpareProcess
from umform.errors import InvalidValue, UmformError
from umform.io.atomic import write_text

log = logging.getLogger("umform.bench")

#: Jobs that may wait, bytes of a deck, and starts of a job whose process dies without an outcome.
MOST_WAITING, LONGEST_DECK, MOST_STARTS = 200, 400_000, 3
#: Default limit of the folder in bytes.
USUAL_DISK = 10e9
#: Seconds between two checks of the processes, and until a process that was asked to stop is killed.
_POLL, _GRACE = 0.05, 10.0
#: The signal that ends a process at once; Windows knows no other one.
_KILL = getattr(signal, "SIGKILL", signal.SIGTERM)


class Queue:
    """Runs jobs, a given number at a time; its state is in the index and in the folders of the jobs.

    Parameters
    ----------
    folder : Path
        Folder of the bench.
    at_once : int
        Jobs at a time.
    disk : float
        Limit of all files of the folder in bytes.

    Attributes
    ----------
    index : Index
        The index.
    disk : Disk
        Its disk space.
    shelf : Shelf
        Drawn tools.
    spare : SpareProcess
        The process that waits for the next job.
    """

    def __init__(self, folder: Path, at_once: int = 1, disk: float = USUAL_DISK) -> None:
        self.folder, self.at_once = folder, at_once
        self.disk, self.shelf = Disk(folder, disk), Shelf(folder)
        self.spare = SpareProcess([sys.executable, "-m", "umform.bench.work"], folder / "jobs.log")
        (folder / "jobs").mkdir(parents=True, exist_ok=True)
        self.index = Index(folder)
        self._lock = threading.RLock()
        self._running: dict[str, subprocess.Popen[bytes] | None] = {}  # None: of an earlier server
        self._deadlines: dict[str, float] = {}  # jobs that were asked to stop, and when they are killed
        self._wake, self._closing = threading.Event(), threading.Event()
        self._thread = threading.Thread(target=self._loop, name="umform-bench-queue", daemon=True)

    def start(self) -> None:
        """Resume unfinished jobs of an earlier server, and start the queue."""
        for job in self.index.jobs(*UNFINISHED):
            if is_locked(self.folder_of(job.id)):
                self._running[job.id] = None
            elif not self._store_outcome(job):
                self.index.change(job.id, "waiting")
        self._thread.start()

    def close(self) -> None:
        """Stop all jobs after their increments; the next server resumes them."""
        self._closing.set()
        self._wake.set()
        self._thread.join(timeout=2 * _GRACE)
        with self._lock:
            for name in self._running:
                self._signal(name, signal.SIGTERM)
            until = time.monotonic() + _GRACE
            while any(self._is_alive(name) for name in self._running) and time.monotonic() < until:
                time.sleep(_POLL)
            for name in self._running:
                self._signal(name, _KILL)
                process = self._running[name]
                if process is not None:
                    with suppress(subprocess.TimeoutExpired):
                        process.wait(timeout=_GRACE)
                job = self.index.job(name)
                asked = name in self._deadlines
                if job is not None and not self._store_outcome(job, keep_waiting=not asked):
                    self.index.change(name, "stopped" if asked else "waiting", anew=True)
            self.spare.end()
            self.index.close()

    def folder_of(self, name: str) -> Path:
        """Folder of a job."""
        if not NAME.fullmatch(name):
            raise gone("there is no such job", "job", name)
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
        files: Mapping[str, Path] | None = None,
        more: Mapping[str, Any] | None = None,
    ) -> str:
        """Add a job and return its name.

        ``tools``: drawn tools by kind, ``files``: others by name, copied to it; ``more``: entries of its order.

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
            folder = self.folder_of(name)
            folder.mkdir()
            if deck:
                (folder / DECK).write_text(deck, encoding="utf-8")
            self.shelf.copy_to(folder, tools or {})
            for place, path in (files or {}).items():
                shutil.copyfile(path, folder / place)
            order = {"kind": kind, "title": title, "series": series, "parameters": dict(parameters), **(more or {})}
            write_text(folder / ORDER, json.dumps(order | {"created": time.time()}))
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
                self._deadlines.setdefault(name, time.monotonic() + _GRACE)
                self._signal(name, signal.SIGTERM)
            else:
                self.index.change(name, "stopped")

    def resume(self, name: str) -> None:
        """Resume a stopped or failed job: a deck from its checkpoint, a bend from its beginning."""
        with self._lock:
            job = self.index.job(name)
            if job is None or job.state not in ("stopped", "failed"):
                return
            (self.folder_of(name) / OUTCOME).unlink(missing_ok=True)
            self.index.change(name, "waiting", anew=True)
        self._wake.set()

    def remove(self, name: str) -> bool:
        """Delete a job that does not run, with its files; whether it does not."""
        with self._lock:
            if self.index.job(name) is None or name in self._running:
                return False
            self.index.remove(name)
            folder = self.folder_of(name)
            (folder / ORDER).unlink(missing_ok=True)  # first: a folder without it is no job
            shutil.rmtree(folder, ignore_errors=True)
            self.disk.expire()
        return True

    def live(self, name: str) -> dict[str, Any]:
        """Live data of a running job."""
        with suppress(OSError, ValueError):
            content: dict[str, Any] = json.loads((self.folder_of(name) / LIVE).read_text(encoding="utf-8"))
            return content
        return {}

    # ---- the thread ----

    def _loop(self) -> None:
        while not self._closing.is_set():
            try:
                full = self.disk.problem()
                with self._lock:
                    self._reap()
                    if full is None:
                        self._start_waiting()
                    else:
                        for name in self._running.keys() - self._deadlines.keys():
                            self.stop(name)
                    idle = not self._running
            except Exception:  # an error of one job must not stop the queue
                log.exception("the queue of the bench")
                idle = False
            self._wake.wait(1.0 if idle else _POLL)
            self._wake.clear()

    def _reap(self) -> None:
        """Store the outcomes of processes that have ended; kill those that do not stop."""
        for name in list(self._running):
            if self._is_alive(name):
                if time.monotonic() > self._deadlines.get(name, float("inf")):
                    self._signal(name, _KILL)
                continue
            del self._running[name]
            asked = self._deadlines.pop(name, None) is not None
            job = self.index.job(name)
            if job is None or self._store_outcome(job):
                continue
            if is_locked(self.folder_of(name)):  # by a process of an earlier server
                self._running[name] = None
            elif asked:
                self.index.change(name, "stopped")
            elif job.starts < MOST_STARTS:
                self.index.change(name, "waiting")
            else:
                error = UmformError(
                    f"its process ended {job.starts} times without a result",
                    where="job",
                    value=job.number,
                    cause="it was killed, perhaps for want of memory",
                    remedy="a coarser mesh, or fewer jobs at a time; jobs.log of the folder has its output",
                )
                self.index.change(name, "failed", reason=str(error), summary={"error": error_record(error)})

    def _start_waiting(self) -> None:
        """Start waiting jobs up to the limit; keep a spare process if none runs or more wait."""
        for job in self.index.jobs("waiting")[: max(0, self.at_once - len(self._running))]:
            process = self.spare.take()
            self.index.change(job.id, "running", start=True)
            self._running[job.id] = process
            assert process.stdin is not None
            with suppress(OSError):  # `_reap` finds a process that has ended meanwhile
                process.stdin.write(f"{self.folder_of(job.id).resolve()}\n".encode())
                process.stdin.close()
        if not self._running or self.index.jobs("waiting"):
            self.spare.start_if_needed()

    def _is_alive(self, name: str) -> bool:
        process = self._running[name]
        return is_locked(self.folder_of(name)) if process is None else process.poll() is None

    def _signal(self, name: str, number: signal.Signals) -> None:
        """Send a signal to the process of a job if it runs; the lock has the number of a process of an earlier server.

        SIGKILL goes to its whole group; on SIGTERM the job ends its children itself. On Windows both end the job at
        once, and its children end with it.
        """
        process = self._running[name]
        with suppress(OSError, ValueError):
            if not self._is_alive(name):
                return
            pid = process.pid if process is not None else int((self.folder_of(name) / LOCK).read_text())
            if number == _KILL and hasattr(os, "killpg") and os.getpgid(pid) == pid:
                os.killpg(pid, number)
            else:
                os.kill(pid, number)

    def _store_outcome(self, job: Job, *, keep_waiting: bool = False) -> bool:
        """Store the outcome of a job if there is one; ``keep_waiting``: a stopped job is resumed later."""
        path = self.folder_of(job.id) / OUTCOME
        try:
            outcome = json.loads(path.read_text(encoding="utf-8"))
            state, reason, summary = outcome["state"], outcome["reason"], outcome["summary"]
            if state == "stopped" and keep_waiting:
                path.unlink()
                return False
            self.index.change(job.id, state, reason=reason, summary=summary)
        except (OSError, ValueError, KeyError, AssertionError):
            return False
        return True


def result_file(queue: Queue, name: str, file: str, known: Callable[[str], bool]) -> Path:
    """A file of a job by its name.

    Raises
    ------
    UmformError
        If there is none, or jobs write no file of this name.
    """
    folder = queue.folder_of(name)
    path = folder / file if file == SHAPE else folder / RESULTS / file
    if not known(file) or path.is_symlink() or not path.is_file():
        raise UmformError(
            "there is no such file",
            where="file",
            value=file[:60],
            cause="the job has not got so far, or writes no such file",
            remedy="its page has links to its files",
        )
    return path

"""The index of all jobs: an SQLite file in the folder of the bench; it can be rebuilt from the folders of the jobs."""

from __future__ import annotations

import json
import sqlite3
import threading
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from umform.bench.folders import NAME

_TABLE = """
CREATE TABLE IF NOT EXISTS jobs (
    number INTEGER PRIMARY KEY AUTOINCREMENT,
    id TEXT UNIQUE NOT NULL,
    kind TEXT NOT NULL,
    title TEXT NOT NULL,
    series TEXT NOT NULL,
    parameters TEXT NOT NULL,
    state TEXT NOT NULL,
    reason TEXT NOT NULL,
    summary TEXT NOT NULL,
    created REAL NOT NULL,
    ended REAL,
    starts INTEGER NOT NULL,
    folder TEXT NOT NULL
)
"""
#: All states of a job. Unfinished ones are resumed when the bench starts again.
STATES = ("waiting", "running", "stopped", "done", "failed")
UNFINISHED = ("waiting", "running")
_FIELDS = "number, id, kind, title, series, parameters, state, reason, summary, created, ended, starts, folder"


@dataclass(frozen=True)
class Job:
    """A row of the index.

    Attributes
    ----------
    number : int
        Counted from 1.
    id : str
        Name of its folder.
    kind : str
        "bend" or "deck".
    title, series : str
        For people; jobs that were ordered together have the same series.
    parameters : dict
        What was ordered.
    state, reason : str
        One of `STATES`, and its reason.
    summary : dict
        Numbers of the result.
    created, ended : float or None
        Seconds since 1970.
    starts : int
        Number of starts since it was ordered, resumed, or handed on by a server.
    folder : str
        Folder of its files, relative to the folder of the bench.
    """

    number: int
    id: str
    kind: str
    title: str
    series: str
    parameters: dict[str, Any]
    state: str
    reason: str
    summary: dict[str, Any] = field(default_factory=dict)
    created: float = 0.0
    ended: float | None = None
    starts: int = 0
    folder: str = ""


class Index:
    """The index; calls may come from any thread.

    Parameters
    ----------
    folder : Path
        Folder of the bench. A file that is no database is renamed, and the index is rebuilt.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._lock = threading.Lock()
        path = folder / "bench.sqlite"
        try:
            self._open(path)
        except sqlite3.DatabaseError:
            path.replace(path.with_suffix(".broken"))
            for ending in ("-wal", "-shm"):
                with suppress(FileNotFoundError):
                    Path(f"{path}{ending}").unlink()
            self._open(path)
        self._add_missing()

    def _open(self, path: Path) -> None:
        self._base = sqlite3.connect(path, check_same_thread=False, isolation_level=None)
        self._base.execute("PRAGMA journal_mode = WAL")
        self._base.execute(_TABLE)
        self._base.execute("SELECT count(*) FROM jobs").fetchone()

    def _add_missing(self) -> None:
        """Add jobs that have a folder but no row, the oldest first."""
        known = {job.id for job in self.jobs()}
        found = []
        for path in (self.folder / "jobs").glob("*/job.json"):
            if NAME.fullmatch(path.parent.name) and path.parent.name not in known:
                with suppress(OSError, ValueError, KeyError, TypeError):
                    order = json.loads(path.read_text(encoding="utf-8"))
                    found.append((float(order["created"]), path.parent.name, order))
        for created, name, order in sorted(found, key=lambda one: one[:2]):
            with suppress(KeyError, TypeError, ValueError, sqlite3.Error):
                self.add(name, order["kind"], order["title"], order["series"], order["parameters"], created=created)

    def close(self) -> None:
        """Close the file."""
        with self._lock:
            self._base.close()

    @contextmanager
    def _query(self, text: str, values: tuple[Any, ...] = ()) -> Iterator[sqlite3.Cursor]:
        with self._lock:
            yield self._base.execute(text, values)

    def add(
        self,
        name: str,
        kind: str,
        title: str,
        series: str,
        parameters: Mapping[str, Any],
        *,
        created: float | None = None,
    ) -> None:
        """Add a job that waits."""
        at = time.time() if created is None else created
        row = (name, kind, title, series, json.dumps(parameters), "waiting", "", "{}", at, 0, f"jobs/{name}")
        text = (
            "INSERT INTO jobs (id, kind, title, series, parameters, state, reason, summary, created, starts, folder) "
            "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"
        )
        with self._query(text, row):
            pass

    def change(
        self,
        name: str,
        state: str,
        *,
        reason: str = "",
        summary: Mapping[str, Any] | None = None,
        start: bool = False,
        anew: bool = False,
    ) -> None:
        """Set the state of a job; ``anew``: its starts count from 0."""
        assert state in STATES
        ended = None if state in UNFINISHED else time.time()
        text = "UPDATE jobs SET state = ?, reason = ?, summary = ?, ended = ?, starts = ? * starts + ? WHERE id = ?"
        values = (state, reason[:4000], json.dumps(dict(summary or {})), ended, int(not anew), int(start), name)
        with self._query(text, values):
            pass

    def remove(self, name: str) -> None:
        """Delete a job."""
        with self._query("DELETE FROM jobs WHERE id = ?", (name,)):
            pass

    def job(self, name: str) -> Job | None:
        """A job by its name."""
        with self._query(f"SELECT {_FIELDS} FROM jobs WHERE id = ?", (name,)) as rows:
            row = rows.fetchone()
        return None if row is None else _job(row)

    def jobs(self, *states: str) -> list[Job]:
        """All jobs, or those of some states, in the order of their numbers."""
        where = f"WHERE state IN ({', '.join('?' * len(states))})" if states else ""
        with self._query(f"SELECT {_FIELDS} FROM jobs {where} ORDER BY number", states) as rows:
            return [_job(row) for row in rows.fetchall()]


def _job(row: tuple[Any, ...]) -> Job:
    job = Job(*row)
    return Job(**{**vars(job), "parameters": json.loads(row[5]), "summary": json.loads(row[8])})

"""The folder of a job: names of its files, and the lock that shows that its process runs."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from umform.io.locks import try_lock

#: Order, outcome, live data, 3D view and its present scene, lock, deck, folder of results.
ORDER, OUTCOME, LIVE, SHAPE, SCENE, LOCK, DECK, RESULTS = (
    "job.json",
    "outcome.json",
    "live.json",
    "shape.html",
    "scene.json",
    "lock",
    "deck.toml",
    "results",
)

#: Corrected metal, and the table that is issued again with it.
METAL, TABLE = "metal.toml", "table.json"

#: Names of the folders of jobs.
NAME = re.compile(r"[0-9a-f]{12}")


@contextmanager
def locked(folder: Path) -> Iterator[bool]:
    """Lock a job while it runs; False if another process has locked it."""
    with (folder / LOCK).open("a") as lock:
        if not try_lock(lock):
            yield False
            return
        lock.truncate(0)
        lock.write(str(os.getpid()))  # a later server sends its signals there
        lock.flush()
        yield True


def is_locked(folder: Path) -> bool:
    """Whether a process holds the lock of a job."""
    try:
        with (folder / LOCK).open("r") as lock:
            return not try_lock(lock, shared=True)
    except FileNotFoundError:
        return False
    except OSError:
        return True

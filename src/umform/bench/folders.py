"""The folder of a job: names of its files, and the lock by which others see that its process lives."""

from __future__ import annotations

import fcntl
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

#: What was ordered, what came of it, what it tells while it runs; the shape, and its present scene; the lock; a deck;
#: the folder of results.
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

#: Names of the folders of jobs.
NAME = re.compile(r"[0-9a-f]{12}")


@contextmanager
def owned(folder: Path) -> Iterator[bool]:
    """Hold the lock of a job while it runs; False if another process has it."""
    with (folder / LOCK).open("a") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            yield False
            return
        lock.truncate(0)
        lock.write(str(os.getpid()))  # whom a later server is to ask to stop
        lock.flush()
        yield True


def is_owned(folder: Path) -> bool:
    """Whether a process holds the lock of a job."""
    try:
        with (folder / LOCK).open("r") as lock:
            fcntl.flock(lock, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except FileNotFoundError:
        return False
    except OSError:
        return True
    return False

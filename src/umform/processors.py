"""Processors that this process may use, and those that no other process uses now.

>>> 1 <= free() <= available()
True
"""

from __future__ import annotations

import math
import os
from pathlib import Path


def threads() -> int:
    """Default number of threads: ``OMP_NUM_THREADS``, that of libraries too, or one for each free processor."""
    given = os.environ.get("OMP_NUM_THREADS", "").split(",")[0].strip()  # those of inner levels follow
    return int(given) if given.isdecimal() and int(given) > 0 else free()


def available() -> int:
    """Number of processors available to this process: its affinity, or the quota of its container if that is less."""
    count = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return max(1, math.ceil(min(count, _quota())))


def free() -> int:
    """Number of available processors that other processes leave: the default number of threads.

    Other processes count that ran for the last minute and run now: neither one that has just ended nor one that starts.
    """
    load, _, _, running = _words("/proc/loadavg", "0 0 0 1/1")[:4]  # mean of a minute, and threads that run now
    busy = min(float(load), int(running.split("/")[0]) - 1)
    return max(1, min(available(), (os.cpu_count() or 1) - round(busy)))


def _quota() -> float:
    """Processors' worth of time that the container may use."""
    limit, period = _words("/sys/fs/cgroup/cpu.max", "max 100000")
    if limit == "max":  # none, or those of the first version of control groups
        limit, period = (_words(f"/sys/fs/cgroup/cpu/cpu.cfs_{name}_us", "-1")[0] for name in ("quota", "period"))
    return math.inf if float(limit) <= 0.0 else float(limit) / float(period)


def _words(path: str, otherwise: str) -> list[str]:
    """Words of a file of the system, or others where it is missing or empty."""
    try:
        return Path(path).read_text(encoding="ascii").split() or otherwise.split()
    except OSError:
        return otherwise.split()

"""CPU seconds, wall seconds and peak memory of a program and all its children.

The program is started by a small Python of its own: Linux counts the memory of the process that starts another one
(until ``exec``) to the peak of the new one, so a runner with numpy in it would add itself to every small program.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

#: One thread everywhere: CPU seconds of several threads that wait for each other compare nothing.
ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBER_OF_CPUS", "CCX_NPROC_EQUATION_SOLVER"), "1"
)

#: CPU seconds after which a run is ended.
LIMIT = 900

_STARTER = f"""
import json, os, resource, sys, time
resource.setrlimit(resource.RLIMIT_CPU, ({LIMIT}, {LIMIT}))
begin = time.perf_counter()
pid = os.posix_spawnp(sys.argv[2], sys.argv[2:], os.environ)
_, status, used = os.wait4(pid, 0)
with open(sys.argv[1], "w") as file:
    json.dump([os.waitstatus_to_exitcode(status), used.ru_utime + used.ru_stime, time.perf_counter() - begin,
               used.ru_maxrss], file)
"""


@dataclass(frozen=True)
class Cost:
    """What a program took.

    Attributes
    ----------
    cpu, wall : float
        Seconds, user and system.
    memory : float
        Largest resident set in MB.
    """

    cpu: float
    wall: float
    memory: float


class Crashed(Exception):
    """A program that did not end well; the message has the end of its log."""


def measured(command: Sequence[str], folder: Path, cwd: Path | None = None) -> Cost:
    """Run a command on one thread; its output goes to ``log`` in the folder.

    Python may leave the byte code of what it imports, which a package that pip has installed has anyway.

    Raises
    ------
    Crashed
        If it ends with an error, or takes more than :data:`LIMIT`.
    """
    told = folder / "cost.json"
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"} | ONE_THREAD
    with (folder / "log").open("w") as log:
        starter = [sys.executable, "-S", "-E", "-c", _STARTER, str(told), *command]
        subprocess.run(starter, cwd=cwd, env=environment, stdout=log, stderr=subprocess.STDOUT, check=True)
    code, cpu, wall, kilobytes = json.loads(told.read_text())
    if code:
        tail = (folder / "log").read_text(errors="replace")[-600:]
        raise Crashed(f"{command[0]} ended with {code}: {tail}")
    return Cost(cpu, wall, kilobytes / 1e3)

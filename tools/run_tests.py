"""Tests in parallel workers: python tools/run_tests.py -n 2 [arguments of pytest].

pytest-xdist never ends if it replaces a worker that has died while it hands out whole files, and it skips the rest of
the file otherwise. So no worker is replaced, and a file whose worker has died runs again, in a process of its own.
`pytest_testnodedown` in tests/python/conftest.py prints the exit status of the worker.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys

#: Lines of pytest's summary: a test that has failed, or in which a worker has died.
_FAILED = re.compile(r"^(?:FAILED|ERROR) (\S+)")
_DIED = re.compile(r"^FAILED ([^:\s]+)\S* - worker '\w+' crashed")


def main(arguments: list[str]) -> int:
    """Exit code of pytest, of the second run where only workers have died."""
    pytest = [sys.executable, "-m", "pytest", "-q", "-m", "not long"]
    code, lines = _run([*pytest, "--dist", "loadfile", "--max-worker-restart=0", *arguments])
    again, others = crashed(lines)
    if code != 1 or others or not again:
        return code
    print(f"Workers have died; their tests run again in one process: {' '.join(again)}", flush=True)
    return _run([*pytest, *again])[0]


def crashed(lines: list[str]) -> tuple[list[str], list[str]]:
    """Files whose worker has died, and the tests that have failed themselves."""
    died = [match[1] for line in lines if (match := _DIED.match(line))]
    failed = [match[1] for line in lines if (match := _FAILED.match(line)) and not _DIED.match(line)]
    return sorted(set(died)), failed


def _run(command: list[str]) -> tuple[int, list[str]]:
    """Exit code and lines of a command, which are printed as they come."""
    lines = []
    wide = {**os.environ, "COLUMNS": "240"}  # pytest cuts its summary at the width of the terminal
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=wide) as process:
        assert process.stdout is not None
        for line in process.stdout:
            print(line, end="", flush=True)
            lines.append(line)
    return process.returncode, lines


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

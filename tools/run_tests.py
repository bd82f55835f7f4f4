"""Tests in parallel workers: python tools/run_tests.py -n 2 [arguments of pytest].

pytest-xdist never ends if it replaces a worker that has died while it hands out whole files. Otherwise it hands out no
more files, and skips the rest of that one. So no worker is replaced, and all files that are not complete then run in
one process. `pytest_testnodedown` in tests/python/conftest.py prints the exit status of the worker.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from xml.etree import ElementTree

#: Exit code of pytest where it fails itself.
_INTERNAL = 3
#: Lines of pytest's summary: a test that has failed, or in which a worker has died.
_FAILED = re.compile(r"^(?:FAILED|ERROR) (\S+)")
_DIED = re.compile(r"^FAILED ([^:\s]+)\S* - worker '\w+' crashed")


def main(arguments: list[str]) -> int:
    """Exit code of pytest, of the second run where only workers have died."""
    pytest = [sys.executable, "-m", "pytest", "-q", "-m", "not long", *arguments]
    with TemporaryDirectory() as folder:
        report = Path(folder) / "report.xml"
        parallel = ["--dist", "loadfile", "--max-worker-restart=0", "-o", "junit_family=xunit1"]
        code, lines = _run([*pytest, *parallel, f"--junitxml={report}"])
        again, others = crashed(lines)
        lost = code == _INTERNAL  # a file was handed to a worker that had just died; others are cut off
        if not lost and (code != 1 or others or not again):
            return code
        complete = [] if lost else sorted(begun(report) - set(again))
    print("Workers have died; the files that are not complete run in one process", *again, flush=True)
    return _run([*pytest, "-n", "0", *(f"--deselect={file}::" for file in complete)])[0]


def begun(report: Path) -> set[str]:
    """Files with a test in a report; a worker that must end completes the files it has."""
    return {case.attrib["file"] for case in ElementTree.parse(report).iter("testcase") if "file" in case.attrib}


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

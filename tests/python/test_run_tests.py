"""Tests in workers: where one dies, its file and those that have not begun run in one process; no failed test does."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

TOOL = Path(__file__).resolve().parents[2] / "tools" / "run_tests.py"

FILE = """
import os

def test_one(): pass

def test_two():
    {two}

def test_three(): pass
"""
#: Leaves a file of its own name: pytest-xdist hands out no more test files once a worker has died.
OTHER = """
from pathlib import Path

def test_four(): Path(__file__).with_suffix(".ran").touch()

def test_five(): pass
"""
DIES = "os.environ.get('PYTEST_XDIST_WORKER') and os._exit(3)"


CASES = [(DIES, 0, "passed", True), ("assert os is None", 1, "1 failed, 18 passed", False)]


@pytest.mark.parametrize(("two", "code", "last", "again"), CASES)
def test_files_of_dead_workers_run_again(tmp_path, two, code, last, again):
    (tmp_path / "pytest.ini").write_text("[pytest]\nmarkers = long\n")
    (tmp_path / "test_a.py").write_text(FILE.format(two=two))
    for name in "bcdefghi":
        (tmp_path / f"test_{name}.py").write_text(OTHER)
    own = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST")}
    done = subprocess.run(
        [sys.executable, TOOL, "-n", "2"],
        cwd=tmp_path,
        env=own,
        capture_output=True,
        text=True,
        timeout=200,
        check=False,
    )
    assert done.returncode == code, done.stdout + done.stderr
    assert last in done.stdout.splitlines()[-1]
    assert ("Workers have died" in done.stdout) == again
    assert {file.stem[-1] for file in tmp_path.glob("*.ran")} == set("bcdefghi")

"""Tests in workers: a file whose worker dies runs again in one process, a test that fails does not."""

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
DIES = "os.environ.get('PYTEST_XDIST_WORKER') and os._exit(3)"


CASES = [(DIES, 0, "3 passed", True), ("assert os is None", 1, "1 failed, 4 passed", False)]


@pytest.mark.parametrize(("two", "code", "last", "again"), CASES)
def test_files_of_dead_workers_run_again(tmp_path, two, code, last, again):
    (tmp_path / "pytest.ini").write_text("[pytest]\nmarkers = long\n")
    (tmp_path / "test_a.py").write_text(FILE.format(two=two))
    (tmp_path / "test_b.py").write_text("def test_four(): pass\n\ndef test_five(): pass\n")
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
    assert ("run again" in done.stdout) == again

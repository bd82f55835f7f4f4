"""Whose a temporary file is: of a process that runs, that has ended, or that nobody knows."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from umform.io.owner import is_left_behind, mark


def mark_of(pid):
    return mark().rpartition("-")[0] + f"-{pid}"


def test_what_belongs_to_this_process_or_to_another_machine_is_not_left_behind(tmp_path):
    assert not is_left_behind(tmp_path, mark())
    assert not is_left_behind(tmp_path, f"elsewhere-{os.getpid()}")


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
def test_a_process_that_was_killed_and_that_nobody_has_waited_for_has_ended(tmp_path):
    with subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"]) as process:
        whose = mark_of(process.pid)
        assert not is_left_behind(tmp_path, whose)
        process.kill()
        stat = Path(f"/proc/{process.pid}/stat")
        for _ in range(1000):
            if ") Z " in stat.read_text():
                break
            time.sleep(0.01)
        assert ") Z " in stat.read_text()
        assert is_left_behind(tmp_path, whose)
    assert is_left_behind(tmp_path, whose)


def test_without_a_mark_the_age_decides(tmp_path):
    assert not is_left_behind(tmp_path, "")
    os.utime(tmp_path, (time.time() - 3600,) * 2)
    assert is_left_behind(tmp_path, "")

"""Room on the disk, and the token, which other users of the machine must not see."""

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from urllib.parse import urlparse

import pytest

from umform.bench.jobs import Queue
from umform.bench.limits import Disk, DiskFull

WAITING = "import sys; sys.stdin.readline()"


def test_folder_has_as_much_as_it_may(tmp_path):
    (tmp_path / "deep" / "er").mkdir(parents=True)
    (tmp_path / "deep" / "er" / "file").write_bytes(b"x" * 1000)
    (tmp_path / "link").symlink_to("/")
    assert Disk(tmp_path, 1e5).problem() is None
    disk = Disk(tmp_path, 900)
    found = disk.problem()
    assert isinstance(found, DiskFull) and "--disk" in found.remedy
    (tmp_path / "deep" / "er" / "file").unlink()
    disk.expire()
    assert disk.problem() is None


def test_full_folder_takes_no_job_and_starts_none(tmp_path):
    queue = Queue(tmp_path, disk=1e6)
    queue.spare.command = [sys.executable, "-S", "-c", WAITING]
    name = queue.add("deck", "strip", {}, deck="x")
    (tmp_path / "large").write_bytes(b"x" * 2_000_000)
    queue.disk.expire()
    with pytest.raises(DiskFull):
        queue.add("deck", "strip", {}, deck="x")
    queue.start()
    time.sleep(0.3)
    assert queue.index.job(name).state == "waiting"
    (tmp_path / "large").unlink()
    queue.disk.expire()
    until = time.monotonic() + 30
    while queue.index.job(name).state == "waiting" and queue.index.job(name).starts == 0:
        assert time.monotonic() < until
        time.sleep(0.02)
    queue.close()


def test_running_job_is_stopped_when_the_folder_is_full(tmp_path):
    queue = Queue(tmp_path, disk=1e6)
    queue.spare.command = [sys.executable, "-S", "-c", f"{WAITING}; import time; time.sleep(100)"]
    name = queue.add("deck", "strip", {}, deck="x")
    queue.start()
    until = time.monotonic() + 30
    while queue.index.job(name).state != "stopped":
        assert time.monotonic() < until
        if queue.index.job(name).state == "running":
            (tmp_path / "large").write_bytes(b"x" * 2_000_000)
            queue.disk.expire()
        time.sleep(0.05)
    queue.close()


def test_arguments_of_the_browser_have_no_token(tmp_path):
    browser, seen = tmp_path / "browser", tmp_path / "seen"
    browser.write_text(f'#!/bin/sh\nprintf %s "$1" > "{seen}.new"\nmv "{seen}.new" "{seen}"\n')
    browser.chmod(0o755)
    command = [sys.executable, "-m", "umform", "bench", "--folder", str(tmp_path / "b"), "--port", "0"]
    environment = {**os.environ, "BROWSER": str(browser)}
    server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment)
    link = re.search(r"http://\S+", server.stdout.readline())[0]
    until = time.monotonic() + 60
    while not seen.exists():
        assert time.monotonic() < until
        time.sleep(0.05)
    told = seen.read_text()
    assert link.partition("token=")[2] not in told
    door = Path(urlparse(told).path)
    assert door.stat().st_mode & 0o077 == 0 and link in door.read_text()
    server.send_signal(signal.SIGINT)
    server.communicate(timeout=60)
    assert not door.exists()

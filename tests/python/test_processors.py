"""Processors that may be used, and those that are free: affinity, quota of a container, other processes."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from umform import processors


@pytest.fixture
def machine(monkeypatch):
    """A machine of so many processors with a load of a minute, running threads, and files of control groups."""

    def made(count, allowed, load=0.0, running=1, files=()):
        texts = {"/proc/loadavg": f"{load} 0 0 {running}/200 77"}
        texts |= {f"/sys/fs/cgroup/{name}": text for name, text in dict(files).items()}
        monkeypatch.setattr(os, "cpu_count", lambda: count)
        monkeypatch.setattr(os, "sched_getaffinity", lambda _: set(range(allowed)), raising=False)
        monkeypatch.setattr(processors, "_words", lambda path, otherwise: texts.get(path, otherwise).split())

    return made


@pytest.mark.parametrize(
    ("allowed", "files", "expected"),
    [
        (8, {}, 8),
        (3, {}, 3),
        (8, {"cpu.max": "max 100000"}, 8),
        (8, {"cpu.max": "250000 100000"}, 3),
        (8, {"cpu.max": "1000 100000"}, 1),
        (8, {"cpu/cpu.cfs_quota_us": "200000", "cpu/cpu.cfs_period_us": "100000"}, 2),
        (8, {"cpu/cpu.cfs_quota_us": "-1", "cpu/cpu.cfs_period_us": "100000"}, 8),
    ],
)
def test_affinity_and_quota(machine, allowed, files, expected):
    machine(8, allowed, files=files)
    assert processors.available() == processors.free() == expected


@pytest.mark.parametrize(
    ("load", "running", "expected"),
    [(0.0, 1, 8), (3.1, 4, 5), (3.1, 1, 8), (0.2, 4, 8), (40.0, 60, 1)],
    ids=["nobody", "three others", "others that have ended", "others that begin", "more than there is room for"],
)
def test_processors_that_others_use(machine, load, running, expected):
    machine(8, 8, load, running)
    assert (processors.available(), processors.free()) == (8, expected)


def test_a_few_processors_of_a_large_machine_that_others_use(machine):
    machine(64, 4, load=50.0, running=52)
    assert processors.free() == 4


def test_a_system_without_these_files(monkeypatch):
    def missing(*_, **__):
        raise FileNotFoundError

    monkeypatch.setattr(processors.Path, "read_text", missing)
    monkeypatch.setattr(os, "getloadavg", missing, raising=False)  # it reads /proc as well
    assert processors.free() == processors.available() >= 1


@pytest.mark.parametrize(("given", "expected"), [(None, 1), ("3", 3), ("4,2", 4), ("many", 1), ("0", 1)])
def test_threads_are_the_free_processors_unless_the_user_says_how_many(given, expected):
    environment = {name: value for name, value in os.environ.items() if name != "OMP_NUM_THREADS"}
    environment |= {} if given is None else {"OMP_NUM_THREADS": given}
    code = "from umform import processors; processors.free = lambda: 1; import umform; print(umform.threads())"
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
    assert int(done.stdout) == expected

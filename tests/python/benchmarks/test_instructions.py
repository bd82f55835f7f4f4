"""The guard of the instruction counts sees a kernel that has changed, with the same compiler and with another one."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from umform import _core

SCRIPT = Path(__file__).parents[3] / "benchmarks" / "instructions.py"


@pytest.fixture
def guard(script):
    return script("instructions")


@pytest.mark.parametrize(("build", "tolerated", "seen"), [("same", 1.015, 1.03), ("other", 1.2, 1.5)])
def test_one_slower_kernel_is_seen(guard, tmp_path, monkeypatch, capsys, build, tolerated, seen):
    counts = json.loads(SCRIPT.with_suffix(".json").read_text())["counts"]
    stored = tmp_path / "stored.json"
    stored.write_text(json.dumps({"build": _core.build() if build == "same" else "another", "counts": counts}))
    monkeypatch.setattr(guard, "STORED", stored)
    name = "MI9K3DEAS, SVK"
    assert guard.compare(counts) == 0
    assert guard.compare(counts | {name: tolerated * counts[name]}) == 0
    capsys.readouterr()
    assert guard.compare(counts | {name: seen * counts[name]}) == 1
    assert f": {name}." in capsys.readouterr().out


def test_another_compiler_may_count_otherwise_as_long_as_shares_stay(guard, tmp_path, monkeypatch):
    counts = json.loads(SCRIPT.with_suffix(".json").read_text())["counts"]
    stored = tmp_path / "stored.json"
    stored.write_text(json.dumps({"build": "another", "counts": counts}))
    monkeypatch.setattr(guard, "STORED", stored)
    assert guard.compare({name: 2.0 * count for name, count in counts.items()}) == 0


def test_every_kernel_is_stored(guard):
    counts = json.loads(SCRIPT.with_suffix(".json").read_text())["counts"]
    assert list(counts) == [f"{name}, {law}" for name, law in guard.KERNELS]

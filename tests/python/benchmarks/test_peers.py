"""The comparison with other codes: what it measures, and a short run of it beside CalculiX."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

PEERS = Path(__file__).parents[3] / "benchmarks" / "peers"


@pytest.fixture
def load(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Import a module of the folder as its scripts do."""
    monkeypatch.syspath_prepend(str(PEERS))

    def imported(name: str) -> ModuleType:
        return __import__(name)

    yield imported
    for name, module in list(sys.modules.items()):
        if Path(getattr(module, "__file__", None) or "/").parent == PEERS:
            del sys.modules[name]


def test_cost_is_that_of_the_program_and_not_of_the_runner(load: Any, tmp_path: Path) -> None:
    ours = np.ones(40_000_000)  # 320 MB in this process
    program = "import time; b = bytearray(60_000_000)\nwhile time.process_time() < 0.3: pass"
    cost = load("measure").measured([sys.executable, "-S", "-c", program], tmp_path)
    assert 60 < cost.memory < 200
    assert 0.3 <= cost.cpu < 1.0
    assert ours.sum() == len(ours)


def test_a_program_that_fails_is_told_with_its_log(load: Any, tmp_path: Path) -> None:
    measure = load("measure")
    with pytest.raises(measure.Crashed, match="ended with 3: no such luck"):
        measure.measured([sys.executable, "-c", "print('no such luck'); raise SystemExit(3)"], tmp_path)


@pytest.mark.parametrize("cell", ["hex8", "hex18", "hex20", "quad4"])
def test_a_problem_survives_its_file(load: Any, tmp_path: Path, cell: str) -> None:
    made = load("hemisphere").build(2, cell) if cell == "quad4" else load("bent_strip").build(2, 1, cell)
    made.save(tmp_path / "problem.npz")
    read = load("problem").Problem.load(tmp_path / "problem.npz")
    assert (read.cell, read.tool, read.flow, read.unknowns) == (cell, made.tool, made.flow, made.unknowns)
    assert set(read.probes) == set(made.probes)
    assert np.array_equal(read.points, made.points)
    assert np.array_equal(read.cells, made.cells)


def test_midside_nodes_lie_between_their_corners(load: Any) -> None:
    points, cells = load("meshes").grid([0, 1, 3], [0, 2], [0, 1], "hex20")
    edges = load("meshes").EDGES
    assert len(points) == 12 + 20
    for k, (a, b) in enumerate(edges):
        assert np.allclose(points[cells[:, 8 + k]], 0.5 * (points[cells[:, a]] + points[cells[:, b]]))


def test_a_ratio_above_one_is_better_for_umform(load: Any) -> None:
    entries, measure, ratios = load("entries"), load("measure"), load("ratios")

    def run(peer: str, cpu: float, start_up: float) -> Any:
        entry = entries.Entry(peer, "E", "mesh", lambda: None)
        cost = measure.Cost(cpu, cpu, 100.0 * cpu)
        return entry, entries.Outcome(cost, start_up, unknowns=1, increments=1, iterations=10, solver="", probes={})

    found = {"own": run("umform", 2.0, 1.0), "other": run("CalculiX", 10.0, 0.0)}
    for goal, verdict in ((5.0, "met"), (8.0, "missed (met without start-up)"), (11.0, "missed")):
        row = ratios.ratios("a", found, [ratios.Comparison("same", "own", "other", goal)])[0]
        assert row[4:] == ["5", "10", "1", "5", f"{goal:g}", verdict]
    assert ratios.ratios("a", found, [ratios.Comparison("same", "other", "own")])[0][-1] == "slower"


def test_codes_that_are_not_there_are_skipped(tmp_path: Path) -> None:
    told = _run("--short", "c", "--python", f"Kratos={tmp_path / 'none'}", environment={"PATH": ""})
    assert "CalculiX: not installed, skipped; install with apt install calculix-ccx" in told
    assert "umform ANS3DEAS, 20 x 8" in told
    assert "CalculiX C3D8I" not in told


@pytest.mark.skipif(not shutil.which("ccx"), reason="CalculiX is not installed")
def test_short_run_beside_calculix(tmp_path: Path) -> None:
    _run("--short", "a", "c", "--out", str(tmp_path / "results.md"))
    record = json.loads((tmp_path / "results.json").read_text())
    own, other = (record["a"]["runs"][run] for run in ("umform BEND8, 24 x 1 x 1", "CalculiX C3D8I, 24 x 1 x 2"))
    assert own["force"][-1] == pytest.approx(other["force"][-1], rel=0.1)
    assert own["increments"] == other["increments"] - 1 == 4  # the short first step
    own, other = (record["c"]["runs"][f"{run}, 20 x 8"] for run in ("umform ANS3DEAS", "CalculiX C3D8I"))
    assert own["probes"]["end"][2] == pytest.approx(other["probes"]["end"][2], rel=0.05)
    assert (
        "| c | same mesh | umform ANS3DEAS, 20 x 8 | CalculiX C3D8I, 20 x 8 |" in (tmp_path / "results.md").read_text()
    )


def _run(*arguments: str, environment: dict[str, str] | None = None) -> str:
    told = subprocess.run(
        [sys.executable, str(PEERS / "run.py"), *arguments],
        env=os.environ | (environment or {}),
        capture_output=True,
        text=True,
        check=False,
    )
    assert told.returncode == 0, told.stderr
    return told.stdout

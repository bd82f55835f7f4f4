import runpy
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]


@pytest.mark.skipif(not (ROOT / "examples").is_dir(), reason="the examples are not here")
def test_free_bending_example_writes_its_files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    spaces = runpy.run_path(str(ROOT / "examples/free_bending.py"))
    assert abs(spaces["result"]["punch_force"][-1]) < 1e-4
    assert {path.name for path in tmp_path.iterdir()} == {"bending.png", "bending.vtkhdf", "bending.html"}

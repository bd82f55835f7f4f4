import pytest

#: Half of a strip, pulled along x and released: plane strain, uniaxial, without lateral strain.
STRIP = """
title = "pull"
[mesh]
generator = "strip"
length = 10.0
width = 2.0
thickness = 1.0
cells = [4, 1]
[material]
law = "SVK"
E = 210e3
nu = 0.0
[[supports]]
kind = "symmetry"
nodes = "x0"
normal = "x"
[[supports]]
kind = "fix"
nodes = { min = [-inf, -inf, -inf] }
directions = "y"
[[supports]]
kind = "fix"
nodes = "lower"
directions = "z"
[controls.pull]
kind = "displacement"
nodes = "x1"
direction = "x"
[[steps]]
kind = "move"
to = { pull = 0.1 }
increments = 2
[[steps]]
kind = "release"
control = "pull"
"""


@pytest.fixture
def deck(tmp_path, monkeypatch):
    """A deck that runs in no time, in a folder of its own."""
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "pull.toml"
    path.write_text(STRIP)
    return path

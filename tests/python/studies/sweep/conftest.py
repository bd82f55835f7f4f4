import pytest

FIXED = """
[[supports]]
kind = "fix"
nodes = "x0"
"""
#: Half of a strip without lateral strain.
SLIDING = """
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
"""
RELEASE = """
[[steps]]
kind = "release"
control = "pull"
"""


@pytest.fixture
def deck(strip, tmp_path, monkeypatch):
    """A strip that is pulled along x and released, in a folder of its own: plane strain, uniaxial."""
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "pull.toml"
    assert FIXED in strip
    text = strip.replace(FIXED, SLIDING).replace("nu = 0.3", "nu = 0.0").replace("[4, 2]", "[4, 1]")
    path.write_text('title = "pull"' + text + RELEASE)
    return path

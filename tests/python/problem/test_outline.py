"""Blanks of any outline in decks: holes, sets, and sizes that follow the tools."""

import re
import tomllib

import numpy as np
import pytest
from typer.testing import CliRunner

from umform.cli import app
from umform.problem import Problem
from umform.problem.errors import DeckError
from umform.problem.templates import template

pytest.importorskip("gmsh", reason="the extra mesh is not installed", exc_type=(ImportError, OSError))

MESH = """
[mesh]
generator = "outline"
outline = { corners = [[0.0, 0.0], [75.0, 0.0], [75.0, 75.0], [0.0, 75.0]], radii = [0.0, 0.0, 20.0, 0.0] }
holes = [{ segments = [{ kind = "arc", start = [23.0, 15.0], end = [23.0, 15.0], centre = [15.0, 15.0] }] }]
thickness = 0.81
size = 6.0
"""


def deck_text(more=""):
    """The square cup from a blank with a round corner and a hole."""
    text = template("square-cup").replace('edge = ["x1", "y1"]', 'edge = ["edge_1", "edge_2", "edge_3"]')
    text = text.replace('nodes = "x0"', 'nodes = "edge_4"').replace('nodes = "y0"', 'nodes = "edge_0"')
    return (
        text[: text.index("[mesh]")]
        + MESH
        + more
        + "\n"
        + text[text.index("[element]") :].replace("BEND18", "ANS3DEAS")
    )


def test_a_blank_with_a_hole():
    assert tomllib.loads(deck_text())["mesh"]["size"] == 6.0
    mesh = Problem.read(deck_text()).build().model.mesh
    hole = mesh.points[mesh.nodes("hole_0"), :2]
    np.testing.assert_allclose(np.hypot(*(hole - 15.0).T), 8.0, rtol=1e-6)
    assert np.ptp(mesh.points, axis=0) == pytest.approx([75.0, 75.0, 0.81])


def test_sizes_follow_the_tools_and_are_printed_and_drawn(tmp_path):
    problem = Problem.read(deck_text("turn = 45.0").replace("size = 6.0", "size = 12.0")).build()
    assert problem.sizes(39.0, 10.0) == pytest.approx(np.radians(45.0) * 5.405, rel=0.02)  # edge of the die: 5 + t/2
    assert problem.sizes(5.0, 5.0) == 12.0
    assert len(problem.model.mesh.connectivity) > 2 * 75.0**2 / 12.0**2
    file, picture = tmp_path / "deck.toml", tmp_path / "blank.png"
    file.write_text(deck_text("turn = 45.0").replace("size = 6.0", "size = 12.0"))
    shown = CliRunner().invoke(app, ["check", str(file), "--blank", str(picture)])
    turn = re.search(r"turn by up to ([\d.]+) degrees", " ".join(shown.stdout.split()))
    assert shown.exit_code == 0 and turn is not None and 25.0 < float(turn[1]) <= 45.0
    assert picture.read_bytes()[1:4] == b"PNG"


def test_sizes_follow_the_tools_of_a_part_of_the_faces():
    text = deck_text("turn = 45.0").replace("size = 6.0", "size = 12.0")
    everywhere = "{ min = [-inf, -inf, -inf] }"
    assert text.count('faces = "lower"') == 1
    part = text.replace('faces = "lower"', f'faces = {{ intersection = ["lower", {everywhere}] }}')
    assert Problem.read(part).build().sizes(39.0, 10.0) == Problem.read(text).build().sizes(39.0, 10.0) < 12.0
    with pytest.raises(DeckError, match=r"on which side of the blank(.*\n)*.*contacts.die \(faces\)"):
        Problem.read(text.replace('faces = "lower"', f"faces = {everywhere}")).build()


def test_a_symmetry_of_nodes_in_no_plane_is_a_warning(tmp_path):
    """The arc of a radius is an edge too, so that the one at x = 0 is edge_4."""
    file = tmp_path / "deck.toml"
    for edge, wrong in (("edge_4", False), ("edge_3", True)):
        file.write_text(deck_text().replace("edge_4", edge).replace("size = 6.0", "size = 12.0"))
        shown = " ".join(CliRunner().invoke(app, ["check", str(file)]).stdout.split())
        assert ("in no plane" in shown) is wrong


def test_mistakes():
    with pytest.raises(DeckError, match="another unit"):
        Problem.read(deck_text().replace("size = 6.0", "size = 1e-3")).build()
    clockwise = "corners = [[0.0, 75.0], [75.0, 75.0], [75.0, 0.0], [0.0, 0.0]]"
    corners = "corners = [[0.0, 0.0], [75.0, 0.0], [75.0, 75.0], [0.0, 75.0]]"
    with pytest.raises(DeckError, match="another unit"):
        Problem.read(deck_text().replace("size = 6.0", "size = 1e-3").replace(corners, clockwise)).build()
    with pytest.raises(DeckError, match="closed"):
        Problem.read(deck_text().replace("radii = [0.0, 0.0, 20.0, 0.0]", "closed = false")).build()

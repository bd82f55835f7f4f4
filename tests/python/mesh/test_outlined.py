"""Blanks of any outline, with holes."""

import signal
import subprocess
import sys

import numpy as np
import pytest

import umform as uf
from umform.errors import InvalidValue, MeshError, WrongCellType
from umform.surfaces import Arc, Line

pytest.importorskip("gmsh", reason="the extra mesh is not installed", exc_type=(ImportError, OSError))

#: A rectangle of 40 x 20 with one round end, and a round hole in it.
OUTLINE = uf.Profile(
    [
        Line((0.0, 0.0), (40.0, 0.0)),
        Arc((40.0, 0.0), (40.0, 20.0), (40.0, 10.0)),
        Line((40.0, 20.0), (0.0, 20.0)),
        Line((0.0, 20.0), (0.0, 0.0)),
    ]
)
HOLE = uf.Profile([Arc((25.0, 10.0), (25.0, 10.0), (20.0, 10.0))])


def _area(mesh):
    half = mesh.connectivity.shape[1] // 2
    a, b, c, d = (mesh.points[mesh.connectivity[:, k], :2] for k in range(4))
    assert half in (4, 9)
    return 0.5 * ((c - a)[:, 0] * (d - b)[:, 1] - (c - a)[:, 1] * (d - b)[:, 0])


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
def test_outline_with_a_hole(cell):
    blank = uf.mesh.blank(OUTLINE, 1.0, 2.0, holes=[HOLE], cell=cell, layers=2)
    area = _area(blank)
    assert area.min() > 0.2
    assert area.sum() / 2 == pytest.approx(800 + 50 * np.pi - 25 * np.pi, rel=0.01)
    around = blank.points[blank.nodes("hole_0"), :2] - [20.0, 10.0]
    np.testing.assert_allclose(np.hypot(*around.T), 5.0, rtol=1e-6)
    end = blank.points[blank.nodes("edge_1"), :2] - [40.0, 10.0]
    np.testing.assert_allclose(np.hypot(*end.T), 10.0, rtol=1e-6)
    assert np.abs(blank.points[blank.nodes("edge_3"), 0]).max() < 1e-9
    assert set(blank.nodes("edge_0")) <= set(blank.nodes("rim"))


def test_sizes_follow_the_arcs_of_the_blank():
    """With 8 mm everywhere the hole would be a hexagon."""
    blank = uf.mesh.blank(OUTLINE, 1.0, 8.0, holes=[HOLE])
    around = blank.points[blank.nodes("hole_0_lower"), :2] - [20.0, 10.0]
    angles = np.sort(np.arctan2(*around.T[::-1]))
    assert np.diff(angles, append=angles[0] + 2 * np.pi).max() < np.radians(31.0)
    away = [0.0, 0.0] - blank.points[blank.connectivity[:, :4], :2].mean(axis=1)
    assert _area(blank)[np.linalg.norm(away, axis=1).argmin()] > 20.0


def test_sizes_follow_a_function_and_the_mesh_is_the_same_each_time():
    fine = uf.mesh.blank(OUTLINE, 1.0, lambda x, y: 1.0 if x > 30 else 4.0)
    again = uf.mesh.blank(OUTLINE, 1.0, lambda x, y: 1.0 if x > 30 else 4.0)
    assert np.array_equal(fine.points, again.points) and np.array_equal(fine.connectivity, again.connectivity)
    where = fine.points[fine.connectivity].mean(axis=1)[:, 0]
    area = _area(fine)
    assert np.median(area[where > 35]) < 0.25 * np.median(area[where < 15])


def test_a_blank_can_be_drawn_on():
    blank = uf.mesh.blank(OUTLINE, 1.0, 4.0, holes=[HOLE])
    model = uf.Model(blank, material=uf.SVK(E=210e3, nu=0.3))
    model.fix("edge_3")
    pull = model.prescribe("edge_1", "x", "pull")
    result = uf.solve(model, uf.Move(pull, 0.01, steps=1), progress=False)
    assert result["pull_force"][-1] > 0


@pytest.mark.parametrize(
    "wrong",
    [
        {"thickness": 0.0},
        {"size": -1.0},
        {"outline": uf.Profile([Line((0.0, 0.0), (1.0, 0.0))], closed=False)},
        {"cell": "tet4"},
    ],
)
def test_what_is_no_blank_is_refused(wrong):
    with pytest.raises((InvalidValue, WrongCellType)):
        uf.mesh.blank(**({"outline": OUTLINE, "thickness": 1.0, "size": 2.0} | wrong))


def test_an_open_curve_is_named():
    with pytest.raises(InvalidValue, match="closed") as caught:
        uf.mesh.blank(OUTLINE, 1.0, 2.0, holes=[HOLE, uf.Profile([Line((0.0, 0.0), (1.0, 0.0))], closed=False)])
    assert caught.value.value == "hole 1"


@pytest.mark.parametrize(("x", "radius"), [(38.0, 3.0), (48.0, 3.0), (20.0, 5.0), (22.0, 5.0), (16.0, 10.0)])
def test_curves_that_meet_are_refused(x, radius):
    """gmsh searched for ever for a mesh around a hole that is there twice."""
    with pytest.raises(MeshError, match="curves of the blank meet"):
        uf.mesh.blank(OUTLINE, 1.0, 2.0, holes=[HOLE, uf.Profile.circle((x, 3.0 if x > 30 else 10.0), radius)])


@pytest.mark.parametrize(
    ("holes", "message"),
    [
        ([uf.Profile.circle((70.0, 10.0), 5.0)], "outside of the outline"),
        ([uf.Profile.circle((20.0, 10.0), 200.0)], "outside of the outline"),
        ([HOLE, uf.Profile.circle((20.0, 10.0), 2.0)], "in another one"),
        ([uf.Profile.circle((20.0, 10.0), 2.0), HOLE], "in another one"),
    ],
)
def test_holes_lie_side_by_side_in_the_outline(holes, message):
    """A hole around the outline gave a blank that was the metal between them."""
    with pytest.raises(MeshError, match=message):
        uf.mesh.blank(OUTLINE, 1.0, 2.0, holes=holes)


def test_holes_may_have_sides_on_one_line():
    square = [(5.0, 5.0), (9.0, 5.0), (9.0, 9.0), (5.0, 9.0)]
    beside = [uf.Profile.from_corners([(x + step, y) for x, y in square]) for step in (0.0, 6.0, 12.0)]
    blank = uf.mesh.blank(OUTLINE, 1.0, 2.0, holes=beside)
    assert _area(blank).sum() == pytest.approx(800 + 50 * np.pi - 48, rel=0.01)


@pytest.mark.parametrize("length", [3.0, 0.5, 0.01])
@pytest.mark.parametrize("size", [6.0, lambda x, y: 6.0], ids=["number", "function"])
def test_lines_and_arcs_may_be_shorter_than_elements(length, size):
    """gmsh found no mesh where a line was shorter than half of the size."""
    corners = [(0.0, 0.0), (40.0, 0.0), (40.0, length), (40.0 + length, length), (40.0 + length, 20.0), (0.0, 20.0)]
    blank = uf.mesh.blank(uf.Profile.from_corners(corners, [0.0, 0.0, 0.0, 0.0, 0.1 * length, 0.0]), 1.0, size)
    assert _area(blank).sum() == pytest.approx(800 + length * (20 - length), rel=1e-3)
    assert {blank.nodes(f"edge_{k}").size for k in (1, 2)} == {6}


def test_a_polyline_of_short_lines_is_a_blank():
    turn = np.linspace(0.0, 2 * np.pi, 121)[:-1]
    outline = uf.Profile.from_corners(np.c_[30 * np.cos(turn), 20 * np.sin(turn)].tolist())
    blank = uf.mesh.blank(outline, 1.0, 5.0)
    assert _area(blank).sum() == pytest.approx(outline.area, rel=1e-9)


_TO_NOBODY = """
import os
import umform as uf
from umform.surfaces import Arc
uf.mesh.blank(uf.Profile([Arc((5.0, 0.0), (5.0, 0.0), (0.0, 0.0))]), 1.0, 5.0)
read, write = os.pipe()
os.close(read)
try:
    os.write(write, b"a")
except BrokenPipeError:
    print("an error like any other")
"""


@pytest.mark.skipif(not hasattr(signal, "SIGPIPE"), reason="no SIGPIPE")
def test_a_pipe_that_closes_after_a_mesh_does_not_end_the_process():
    done = subprocess.run([sys.executable, "-c", _TO_NOBODY], capture_output=True, text=True, check=False)
    assert done.stdout == "an error like any other\n", done

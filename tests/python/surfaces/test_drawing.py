"""Triangles of tools: on the surface, turned outwards, whole, cut to the box; and written to files."""

from __future__ import annotations

import math
import runpy
from pathlib import Path

import meshio
import numpy as np
import pytest

from umform.errors import FileProblem, InvalidValue
from umform.surfaces import (
    Box,
    Cylinder,
    Plane,
    Profile,
    Punch,
    Revolved,
    Sphere,
    Torus,
    UDie,
    UserSurface,
    VDie,
    WipingDie,
    write_tool,
)

BOX = ((-6.0, -5.0, -7.0), (7.0, 5.0, 6.0))
TOOLS = {
    "plane": Plane((0, 0, 1), (1, 2, 3)),
    "cylinder": Cylinder((0, 0, 1), (1, 2, 3), 3.0),
    "bore": Cylinder((0, 0, 1), (1, 2, 3), 3.0, inside=True),
    "sphere": Sphere((0, 0, 1), 3.0),
    "bowl": Sphere((0, 0, 1), 3.0, inside=True),
    "torus": Torus((0, 0, 1), (1, 2, 3), 3.0, 1.0),
    "box": Box((0, 0, 1), (3, 4, 5), 0.5, x=(1, 1, 0), y=(-1, 1, 0)),
    "sharp box": Box((0, 0, 1), (3, 4, 5)),
    "V die": VDie(8, 88, 1, 0.5),
    "U die": UDie(6, 5, 1, 2),
    "wiping die": WipingDie(2.0),
    "punch": Punch(1.0, 60.0, width=5.0).moved((0, 0, -2), (0.1, 0.2, 0.3)),
    "mirrored": WipingDie(2.0).mirrored((1, 1, 1)),
    "funnel": Revolved(Profile.from_corners([(2, -5), (2, 0), (6, 3)], [0, 1, 0], closed=False)),
}
CLOSED = {"sphere": 36 * math.pi, "torus": 6 * math.pi**2, "sharp box": 60.0}


@pytest.mark.parametrize("name", TOOLS)
@pytest.mark.parametrize("chord", [0.1, 0.01])
def test_triangles_lie_on_the_surface_and_look_outwards(name, chord):
    surface = TOOLS[name].triangles(BOX, chord)
    assert len(surface.triangles) > 1
    assert (surface.points > np.array(BOX[0]) - 1e-9).all()
    assert (surface.points < np.array(BOX[1]) + 1e-9).all()
    corners = surface.corners
    weights = np.array([[1, 1, 1], [3, 0, 0], [1, 2, 0], [0, 1, 2]]) / 3.0
    x = np.einsum("wk,tki->wti", weights, corners).reshape(-1, 3)
    g, n, _ = TOOLS[name].kernel().gap(x)
    assert np.abs(g).max() < chord
    area = surface.area_vectors
    large = np.linalg.norm(area, axis=1) > 1e-6
    facing = np.einsum("ti,ti->t", area, n[: len(area)]) / np.linalg.norm(area, axis=1)
    assert facing[large].min() > 0.8


@pytest.mark.parametrize("name", CLOSED)
def test_volumes_of_closed_tools(name):
    surface = TOOLS[name].triangles(BOX, 0.002)
    volume = np.einsum("ti,ti->", surface.corners.mean(axis=1), surface.area_vectors) / 3
    assert volume == pytest.approx(CLOSED[name], rel=3e-3)
    np.testing.assert_allclose(surface.area_vectors.sum(axis=0), 0.0, atol=1e-9)


@pytest.mark.parametrize("name", ["sphere", "torus", "box", "sharp box"])
def test_closed_tools_are_closed(name):
    """Each edge belongs to two triangles that run along it in opposite directions."""
    surface = TOOLS[name].triangles(BOX, 0.05)
    edges = np.vstack([surface.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    forth, back = {tuple(edge) for edge in edges}, {tuple(edge[::-1]) for edge in edges}
    assert len(forth) == len(edges)
    assert forth == back


def test_a_plane_fills_its_section_of_the_box():
    assert np.linalg.norm(Plane((0, 0, 1)).triangles(BOX).area_vectors, axis=1).sum() == pytest.approx(130.0)
    assert len(Plane((0, 0, 9)).triangles(BOX).triangles) == 0


@pytest.mark.parametrize("suffix", ["stl", "vtk", "vtu", "ply", "obj"])
def test_files_hold_the_triangles(tmp_path, suffix):
    tool = TOOLS["V die"]
    path = write_tool(tool, tmp_path / f"die.{suffix}", BOX, 0.05)
    mesh, surface = meshio.read(path), tool.triangles(BOX, 0.05)
    corners = mesh.points[mesh.cells_dict["triangle"]]
    np.testing.assert_allclose(corners, surface.corners, atol=1e-5)


def test_what_cannot_be_written_is_refused(tmp_path):
    with pytest.raises(InvalidValue, match="written as"):
        write_tool(Plane(), tmp_path / "plane.txt", BOX)
    with pytest.raises(InvalidValue, match="nothing of the tool"):
        write_tool(Plane((0, 0, 9)), tmp_path / "plane.stl", BOX)
    with pytest.raises(InvalidValue, match="lowest and a highest"):
        write_tool(Plane(), tmp_path / "plane.stl", (BOX[1], BOX[0]))
    with pytest.raises(InvalidValue, match="must not be negative"):
        Plane().triangles(BOX, -1.0)
    with pytest.raises(FileProblem):
        write_tool(Plane(), tmp_path / "nowhere" / "plane.stl", BOX)
    mine = UserSurface(lambda x: (x[:, 2], x, x))
    for tool in (mine, mine.moved((0, 0, 1))):
        with pytest.raises(InvalidValue, match="does not know its shape"):
            tool.triangles(BOX)


def test_the_example_draws_all_tools(tmp_path, monkeypatch):
    example = Path(__file__).parents[3] / "examples" / "tools.py"
    monkeypatch.setattr("sys.argv", [str(example), str(tmp_path)])
    runpy.run_path(str(example), run_name="__main__")
    assert {path.name for path in tmp_path.iterdir()} == {"tools.png", "press_brake.png"}

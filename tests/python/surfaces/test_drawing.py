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
    Tool,
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
        with pytest.raises(InvalidValue, match="its function fails around the tool"):
            tool.triangles(BOX)


def by_distance(tool):
    """The function of a tool, as if a user had written it."""
    return UserSurface(tool.kernel().gap)


class OwnTool(Tool):
    """A tool with a kernel and nothing else."""

    def kernel(self):
        return Sphere((0, 0, 1), 3.0).kernel()


SAMPLED = {
    "function": by_distance(Sphere((0, 0, 1), 3.0)),
    "torus": by_distance(TOOLS["torus"]),
    "bowl": by_distance(TOOLS["bowl"]),
    "placed": by_distance(Sphere((0, 0, 0), 3.0)).moved((0, 0, 1), (0.1, 0.2, 0.3)),
    "mirrored": by_distance(Sphere((2, 0, 0), 3.0)).mirrored("x"),
    "kernel": OwnTool(),
}


@pytest.mark.parametrize("name", SAMPLED)
def test_a_tool_that_knows_its_distance_only_is_sampled(name):
    surface = SAMPLED[name].triangles(BOX, 0.05)
    x = np.vstack([surface.points, surface.corners.mean(axis=1)])
    g, n, _ = SAMPLED[name].kernel().gap(x)
    assert np.abs(g).max() < 0.05
    assert (np.einsum("ti,ti->t", surface.area_vectors, n[len(surface.points) :]) >= 0.0).all()
    edges = np.vstack([surface.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    assert {tuple(edge) for edge in edges} == {tuple(edge[::-1]) for edge in edges}  # closed
    volume = np.einsum("ti,ti->", surface.corners.mean(axis=1), surface.area_vectors) / 3
    exact = {"torus": 6 * math.pi**2, "bowl": -36 * math.pi}.get(name, 36 * math.pi)
    assert volume == pytest.approx(exact, rel=0.02)


def test_samples_see_one_sheet_of_a_plane_and_nothing_where_the_function_says_so():
    def half(x):
        g, n, H = Plane((0, 0, 1)).kernel().gap(x)
        return np.where(x[:, 0] < 0.0, np.nan, g), n, H

    whole = by_distance(Plane((0, 0, 1))).triangles(BOX)
    assert np.linalg.norm(whole.area_vectors, axis=1).sum() == pytest.approx(130.0)
    cut = UserSurface(half).triangles(BOX)
    assert 0.4 * 130.0 < np.linalg.norm(cut.area_vectors, axis=1).sum() < 7.0 * 10.0 + 1e-9
    assert len(by_distance(Plane((0, 0, 19))).triangles(BOX).triangles) == 0


def test_samples_of_a_level_set_lie_on_it():
    """A function that is close to a distance only, twice as steep as one at some places."""
    A = np.diag(1.0 / np.square([5.0, 3.0, 2.0]))

    def ellipsoid(x):
        s = np.sqrt(np.einsum("qi,ij,qj->q", x, A, x))
        with np.errstate(all="ignore"):
            return 3.0 * (s - 1.0), 3.0 * x @ A / s[:, None], 3.0 * A / s[:, None, None]

    surface = UserSurface(ellipsoid).triangles(BOX, 0.05)
    volume = np.einsum("ti,ti->", surface.corners.mean(axis=1), surface.area_vectors) / 3
    assert volume == pytest.approx(4.0 / 3.0 * math.pi * 30.0, rel=0.02)


def test_a_sampled_tool_is_written(tmp_path):
    path = write_tool(SAMPLED["torus"], tmp_path / "ring.stl", BOX, 0.1)
    assert len(meshio.read(path).cells_dict["triangle"]) == len(SAMPLED["torus"].triangles(BOX, 0.1).triangles)


def test_the_example_draws_all_tools(tmp_path, monkeypatch):
    example = Path(__file__).parents[3] / "examples" / "tools.py"
    monkeypatch.setattr("sys.argv", [str(example), str(tmp_path)])
    runpy.run_path(str(example), run_name="__main__")
    assert {path.name for path in tmp_path.iterdir()} == {"tools.png", "press_brake.png"}

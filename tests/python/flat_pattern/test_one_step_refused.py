"""Parts that are no sheet are refused, each with its cause and remedy."""

from __future__ import annotations

import meshio
import numpy as np
import pytest
from formed_parts import cylinder, grid

import umform as uf
from umform.errors import FileProblem, InvalidValue, NoConvergence, NotFinite, UnfitTriangles
from umform.flat_pattern.one_step.part import sheet_of
from umform_book.drawing.revolved import cup, disc

STEEL = uf.J2(210e3, 0.3, hardening=uf.Swift(520.0, 0.004, 0.2))


def refused(part, message: str, thickness: float = 1.0) -> UnfitTriangles:
    with pytest.raises(UnfitTriangles, match=message) as error:
        sheet_of(*part, thickness, "door.stl")
    assert error.value.where == "door.stl"
    assert error.value.remedy
    return error.value


def test_a_closed_surface():
    x = np.array([[0, 0, 0], [30, 0, 0], [0, 30, 0], [0, 0, 30]], dtype=float)
    refused((x, np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])), "closed")


def test_two_pieces():
    points, triangles = cylinder()
    two = (
        np.concatenate([points, points + np.array([0.0, 100.0, 0.0])]),
        np.concatenate([triangles, triangles + len(points)]),
    )
    assert "2 pieces" in refused(two, "not connected").value


def test_a_rib():
    points, triangles = cylinder()
    points = np.concatenate([points, [[0.0, 15.0, 40.0]]])
    refused((points, np.concatenate([triangles, [[*triangles[0, [0, 2]], len(points) - 1]]])), "three triangles share")


def test_metres_in_place_of_millimetres():
    points, triangles = cylinder()
    error = refused((points / 1000.0, triangles), "size of the part")
    assert "--scale 1000" in error.remedy
    refused((points * 1000.0, triangles), "size of the part")


def test_a_moebius_strip():
    a, w = np.meshgrid(np.linspace(0.0, 2.0 * np.pi, 41)[:-1], np.linspace(-5.0, 5.0, 5), indexing="ij")
    r = 40.0 + w * np.cos(0.5 * a)
    points = np.stack([r * np.cos(a), r * np.sin(a), w * np.sin(0.5 * a)], axis=-1)
    points, triangles = grid(points)
    last, first = 195 + np.arange(5), 4 - np.arange(5)  # the ends are joined with a half turn
    seam = [(last[k], first[k], first[k + 1]) for k in range(4)] + [
        (last[k], first[k + 1], last[k + 1]) for k in range(4)
    ]
    refused((points, np.concatenate([triangles, seam])), "one side only")


def test_a_hem_without_radius():
    flat = np.array([[0, 0, 0], [20, 0, 0], [0, 20, 0], [20, 20, 0.0], [1, 1, 0.1]], dtype=float)
    refused((flat, np.array([[0, 1, 2], [1, 3, 2], [3, 1, 4]])), "folded")


def test_a_triangle_without_area():
    flat = np.array([[0, 0, 0], [20, 0, 0], [0, 20, 0], [10, 0, 0.0]], dtype=float)
    refused((flat, np.array([[0, 1, 2], [0, 3, 1]])), "no area")


def test_a_handle():
    """A torus with a hole has one edge and a handle."""
    a, b = np.meshgrid(*[np.linspace(0.0, 2.0 * np.pi, n + 1)[:-1] for n in (24, 12)], indexing="ij")
    r = 40.0 + 10.0 * np.cos(b)
    points = np.stack([r * np.cos(a), r * np.sin(a), 10.0 * np.sin(b)], axis=-1).reshape(-1, 3)
    at = np.arange(288).reshape(24, 12)
    one, two, three, four = at, np.roll(at, -1, 0), np.roll(np.roll(at, -1, 0), -1, 1), np.roll(at, -1, 1)
    triangles = np.concatenate(
        [np.stack([x.ravel() for x in ids], axis=1) for ids in ((one, two, three), (one, three, four))]
    )
    refused((points, triangles[1:]), "handle")


def test_edges_that_meet_in_a_point():
    flat, triangles = disc(2)
    points = np.c_[flat * 20.0, np.zeros(len(flat))]
    refused((points, np.delete(triangles, [0, 2, 4], axis=0)), "meet in a point")


def test_triangles_of_mixed_turns_are_put_in_order():
    points, triangles = cylinder()
    mixed = triangles.copy()
    mixed[::3] = mixed[::3][:, ::-1]
    sheet = sheet_of(points, mixed, 1.0)
    assert (sheet.normals[:, 2] > 0.0).all()
    assert len(sheet.loops) == 1


def test_a_deep_cup_whose_edge_is_clamped():
    with pytest.raises(NoConvergence, match="no minimum") as error:
        uf.blank(cup(6, 34.0), uf.Blank(STEEL, 1.0, clamped=True))
    assert "clamped" in error.value.cause and "not clamped" in error.value.remedy


@pytest.mark.parametrize(
    ("given", "where"),
    [
        ({"friction": -0.1}, "friction"),
        ({"friction": 5.0}, "friction"),
        ({"gap": 0.5}, "gap"),
        ({"holder_force": np.nan}, "holder_force"),
        ({"rolling": np.nan}, "rolling"),
        ({"clamped": True, "bead": 50.0}, "bead"),
        ({"clamped": True, "holder_force": 2e4}, "holder_force"),
        ({"clamped": True, "friction": 0.1}, "friction"),
    ],
)
def test_numbers_that_cannot_be(given, where):
    with pytest.raises(InvalidValue) as error:
        uf.Blank(STEEL, 1.0, **given)
    assert error.value.where == where


@pytest.mark.parametrize(
    ("given", "where"),
    [
        ({"size": 0.0}, "size"),
        ({"size": 1e-3}, "size"),
        ({"scale": -1.0}, "scale"),
        ({"weld": -1.0}, "weld"),
        ({"offset": 3.0}, "offset"),
        ({"offset": np.nan}, "offset"),
    ],
)
def test_a_part_that_cannot_be_read_so(given, where):
    with pytest.raises(InvalidValue) as error:
        uf.blank(cylinder(), uf.Blank(STEEL, 1.0), **given)
    assert error.value.where == where


def test_files_that_cannot_be_read(tmp_path, capfd):
    (tmp_path / "part.vtk").write_text("nothing")
    with pytest.raises(FileProblem) as error:
        uf.blank(tmp_path / "part.vtk", uf.Blank(STEEL, 1.0))
    assert "Illegal VTK header" in error.value.cause
    assert capfd.readouterr() == ("", "")
    with pytest.raises(FileProblem):
        uf.blank(tmp_path / "missing.stl", uf.Blank(STEEL, 1.0))


def test_points_and_corners_of_arrays_are_checked():
    points, triangles = cylinder()
    with pytest.raises(NotFinite) as error:
        uf.blank((np.where(np.arange(len(points))[:, None] == 7, np.nan, points), triangles), uf.Blank(STEEL, 1.0))
    assert error.value.where == "part, point 7"
    with pytest.raises(InvalidValue, match="points that do not exist"):
        uf.blank((points, triangles + 1), uf.Blank(STEEL, 1.0))


def test_a_node_that_no_triangle_has_does_not_count(tmp_path):
    """One of reference far away made all others one point."""
    points, triangles = cylinder()
    mesh = meshio.Mesh(np.concatenate([points, [[1e9, 0, 0]]]), [("triangle", triangles)])
    meshio.write(tmp_path / "part.vtk", mesh)
    found, plain = (uf.blank(part, uf.Blank(STEEL, 1.0)) for part in (tmp_path / "part.vtk", (points, triangles)))
    assert found["length"].value == pytest.approx(plain["length"].value, rel=1e-9)

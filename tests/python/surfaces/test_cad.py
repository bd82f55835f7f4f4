"""Tools from STEP and IGES files: exact faces, free forms within a measured distance, units, refusals."""

from __future__ import annotations

import numpy as np
import pytest

from umform.errors import DrawingError, FileProblem, HoleInSurface
from umform.surfaces import Box, CadTool, Profile, Revolved, check_surface, read_tool

pytest.importorskip("OCP")

from OCP.BRep import BRep_Builder
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.BRepFilletAPI import BRepFilletAPI_MakeFillet
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCone, BRepPrimAPI_MakeCylinder, BRepPrimAPI_MakePrism
from OCP.collections import Array2_gp_Pnt
from OCP.GeomAPI import GeomAPI_PointsToBSplineSurface
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt, gp_Vec
from OCP.IGESControl import IGESControl_Writer
from OCP.STEPControl import STEPControl_StepModelType, STEPControl_Writer
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS, TopoDS_Compound


def write(shape, path):
    if path.suffix == ".step":
        writer = STEPControl_Writer()
        writer.Transfer(shape, STEPControl_StepModelType.STEPControl_AsIs)
    else:
        writer = IGESControl_Writer()
        writer.AddShape(shape)
        writer.ComputeModel()
    writer.Write(str(path))
    return path


def rounded(shape, radius):
    """All edges of a shape rounded."""
    fillet, edges = BRepFilletAPI_MakeFillet(shape), TopExp_Explorer(shape, TopAbs_ShapeEnum.TopAbs_EDGE)
    while edges.More():
        fillet.Add(radius, TopoDS.Edge(edges.Current()))
        edges.Next()
    return fillet.Shape()


def box():
    return BRepPrimAPI_MakeBox(40.0, 30.0, 10.0).Shape()


def wave(x, y):
    return np.sin(0.4 * x) * np.cos(0.3 * y) + 8.0


def free_form():
    """A block below a surface of splines."""
    points = Array2_gp_Pnt(1, 8, 1, 8)
    for i in range(8):
        for k in range(8):
            points.SetValue(i + 1, k + 1, gp_Pnt(i, k, float(wave(i, k))))
    face = BRepBuilderAPI_MakeFace(GeomAPI_PointsToBSplineSurface(points).Surface(), 1e-6).Face()
    return BRepPrimAPI_MakePrism(face, gp_Vec(0, 0, -12)).Shape()


def test_a_rounded_box_is_exact(tmp_path, rng):
    tool = CadTool.read(write(rounded(box(), 2.0), tmp_path / "box.step"))
    assert tool.kinds == {"Cylinder": 12, "Plane": 6, "Sphere": 8}
    assert tool.deviation < 1e-3
    assert "6 Plane" in str(tool)
    true = Box((20, 15, 5), (40, 30, 10), 2.0)
    x = rng.uniform((-2, -2, -2), (42, 32, 12), (5000, 3))
    x = x[true.gap(x)[0] > -1.9]
    for mine, exact in zip(tool.gap(x), true.gap(x), strict=True):
        assert np.abs(mine - exact).max() < 1e-12
    assert tool.largest_curvature == pytest.approx(0.5, rel=0.05)


def test_cones_tori_and_concave_faces(tmp_path, rng):
    """A funnel in a disc, its edges rounded by tori: a turned profile."""
    disc = BRepPrimAPI_MakeCylinder(20.0, 8.0).Shape()
    funnel = BRepPrimAPI_MakeCone(gp_Ax2(gp_Pnt(0, 0, -1), gp_Dir(0, 0, 1)), 3.5, 8.5, 10.0).Shape()
    tool = CadTool.read(write(rounded(BRepAlgoAPI_Cut(disc, funnel).Shape(), 1.0), tmp_path / "ring.step"))
    assert tool.kinds == {"Cone": 1, "Cylinder": 1, "Plane": 2, "Torus": 4}
    true = Revolved(Profile.from_corners([(4, 0), (20, 0), (20, 8), (8, 8)], 1.0))
    x = rng.uniform((-22, -22, -2), (22, 22, 10), (6000, 3))
    x = x[np.abs(true.gap(x)[0]) < 0.9]
    g, n, _ = tool.gap(x)
    G, N, _ = true.gap(x)
    assert np.abs(g - G).max() < 1e-11
    assert np.abs(n - N).max() < 1e-10


@pytest.mark.parametrize("tolerance", [1e-2, 1e-3])
def test_free_forms_lie_within_the_distance_that_is_said(tmp_path, tolerance):
    path = write(free_form(), tmp_path / "wave.step")
    tool = CadTool.read(path, tolerance=tolerance)
    assert tool.deviation <= tolerance
    assert tool.kinds["BSplineSurface"] >= 1
    x, y = (v.ravel() for v in np.meshgrid(np.linspace(0.3, 6.7, 40), np.linspace(0.3, 6.7, 40)))
    top = np.c_[x, y, np.full(x.size, 30.0)]
    for _ in range(30):  # down along z to the tool
        top[:, 2] -= tool.gap(top)[0]
    assert np.abs(tool.gap(top)[0]).max() < 1e-6
    face = next(face for face in _faces(path) if face.kind == "BSplineSurface" and len(face.triangles) > 20)
    from umform.surfaces.cad.deviation import distances

    guess = face.uv.min(axis=0) + np.c_[x, y] / 7.0 * np.ptp(face.uv, axis=0)
    off = np.minimum(distances(face, top, guess), distances(face, top, guess[:, ::-1]))
    assert off.max() < 1.5 * tool.deviation
    assert off.max() > 1e-3 * tool.deviation
    assert check_surface(tool, top[::97] + np.array([0, 0, 0.05]), 1e-6).ok(1e-5)


def test_the_tolerance_is_in_millimetres_where_none_is_given(tmp_path):
    path = write(free_form(), tmp_path / "wave.step")
    assert read_tool(path).deviation < 1e-3
    assert read_tool(path, scale=1e-3).deviation < 1e-6


def _faces(path):
    from umform.surfaces.cad.opencascade import Shape

    return Shape(path).faces(0.05, 0.3)


def test_iges_files_and_scale(tmp_path, rng, capfd):
    path = write(rounded(box(), 2.0), tmp_path / "box.igs")
    capfd.readouterr()  # of the writer
    tool = read_tool(path, scale=0.1)
    assert capfd.readouterr() == ("", "")
    true = Box((2, 1.5, 0.5), (4, 3, 1), 0.2)
    x = rng.uniform((-0.2, -0.2, -0.2), (4.2, 3.2, 1.2), (500, 3))
    x = x[true.gap(x)[0] > -0.15]
    assert tool.kinds == {"Cylinder": 12, "Plane": 6, "Sphere": 8}  # the file has turned lines and arcs
    assert np.abs(tool.gap(x)[0] - true.gap(x)[0]).max() < 1e-6


def test_open_faces(tmp_path):
    face = _first_face(box())
    path = write(face, tmp_path / "face.step")
    with pytest.raises(HoleInSurface, match="rim of length"):
        CadTool.read(path)
    tool = read_tool(path, open=True)
    assert abs(tool.gap([[0.0, 15.0, 5.0]])[0][0]) < 1e-12


def _first_face(shape):
    return TopExp_Explorer(shape, TopAbs_ShapeEnum.TopAbs_FACE).Current()


def _faces_beside(shape, left_out=()):
    """A compound of the faces of a shape, which have no common orientation in a file."""
    builder, compound, at, number = BRep_Builder(), TopoDS_Compound(), _faces_of(shape), 0
    builder.MakeCompound(compound)
    while at.More():
        if number not in left_out:
            builder.Add(compound, at.Current())
        number += 1
        at.Next()
    return compound


def _faces_of(shape):
    return TopExp_Explorer(shape, TopAbs_ShapeEnum.TopAbs_FACE)


def test_a_compound_of_faces_is_a_tool_and_a_missing_face_is_called_a_hole(tmp_path):
    tool = CadTool.read(write(_faces_beside(rounded(box(), 2.0)), tmp_path / "faces.step"))
    assert tool.kinds == {"Cylinder": 12, "Plane": 6, "Sphere": 8}
    path = write(_faces_beside(rounded(box(), 2.0), left_out=[0]), tmp_path / "hole.step")
    with pytest.raises(HoleInSurface, match=r"rim of length 64, 4 open edges, around \(.*, 15, 5\)(?s:.*)missing face"):
        CadTool.read(path)


def test_what_cannot_be_read(tmp_path):
    with pytest.raises(FileProblem, match="no such file"):
        CadTool.read(tmp_path / "nothing.step")
    (tmp_path / "text.step").write_text("not a drawing")
    with pytest.raises(FileProblem, match="cannot be read"):
        CadTool.read(tmp_path / "text.step")
    with pytest.raises(FileProblem, match="a STEP or an IGES file"):
        read_tool(tmp_path / "die.dwg")
    with pytest.raises(DrawingError, match="do not reach the tolerance"):
        CadTool.read(write(free_form(), tmp_path / "wave.step"), tolerance=1e-9)

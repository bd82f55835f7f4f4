"""What is no bent sheet of one thickness: one message that names the face, the file, the cause."""

from __future__ import annotations

from dataclasses import replace

import pytest
from brackets import BRACKETS, L, block, cut, drill, fused, placed, section, write
from OCP.BRep import BRep_Builder
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakePolygon
from OCP.BRepFilletAPI import BRepFilletAPI_MakeFillet
from OCP.BRepPrimAPI import BRepPrimAPI_MakeCone, BRepPrimAPI_MakePrism
from OCP.collections import Array2_gp_Pnt
from OCP.GeomAPI import GeomAPI_PointsToBSplineSurface
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt, gp_Vec
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS, TopoDS_Compound

from umform.errors import DrawingError, FileProblem
from umform.flat_pattern import KFactor, flat
from umform.flat_pattern.skin import skin_of
from umform.surfaces.cad.read_solid import read_solid


def compound(*shapes):
    made, builder = TopoDS_Compound(), BRep_Builder()
    builder.MakeCompound(made)
    for shape in shapes:
        builder.Add(made, shape)
    return made


def explored(shape, kind):
    at, found = TopExp_Explorer(shape, kind), []
    while at.More():
        found.append(at.Current())
        at.Next()
    return found


def open_shell():
    return compound(*explored(L.shape(), TopAbs_ShapeEnum.TopAbs_FACE)[:-1])


def rounded_edges():
    """All edges rounded."""
    shape = section([60, 40], [90], 30.0)
    fillet = BRepFilletAPI_MakeFillet(shape)
    for edge in explored(shape, TopAbs_ShapeEnum.TopAbs_EDGE):
        fillet.Add(0.4, TopoDS.Edge(edge))
    return fillet.Shape()


def free_form():
    """A wavy sheet with two sides at one distance along z."""
    points = Array2_gp_Pnt(1, 6, 1, 6)
    for i in range(6):
        for k in range(6):
            points.SetValue(i + 1, k + 1, gp_Pnt(10.0 * i, 10.0 * k, 2.0 * ((i * k) % 3)))
    face = BRepBuilderAPI_MakeFace(GeomAPI_PointsToBSplineSurface(points).Surface(), 1e-6).Face()
    wavy = BRepPrimAPI_MakePrism(face, gp_Vec(0, 0, 2)).Shape()
    return fused(wavy, block((-40, 0, 0), (41, 50, 2)))


def conical():
    outer = BRepPrimAPI_MakeCone(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 10.0, 14.0, 4.0).Shape()
    return cut(block((-40, -40, 0), (80, 80, 3)), outer)


def thick_and_thin():
    return fused(section([60, 40], [90], 30.0), block((-30, -15, -3), (25, 30, 3)))


def sharp():
    return fused(block((0, 0, 0), (60, 30, 2)), block((0, 0, 0), (2, 30, 40)))


REFUSED = {
    "free form": (free_form, "neither a plane nor a cylinder"),
    "countersink": (conical, "cone"),
    "second thickness": (thick_and_thin, "face"),
    "rib": (lambda: fused(section([60, 40], [90], 30.0), block((-10, -1, 0), (20, 2, 12))), "face"),
    "casting": (lambda: cut(block((0, 0, 0), (60, 40, 20)), block((3, 4, 5), (54, 30, 30))), "face"),
    "block": (lambda: block((0, 0, 0), (40, 40, 40)), "no sheet"),
    "round tube": (lambda: cut(drill((0, 0, 0), (0, 0, 1), 20, 100), drill((0, 0, 0), (0, 0, 1), 18, 100)), "no sheet"),
    "sharp bend": (sharp, "sharp inside"),
    "rounded edges": (rounded_edges, "face"),
    "two parts": (lambda: compound(L.shape(), placed(L.shape(), (200, 0, 0))), "2 solids"),
    "open shell": (open_shell, "no solid"),
    "round hem": (lambda: section([40, 10], [170], 30.0, 1.0, 1.0), "165 degrees"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_no_bent_sheet_is_refused(tmp_path, name):
    shape, word = REFUSED[name]
    with pytest.raises(DrawingError) as info:
        flat(write(shape(), tmp_path / "part.step"), allowance=KFactor(0.44))
    text = str(info.value)
    assert word in text and "remedy" in text and "part.step" in text


def test_the_volume_is_that_of_the_sheet(step):
    solid = read_solid(step("hole across the bend"))
    sides = skin_of(solid)
    assert sides.thickness == 2.0
    for factor in (0.98, 1.02):
        with pytest.raises(DrawingError, match="no sheet of one thickness"):
            skin_of(replace(solid, volume=factor * solid.volume))


def test_mitred_edges_are_warned_of_and_unfold(tmp_path):
    """Both ends of an L cut at 45 degrees: the contour is that of the unfolded side."""
    shape = section([40, 30], [90], 50.0)
    shape = cut(shape, placed(block((-40, -80, -20), (40, 160, 40)), (-14, 0, 0)))
    made = flat(write(cut(shape, wedge()), tmp_path / "mitre.step"), allowance=KFactor(0.44))
    assert "not square to the sheet" in made.warnings[0]
    assert made.folded_back < 1e-6


def wedge():
    """A corner of 45 degrees at the end of the first leg."""
    points = [gp_Pnt(x, -60, z) for x, z in ((-14.1, -1), (-12, -1), (-14.1, 1.1))]
    wire = BRepBuilderAPI_MakePolygon(*points, True).Wire()
    return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire).Face(), gp_Vec(0, 120, 0)).Shape()


def test_a_truncated_file_is_refused(tmp_path, step):
    text = step("l").read_bytes()
    for share in (0.3, 0.6, 0.9):
        path = tmp_path / "cut.step"
        path.write_bytes(text[: int(share * len(text))])
        with pytest.raises((FileProblem, DrawingError)):
            flat(path, allowance=KFactor(0.44))


def test_other_files_are_refused(tmp_path):
    for name, content in (("part.iges", ""), ("part.dxf", "x"), ("part.step", "no STEP"), ("empty.step", "")):
        (tmp_path / name).write_text(content)
        with pytest.raises(FileProblem):
            flat(tmp_path / name, allowance=KFactor(0.44))
    with pytest.raises(FileProblem, match="no such file"):
        flat(tmp_path / "missing.step", allowance=KFactor(0.44))


def test_too_many_faces_and_too_large_files_are_refused(step, monkeypatch):
    monkeypatch.setattr("umform.surfaces.cad.read_solid.MOST_FACES", 5)
    with pytest.raises(DrawingError, match="too many faces"):
        flat(step("l"), allowance=KFactor(0.44))
    monkeypatch.setattr("umform.surfaces.cad.read_solid.MOST_BYTES", 1000)
    with pytest.raises(FileProblem, match="too large"):
        flat(step("l"), allowance=KFactor(0.44))


def test_faces_are_named_by_their_numbers_in_the_file(step):
    with pytest.raises(DrawingError) as info:
        flat(step("hem"), allowance=KFactor(0.44))
    assert info.value.value == "face 6" and "hem" in info.value.cause
    assert BRACKETS["hem"].refused == "face 6"

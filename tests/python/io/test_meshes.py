import logging

import h5py
import meshio
import numpy as np
import pytest
import pyvista as pv

from umform.errors import FileProblem, InvalidValue, MeshError, NotFinite, WrongCellType
from umform.io import VtkHdfSeries, read_mesh_arrays, write_mesh_arrays

X = np.array([(x, y, z) for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0, 2.0)])
HEXES = [[0, 1, 4, 3, 6, 7, 10, 9], [1, 2, 5, 4, 7, 8, 11, 10]]

ABAQUS = """\
*HEADING
 two cells
*NODE
1, 0., 0., 0.
2, 1., 0., 0.
3, 2., 0., 0.
4, 0., 1., 0.
5, 1., 1., 0.
6, 2., 1., 0.
11, 0., 0., 1.
12, 1., 0., 1.
13, 2., 0., 1.
14, 0., 1., 1.
15, 1., 1., 1.
16, 2., 1., 1.
99, 5., 5., 5.
*ELEMENT, TYPE=C3D8
1, 1, 2, 5, 4, 11, 12, 15, 14
7, 2, 3, 6, 5, 12, 13, 16, 15
*NSET, NSET=Left
14, 1, 4, 11
*NSET, NSET=lower, GENERATE
1, 6, 1
*NSET, NSET=reference
99
*ELSET, ELSET=right
7
"""

GMSH = """\
$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
0 7 "centre"
2 1 "left face"
3 2 "sheet"
$EndPhysicalNames
$Nodes
13
1 0 0 0
2 1 0 0
3 2 0 0
4 0 1 0
5 1 1 0
6 2 1 0
7 9 9 9
8 0 0 1
9 1 0 1
10 2 0 1
11 0 1 1
12 1 1 1
13 2 1 1
$EndNodes
$Elements
4
1 15 2 7 1 7
2 3 2 1 1 1 8 11 4
3 5 2 2 1 1 2 5 4 8 9 12 11
4 5 2 5 1 2 3 6 5 9 10 13 12
$EndElements
"""

GMSH_41 = """\
$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
2
2 1 "left"
3 2 "sheet"
$EndPhysicalNames
$Entities
0 0 1 1
1 0 0 0 0 1 1 1 1 0
1 0 0 0 1 1 1 1 2 1 1
$EndEntities
$Nodes
1 8 1 8
3 1 0 8
1
2
3
4
5
6
7
8
0 0 0
1 0 0
1 1 0
0 1 0
0 0 1
1 0 1
1 1 1
0 1 1
$EndNodes
$Elements
2 2 1 2
2 1 3 1
1 1 5 8 4
3 1 5 1
2 1 2 3 4 5 6 7 8
$EndElements
"""

NASTRAN = """\
BEGIN BULK
GRID    1       {cp}       0.0     0.0     0.0
GRID    2               1.0     0.0     0.0
GRID    3               1.0     1.0     0.0
GRID    4               0.0     1.0     0.0
GRID    5               0.0     0.0     1.0
GRID    6               1.0     0.0     1.0
GRID    7               1.0     1.0     1.0
GRID    8               0.0     1.0     1.0
CHEXA   1       1       1       2       3       4       5       6       +
+       7       8
ENDDATA
"""


@pytest.fixture
def file(tmp_path):
    def write(name, text):
        (tmp_path / name).write_text(text)
        return tmp_path / name

    return write


def test_abaqus(file):
    mesh = read_mesh_arrays(file("a.inp", ABAQUS))
    np.testing.assert_array_equal(mesh.points, X)
    assert mesh.cells.keys() == {"hex8"}
    np.testing.assert_array_equal(mesh.cells["hex8"], HEXES)
    assert {name: ids.tolist() for name, ids in mesh.point_sets.items()} == {
        "Left": [0, 3, 6, 9],
        "lower": [0, 1, 2, 3, 4, 5],
    }
    assert {name: ids["hex8"].tolist() for name, ids in mesh.cell_sets.items()} == {"right": [1]}


def test_abaqus_sets_on_element_lines(file):
    text = ABAQUS.replace("TYPE=C3D8\n", "TYPE=C3D8, ELSET=first\n").replace(
        "7, 2, 3", "*ELEMENT, ELSET=second, TYPE=C3D8\n7, 2, 3"
    )
    mesh = read_mesh_arrays(file("a.inp", text))
    assert {name: ids["hex8"].tolist() for name, ids in mesh.cell_sets.items()} == {
        "first": [0],
        "second": [1],
        "right": [1],
    }


def test_abaqus_comments_among_the_data(file):
    """meshio ends a list at a comment: cells and members of sets after it would be lost without a word."""
    comment = "\n ** of the part 2\n**\n"
    text = ABAQUS.replace("\n4, 0., 1.", f"{comment}4, 0., 1.").replace("\n7, 2", f"{comment}7, 2")
    text = text.replace("14, 1, 4", f"14, 1{comment}4")
    assert text.count(comment) == 3
    whole, mesh = (read_mesh_arrays(file("a.inp", one)) for one in (ABAQUS, text))
    np.testing.assert_array_equal(mesh.points, whole.points)
    np.testing.assert_array_equal(mesh.cells["hex8"], whole.cells["hex8"])
    assert {name: ids.tolist() for name, ids in mesh.point_sets.items()} == {
        name: ids.tolist() for name, ids in whole.point_sets.items()
    }


@pytest.mark.parametrize(
    ("old", "new", "cause"),
    [
        ("*HEADING\n two cells", "*INCLUDE, INPUT=b.inp", "INCLUDE is not read"),
        ("*NSET, NSET=Left", "*Node\n1, 0., 0., 0.\n*NSET, NSET=Left", "more than one list of nodes"),
        ("NSET=lower", "NSET=Left", "in several pieces"),
        ("*ELSET, ELSET=right\n7", "*ELSET, ELSET=right\nleft", "made of other sets"),
        ("7, 2, 3", "*ELEMENT, ELSET=second, TYPE=C3D8\n7, 2, 3", "all .ELEMENT lines"),
    ],
)
def test_abaqus_files_that_meshio_misreads(file, old, new, cause):
    assert old in ABAQUS
    with pytest.raises(FileProblem, match=cause):
        read_mesh_arrays(file("a.inp", ABAQUS.replace(old, new)))


def test_gmsh_groups(file):
    mesh = read_mesh_arrays(file("a.msh", GMSH))
    np.testing.assert_array_equal(mesh.points, X)
    np.testing.assert_array_equal(mesh.cells["hex8"], HEXES)
    assert {name: ids.tolist() for name, ids in mesh.point_sets.items()} == {"left face": [0, 3, 6, 9]}
    assert {name: ids["hex8"].tolist() for name, ids in mesh.cell_sets.items()} == {"sheet": [0]}


def test_gmsh_groups_of_version_4(file):
    mesh = read_mesh_arrays(file("a.msh", GMSH_41))
    np.testing.assert_array_equal(mesh.cells["hex8"], [range(8)])
    assert {name: ids.tolist() for name, ids in mesh.point_sets.items()} == {"left": [0, 3, 4, 7]}
    assert {name: ids["hex8"].tolist() for name, ids in mesh.cell_sets.items()} == {"sheet": [0]}


def test_nastran(file):
    mesh = read_mesh_arrays(file("a.bdf", NASTRAN.format(cp=" ")))
    np.testing.assert_array_equal(mesh.cells["hex8"], [range(8)])
    np.testing.assert_array_equal(mesh.points[6], [1, 1, 1])
    with pytest.raises(FileProblem, match="coordinate systems"):
        read_mesh_arrays(file("b.bdf", NASTRAN.format(cp="3")))


@pytest.mark.parametrize("suffix", [".vtu", ".vtk", ".msh"])
def test_there_and_back(sheet, tmp_path, suffix):
    path = tmp_path / f"a{suffix}"
    field = np.arange(3.0 * len(sheet.points)).reshape(-1, 3)
    eqps = np.arange(len(sheet.connectivity)) / 3
    write_mesh_arrays(path, sheet.points, sheet.cells, sheet.connectivity, {"u": field}, {"eqps": eqps})
    mesh = read_mesh_arrays(path)
    np.testing.assert_array_equal(mesh.points, sheet.points)
    assert list(mesh.cells) == [sheet.cells]
    np.testing.assert_array_equal(mesh.cells[sheet.cells], sheet.connectivity)
    raw = meshio.read(path)
    np.testing.assert_array_equal(raw.point_data["u"][: len(field)], field)
    np.testing.assert_array_equal(raw.cell_data["eqps"][0], eqps)


@pytest.mark.parametrize("suffix", [".vtu", ".vtk"])
def test_vtk_reads_what_is_written(sheet, tmp_path, suffix):
    path = tmp_path / f"a{suffix}"
    write_mesh_arrays(path, sheet.points, sheet.cells, sheet.connectivity)
    with VtkHdfSeries(tmp_path / "a.vtkhdf", sheet.points, sheet.cells, sheet.connectivity) as series:
        series.append(0.0)
    grid, same = pv.read(path), pv.read(tmp_path / "a.vtkhdf")
    np.testing.assert_array_equal(grid.points, same.points)
    np.testing.assert_array_equal(grid.cells, same.cells)
    np.testing.assert_array_equal(grid.celltypes, same.celltypes)


def test_blocks_of_one_type_are_joined(tmp_path):
    cells = [("hexahedron", HEXES[:1]), ("quad", [[0, 1, 4, 3]]), ("hexahedron", HEXES[1:])]
    meshio.write_points_cells(tmp_path / "a.vtu", X, cells)
    np.testing.assert_array_equal(read_mesh_arrays(tmp_path / "a.vtu").cells["hex8"], HEXES)


@pytest.mark.parametrize(
    ("cells", "found"),
    [
        ([("tetra", [[0, 1, 4, 6]]), ("hexahedron", HEXES)], "2 hexahedron, 1 tetra"),
        ([("wedge", [[0, 1, 3, 6, 7, 9]])], "1 wedge"),
        ([("quad", [[0, 1, 4, 3]]), ("quad", [[1, 2, 5, 4]])], "2 quad"),
        ([("hexahedron20", [[*range(12), *range(8)]])], "1 hexahedron20"),
    ],
)
def test_other_cells_are_refused(tmp_path, cells, found):
    path = tmp_path / "a.vtu"
    meshio.write_points_cells(path, X, cells)
    with pytest.raises(WrongCellType) as info:
        read_mesh_arrays(path)
    assert info.value.value == found
    assert info.value.remedy
    assert str(path) in info.value.where


def test_a_file_without_cells_is_refused(tmp_path):
    (tmp_path / "a.inp").write_text("nonsense\n")
    with pytest.raises(WrongCellType, match="has no cells"):
        read_mesh_arrays(tmp_path / "a.inp")


def test_other_cells_in_vtkhdf_are_refused(tmp_path):
    with VtkHdfSeries(tmp_path / "a.vtkhdf", X, "hex8", HEXES) as series:
        series.append(0.0)
    with h5py.File(tmp_path / "a.vtkhdf", "r+") as file:
        file["VTKHDF/Types"][1] = 10
    with pytest.raises(WrongCellType, match=r"VTK cell types \[10, 12\]"):
        read_mesh_arrays(tmp_path / "a.vtkhdf")


def test_points_that_are_not_finite(tmp_path):
    wrong = X.copy()
    wrong[3, 1] = np.nan
    meshio.write_points_cells(tmp_path / "a.vtu", wrong, [("hexahedron", HEXES)])
    with pytest.raises(NotFinite, match="point 3"):
        read_mesh_arrays(tmp_path / "a.vtu")


def test_cells_on_points_that_do_not_exist(tmp_path):
    meshio.write_points_cells(tmp_path / "a.vtu", X[:10], [("hexahedron", HEXES)])
    with pytest.raises(InvalidValue, match=r"a\.vtu, cell 0"):
        read_mesh_arrays(tmp_path / "a.vtu")


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.msh", "no mesh"),
        ("a.inp", "*ELEMENT, TYPE=C3D8\n1, 2"),
        ("a.vtu", "<VTKFile"),
        ("a.xyz9", ""),
        ("a.vtk", ""),
    ],
)
def test_unreadable_files(file, capfd, name, text):
    path = file(name, text)
    with pytest.raises(FileProblem) as info:
        read_mesh_arrays(path)
    assert info.value.cause
    assert info.value.where == str(path)
    assert ("in format 2" in info.value.remedy) == name.endswith(".msh")
    assert capfd.readouterr() == ("", "")


def test_missing_file(tmp_path):
    for name in ("a.inp", "a.msh", "a.vtkhdf"):
        with pytest.raises(FileProblem, match="a"):
            read_mesh_arrays(tmp_path / name)


def test_meshio_speaks_to_the_log(tmp_path, capfd, caplog):
    caplog.set_level(logging.INFO, logger="umform")
    write_mesh_arrays(tmp_path / "a.msh", X, "hex8", HEXES)
    read_mesh_arrays(tmp_path / "a.msh")
    assert capfd.readouterr() == ("", "")
    assert caplog.messages


def test_writing_refuses(tmp_path):
    with pytest.raises(FileProblem, match="VtkHdfSeries"):
        write_mesh_arrays(tmp_path / "a.stl", X, "hex8", HEXES)
    with pytest.raises(MeshError):
        write_mesh_arrays(tmp_path / "a.vtu", X, "hex20", HEXES)
    with pytest.raises(InvalidValue, match="field"):
        write_mesh_arrays(tmp_path / "a.vtu", X, "hex8", HEXES, {"u": np.zeros(3)})
    with pytest.raises(FileProblem, match="components"):
        write_mesh_arrays(tmp_path / "a.msh", X, "hex8", HEXES, {"S": np.zeros((12, 6))})
    with pytest.raises(FileProblem, match="does not exist"):
        write_mesh_arrays(tmp_path / "no" / "a.vtu", X, "hex8", HEXES)
    assert list(tmp_path.iterdir()) == []

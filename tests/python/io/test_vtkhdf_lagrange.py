"""18-node cells as Lagrange cells of VTK, with the same nodes."""

import h5py
import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter

from umform.analysis.run import solve
from umform.analysis.steps import Move
from umform.errors import InvalidValue, WrongCellType
from umform.io import VtkHdfSeries, read_mesh_arrays
from umform.io.cells import cell_type, to_vtk
from umform.mesh import strip
from umform.model import Model

LAGRANGE_HEXAHEDRON = 72


@pytest.fixture
def path(quadratic_sheet, tmp_path):
    path = tmp_path / "a.vtkhdf"
    sheet = quadratic_sheet
    with VtkHdfSeries(path, sheet.points, "hex18", sheet.connectivity, lagrange=True) as series:
        for time in (0.0, 0.5, 2.0):
            series.append(time, {"displacement": time * sheet.points**2 / 50}, {"eqps": time + np.arange(12)})
    return path


@pytest.fixture
def new_vtk(vtk):
    """VTK, if it is new enough."""
    if vtk.version < (9, 7):
        pytest.skip("VTK before 9.7 ignores the degrees of Lagrange cells in VTKHDF files")
    return vtk


def test_cells_and_points_are_those_of_the_mesh(quadratic_sheet, path, new_vtk):
    for step in range(3):
        grid = new_vtk.read(path, step)
        assert grid.n_points == len(quadratic_sheet.points)
        assert set(grid.celltypes.tolist()) == {LAGRANGE_HEXAHEDRON}
        np.testing.assert_array_equal(np.sort(grid.cells.reshape(-1, 19)[:, 1:]), np.sort(quadratic_sheet.connectivity))
        degrees = grid.GetCellData().GetHigherOrderDegrees()
        np.testing.assert_array_equal(pv.convert_array(degrees), np.tile([2, 2, 1], (12, 1)))
        cell = grid.GetCell(0)
        assert [cell.GetOrder(i) for i in range(3)] == [2, 2, 1]


def test_warped_cells_have_the_deformed_volumes(quadratic_sheet, path, new_vtk):
    warped = new_vtk.read(path, 2).warp_by_vector("displacement")
    quadratic_sheet.points = quadratic_sheet.points + quadratic_sheet.points**2 / 25
    for number in range(warped.n_cells):
        assert new_vtk.volume(warped.GetCell(number)) == pytest.approx(quadratic_sheet.volume(number), rel=1e-13)


@pytest.mark.usefixtures("new_vtk")
def test_curved_surface_encloses_the_volume(quadratic_sheet, path):
    surface = vtkDataSetSurfaceFilter()
    surface.SetInputData(pv.read(path))
    surface.SetNonlinearSubdivisionLevel(4)
    surface.Update()
    total = sum(quadratic_sheet.volume(number) for number in range(12))
    assert pv.wrap(surface.GetOutput()).triangulate().volume == pytest.approx(total, rel=1e-3)


def test_degrees_are_stored_once_and_marked(path):
    with h5py.File(path) as file:
        root = file["VTKHDF"]
        assert root.attrs["Version"].tolist() == [2, 6]
        degrees = root["CellData/HigherOrderDegrees"]
        assert degrees.attrs["Attribute"] == b"HigherOrderDegrees"
        assert degrees.shape == (12, 3)
        assert root["Steps/CellDataOffsets/HigherOrderDegrees"][:].tolist() == [0, 0, 0]
        assert root["Steps/CellDataOffsets/eqps"][:].tolist() == [0, 12, 24]


def test_cells_with_8_nodes_stay_what_they_are(tmp_path):
    X = np.array([(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))])
    with VtkHdfSeries(tmp_path / "a.vtkhdf", X, "hex8", [range(8)], lagrange=True) as series:
        series.append(0.0)
    with h5py.File(tmp_path / "a.vtkhdf") as file:
        assert file["VTKHDF/Types"][:].tolist() == [12]
        assert list(file["VTKHDF/CellData"]) == []


def test_name_of_the_degrees_is_refused_as_a_field(quadratic_sheet, tmp_path):
    sheet = quadratic_sheet
    with VtkHdfSeries(tmp_path / "a.vtkhdf", sheet.points, "hex18", sheet.connectivity, lagrange=True) as series:
        with pytest.raises(InvalidValue, match="degrees of the cells"):
            series.append(0.0, cell_data={"HigherOrderDegrees": np.ones((12, 3))})
        series.append(0.0)
    assert list(read_mesh_arrays(tmp_path / "a.vtkhdf").cells) == ["hex18"]


def test_other_degrees_are_refused(path):
    with h5py.File(path, "r+") as file:
        file["VTKHDF/CellData/HigherOrderDegrees"][5] = (2, 1, 2)
    with pytest.raises(WrongCellType, match=r"degrees \(2, 2, 1\)"):
        read_mesh_arrays(path)
    with h5py.File(path, "r+") as file:
        del file["VTKHDF/CellData/HigherOrderDegrees"]
    with pytest.raises(WrongCellType, match="no cell data HigherOrderDegrees"):
        read_mesh_arrays(path)


def test_cells_with_18_and_27_nodes_in_one_file_become_one_block(quadratic_sheet, path):
    sheet = quadratic_sheet
    full = to_vtk(cell_type("hex18"), sheet.points, sheet.connectivity)
    flat = to_vtk(cell_type("hex18", lagrange=True), sheet.points, sheet.connectivity)
    rows = [*full.connectivity[:4], *flat.connectivity[4:]]
    with h5py.File(path, "r+") as file:
        root = file["VTKHDF"]
        root["Types"][:4] = full.kind.vtk_type
        root["Offsets"][:] = np.cumsum([0, *map(len, rows)])
        for name, array in (("Points", full.points), ("Connectivity", np.concatenate(rows))):
            del root[name]
            root[name] = array
    np.testing.assert_array_equal(read_mesh_arrays(path).cells["hex18"], sheet.connectivity)


def test_result_writes_both_kinds(tmp_path, materials):
    model = Model(strip(4.0, 1.0, 0.2, (2, 1), cell="hex18"), "MI9K3DEAS", material=materials["svk"])
    model.fix("x0")
    pull = model.prescribe("x1", "x", "pull")
    result = solve(model, Move(pull, 0.01, steps=2))
    meshes = {}
    for lagrange in (False, True):
        path = result.write(tmp_path / f"{lagrange}.vtkhdf", lagrange=lagrange)
        meshes[lagrange] = read_mesh_arrays(path)
        with h5py.File(path) as file:
            assert set(file["VTKHDF/Types"][:].tolist()) == {LAGRANGE_HEXAHEDRON if lagrange else 29}
            assert file["VTKHDF/Steps"].attrs["NSteps"] == len(result.frames)
    np.testing.assert_array_equal(meshes[True].points, meshes[False].points)
    np.testing.assert_array_equal(meshes[True].cells["hex18"], meshes[False].cells["hex18"])

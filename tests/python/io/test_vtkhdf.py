"""What readers find in the files: VTK itself, PyVista and umform."""

import h5py
import numpy as np
import pytest
import pyvista as pv

from umform.errors import FileProblem
from umform.io import VtkHdfSeries, read_mesh_arrays

TIMES = (0.0, 0.1, 1.0)


def fields(sheet, time):
    """Fields that are polynomials of the shape functions, so that every reader must hit them exactly."""
    rng = np.random.default_rng(11)
    point_data = {
        "displacement": time * rng.normal(size=(len(sheet.points), 3)),
        "temperature": 20 + time * np.arange(len(sheet.points)),
    }
    cell_data = {
        "eqps": time + np.arange(len(sheet.connectivity)),
        "S": time * np.arange(6.0 * len(sheet.connectivity)).reshape(-1, 6),
    }
    return point_data, cell_data


@pytest.fixture(params=[False, True], ids=["", "lagrange"])
def lagrange(request):
    return request.param


@pytest.fixture
def path(sheet, lagrange, tmp_path):
    path = tmp_path / "a.vtkhdf"
    with VtkHdfSeries(path, sheet.points, sheet.cells, sheet.connectivity, lagrange=lagrange) as series:
        for time in TIMES:
            series.append(time, *fields(sheet, time))
        assert series.times == TIMES
    return path


@pytest.fixture
def readable(path, sheet, lagrange, vtk):
    """The path, if this version of VTK can read the file."""
    if lagrange and sheet.cells == "hex18" and vtk.version < (9, 7):
        pytest.skip("VTK before 9.7 ignores the degrees of Lagrange cells in VTKHDF files")
    return path


def test_vtk_interpolates_as_umform_does(sheet, readable, vtk):
    grid = vtk.read(readable, 2)
    assert grid.n_cells == len(sheet.connectivity)
    u = fields(sheet, TIMES[2])[0]["displacement"]
    rng = np.random.default_rng(5)
    for number, nodes in enumerate(sheet.connectivity):
        cell = grid.GetCell(number)
        vtk_nodes = [cell.GetPointId(i) for i in range(cell.GetNumberOfPoints())]
        for rst in rng.uniform(-1, 1, (5, 3)):
            x, weights = vtk.evaluate(cell, rst)
            N = sheet.shape_functions(rst)
            np.testing.assert_allclose(x, N @ sheet.points[nodes], atol=1e-13)
            np.testing.assert_allclose(weights @ grid["displacement"][vtk_nodes], N @ u[nodes], atol=1e-13)


def test_volumes_in_vtk_are_exact(sheet, readable, vtk):
    grid = vtk.read(readable, 0)
    for number in range(grid.n_cells):
        assert vtk.volume(grid.GetCell(number)) == pytest.approx(sheet.volume(number), rel=1e-13)


def test_every_step_is_read_by_vtk(sheet, readable, vtk):
    n = len(sheet.points)
    assert vtk.times(readable) == TIMES
    for step, time in enumerate(TIMES):
        grid = vtk.read(readable, step)
        point_data, cell_data = fields(sheet, time)
        np.testing.assert_array_equal(grid.points[:n], sheet.points)
        assert sorted(grid.point_data.keys()) == sorted(point_data)
        for name, field in point_data.items():
            np.testing.assert_array_equal(grid.point_data[name][:n], field)
        for name, field in cell_data.items():
            np.testing.assert_array_equal(grid.cell_data[name], field)


def test_pyvista_reads_and_warps(sheet, readable):
    reader = pv.get_reader(readable)
    reader.reader.SetStep(2)
    warped = reader.read().warp_by_vector("displacement")
    expected = sheet.points + fields(sheet, 1.0)[0]["displacement"]
    np.testing.assert_allclose(warped.points[: len(expected)], expected, atol=1e-14)
    assert pv.read(readable).n_cells == len(sheet.connectivity)


def test_mesh_is_stored_once(sheet, path):
    with h5py.File(path) as file:
        root = file["VTKHDF"]
        assert len(root["Points"]) == root["NumberOfPoints"][0]
        assert len(root["Types"]) == len(sheet.connectivity)
        assert root["PointData/displacement"].shape == (3 * len(root["Points"]), 3)
        assert not np.any(root["Steps/PointOffsets"])


def test_mesh_is_read_back(sheet, path):
    mesh = read_mesh_arrays(path)
    np.testing.assert_array_equal(mesh.points, sheet.points)
    assert list(mesh.cells) == [sheet.cells]
    np.testing.assert_array_equal(mesh.cells[sheet.cells], sheet.connectivity)


def test_files_that_are_not_of_this_kind(tmp_path):
    (tmp_path / "text.vtkhdf").write_text("no")
    with pytest.raises(FileProblem, match="VTKHDF"):
        read_mesh_arrays(tmp_path / "text.vtkhdf")
    with h5py.File(tmp_path / "other.vtkhdf", "w") as file:
        file.create_group("VTKHDF").attrs["Type"] = np.bytes_("ImageData")
    with pytest.raises(FileProblem, match="UnstructuredGrid"):
        read_mesh_arrays(tmp_path / "other.vtkhdf")

import itertools
import shutil
import subprocess
import sys
import textwrap

import h5py
import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkCommonCore import reference
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkIOHDF import vtkHDFReader

from umform.errors import FileProblem, InvalidValue
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


@pytest.fixture
def path(sheet, tmp_path):
    path = tmp_path / "a.vtkhdf"
    with VtkHdfSeries(path, sheet.points, sheet.cells, sheet.connectivity) as series:
        for time in TIMES:
            series.append(time, *fields(sheet, time))
        assert series.times == TIMES
    return path


def read_vtk(path, step):
    """What VTK's own reader gives for a step, as a PyVista grid."""
    reader = vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    reader.SetStep(step)
    reader.Update()
    return pv.wrap(reader.GetOutputDataObject(0))


def vtk_times(path):
    """The times of the steps that VTK's own reader finds."""
    reader = vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    return reader.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS())


def vtk_steps(path):
    """The number of steps that VTK's own reader finds; it gives no times for a single one."""
    reader = vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    return reader.GetNumberOfSteps()


def evaluate(cell, rst):
    """Position and interpolation weights in VTK, for parametric coordinates in [-1, 1]."""
    x, weights = [0.0] * 3, [0.0] * cell.GetNumberOfPoints()
    cell.EvaluateLocation(reference(0), [(c + 1) / 2 for c in rst], x, weights)
    return np.array(x), np.array(weights)


def vtk_volume(cell):
    """Volume by a Gauss rule over VTK's own shape functions; differences of these polynomials are exact."""
    abscissae, weights = np.polynomial.legendre.leggauss(5)
    total = 0.0
    for i, j, k in itertools.product(range(5), repeat=3):
        rst = abscissae[[i, j, k]]
        J = [(evaluate(cell, rst + h)[0] - evaluate(cell, rst - h)[0]) / 2 for h in np.eye(3)]
        total += weights[i] * weights[j] * weights[k] * np.linalg.det(J)
    return total


def test_vtk_interpolates_as_umform_does(sheet, path):
    grid = read_vtk(path, 2)
    assert grid.n_cells == len(sheet.connectivity)
    u = fields(sheet, TIMES[2])[0]["displacement"]
    rng = np.random.default_rng(5)
    for number, nodes in enumerate(sheet.connectivity):
        cell = grid.GetCell(number)
        vtk_nodes = [cell.GetPointId(i) for i in range(cell.GetNumberOfPoints())]
        for rst in rng.uniform(-1, 1, (5, 3)):
            x, weights = evaluate(cell, rst)
            N = sheet.shape_functions(rst)
            np.testing.assert_allclose(x, N @ sheet.points[nodes], atol=1e-13)
            np.testing.assert_allclose(weights @ grid["displacement"][vtk_nodes], N @ u[nodes], atol=1e-13)


def test_volumes_in_vtk_are_exact(sheet, path):
    grid = read_vtk(path, 0)
    for number in range(grid.n_cells):
        assert vtk_volume(grid.GetCell(number)) == pytest.approx(sheet.volume(number), rel=1e-13)


def test_every_step_is_read_by_vtk(sheet, path):
    n = len(sheet.points)
    assert vtk_times(path) == TIMES
    for step, time in enumerate(TIMES):
        grid = read_vtk(path, step)
        point_data, cell_data = fields(sheet, time)
        np.testing.assert_array_equal(grid.points[:n], sheet.points)
        assert sorted(grid.point_data.keys()) == sorted(point_data)
        for name, field in point_data.items():
            np.testing.assert_array_equal(grid.point_data[name][:n], field)
        for name, field in cell_data.items():
            np.testing.assert_array_equal(grid.cell_data[name], field)


def test_pyvista_reads_and_warps(sheet, path):
    reader = pv.get_reader(path)
    reader.reader.SetStep(2)
    warped = reader.read().warp_by_vector("displacement")
    expected = sheet.points + fields(sheet, 1.0)[0]["displacement"]
    np.testing.assert_allclose(warped.points[: len(expected)], expected, atol=1e-14)
    assert pv.read(path).n_cells == len(sheet.connectivity)


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


def test_exception_keeps_the_steps_before_it(sheet, tmp_path):
    path = tmp_path / "a.vtkhdf"
    path.write_text("old")
    with (
        pytest.raises(ZeroDivisionError),
        VtkHdfSeries(path, sheet.points, sheet.cells, sheet.connectivity) as series,
    ):
        series.append(0.5, *fields(sheet, 0.5))
        assert path.read_text() == "old"
        raise ZeroDivisionError
    assert [p.name for p in tmp_path.iterdir()] == ["a.vtkhdf"]
    assert vtk_steps(path) == 1


def test_series_without_steps_leaves_the_old_file(sheet, tmp_path):
    path = tmp_path / "a.vtkhdf"
    path.write_text("old")
    with VtkHdfSeries(path, sheet.points, sheet.cells, sheet.connectivity):
        pass
    assert path.read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["a.vtkhdf"]


def test_unfinished_file_of_a_killed_process_is_readable(sheet, tmp_path):
    np.savez(tmp_path / "mesh.npz", points=sheet.points, connectivity=sheet.connectivity)
    script = f"""
        import os, numpy as np
        from umform.io import VtkHdfSeries
        mesh = np.load({str(tmp_path / "mesh.npz")!r})
        path = {str(tmp_path / "a.vtkhdf")!r}
        with VtkHdfSeries(path, mesh["points"], {sheet.cells!r}, mesh["connectivity"]) as series:
            series.append(1.0, {{"displacement": mesh["points"]}})
            series.append(2.0, {{"displacement": 2 * mesh["points"]}})
            os._exit(9)
    """
    ended = subprocess.run([sys.executable, "-c", textwrap.dedent(script)], check=False)
    assert ended.returncode == 9
    (temporary,) = tmp_path.glob(".a.*.vtkhdf")
    shutil.move(temporary, tmp_path / "a.vtkhdf")
    grid = read_vtk(tmp_path / "a.vtkhdf", 1)
    np.testing.assert_array_equal(grid["displacement"][: len(sheet.points)], 2 * sheet.points)


def test_refused_steps_leave_the_file_as_it_was(sheet, tmp_path):
    path = tmp_path / "a.vtkhdf"
    n, m = len(sheet.points), len(sheet.connectivity)
    with VtkHdfSeries(path, sheet.points, sheet.cells, sheet.connectivity) as series:
        for point_data in (
            {"u": np.zeros(n + 1)},
            {"u": np.zeros((n, 3, 3))},
            {"a/b": np.zeros(n)},
            {"u": 0.0},
        ):
            with pytest.raises(InvalidValue, match="field"):
                series.append(0.0, point_data)
        series.append(0.0, {"u": np.zeros((n, 3))}, {"eqps": np.zeros(m)})
        for point_data, cell_data, different in (
            ({"u": np.zeros(n)}, {"eqps": np.zeros(m)}, "u"),
            ({"u": np.zeros((n, 3))}, {}, "eqps"),
            ({"u": np.zeros((n, 3)), "v": np.zeros(n)}, {"eqps": np.zeros(m)}, "v"),
        ):
            with pytest.raises(InvalidValue, match="differ from those of the first step") as info:
                series.append(1.0, point_data, cell_data)
            assert different in info.value.value
        for time in (0.0, -1.0, np.nan):
            with pytest.raises(InvalidValue, match="increase"):
                series.append(time, {"u": np.zeros((n, 3))}, {"eqps": np.zeros(m)})
        series.append(2.0, {"u": np.ones((n, 3))}, {"eqps": np.ones(m)})
    assert vtk_times(path) == (0.0, 2.0)
    assert np.all(read_vtk(path, 1)["u"] == 1)
    with pytest.raises(InvalidValue, match="not open"):
        series.append(3.0)


def test_interrupted_step_does_not_count(sheet, tmp_path, monkeypatch):
    path = tmp_path / "a.vtkhdf"
    u = {"u": sheet.points}
    with VtkHdfSeries(path, sheet.points, sheet.cells, sheet.connectivity) as series:
        series.append(0.0, u)
        with monkeypatch.context() as patch, pytest.raises(FileProblem, match="No space left"):
            patch.setattr("h5py.AttributeManager.__setitem__", _disk_full)
            series.append(1.0, u)
    assert vtk_steps(path) == 1
    np.testing.assert_array_equal(read_vtk(path, 0)["u"][: len(sheet.points)], sheet.points)


def _disk_full(*args):
    raise OSError(28, "No space left on device")


@pytest.mark.skipif(sys.platform != "linux", reason="needs a limit on the size of files")
def test_full_disk_keeps_the_steps_before(tmp_path):
    script = f"""
        import resource, numpy as np
        from umform.errors import FileProblem, InvalidValue
        from umform.io import VtkHdfSeries
        points = np.random.default_rng(0).normal(size=(20_000, 3))
        resource.setrlimit(resource.RLIMIT_FSIZE, (2_500_000, 2_500_000))
        with VtkHdfSeries({str(tmp_path / "a.vtkhdf")!r}, points, "hex8", [range(8)]) as series:
            try:
                for step in range(20):
                    series.append(step, {{"u": points + step}})
            except FileProblem as problem:
                assert "too large" in problem.cause
            try:
                series.append(20, {{"u": points}})
            except InvalidValue as problem:
                assert "not open" in problem.what
            print(len(series.times))
    """
    ended = subprocess.run([sys.executable, "-c", textwrap.dedent(script)], check=True, capture_output=True)
    assert [p.name for p in tmp_path.iterdir()] == ["a.vtkhdf"]
    steps = vtk_steps(tmp_path / "a.vtkhdf")
    assert steps == int(ended.stdout) > 1
    points = np.random.default_rng(0).normal(size=(20_000, 3))
    np.testing.assert_array_equal(read_vtk(tmp_path / "a.vtkhdf", steps - 1)["u"], points + (steps - 1))


def test_file_that_cannot_take_its_name_is_kept(sheet, tmp_path):
    path = tmp_path / "a.vtkhdf"
    with (
        pytest.raises(FileProblem, match="what was written is in"),
        VtkHdfSeries(path, sheet.points, sheet.cells, sheet.connectivity) as series,
    ):
        series.append(0.0)
        path.mkdir()
    (temporary,) = tmp_path.glob(".a.*.vtkhdf")
    assert vtk_steps(temporary) == 1


def test_series_of_mesh_alone_has_steps(sheet, tmp_path):
    path = tmp_path / "a.vtkhdf"
    with VtkHdfSeries(path, sheet.points, sheet.cells, sheet.connectivity) as series:
        series.append(0.0)
    assert pv.read(path).n_cells == len(sheet.connectivity)


def test_missing_directory(sheet, tmp_path):
    with (
        pytest.raises(FileProblem, match="does not exist"),
        VtkHdfSeries(tmp_path / "no" / "a.vtkhdf", sheet.points, sheet.cells, sheet.connectivity),
    ):
        pass


def test_files_that_are_not_of_this_kind(tmp_path):
    (tmp_path / "text.vtkhdf").write_text("no")
    with pytest.raises(FileProblem, match="VTKHDF"):
        read_mesh_arrays(tmp_path / "text.vtkhdf")
    with h5py.File(tmp_path / "other.vtkhdf", "w") as file:
        file.create_group("VTKHDF").attrs["Type"] = np.bytes_("ImageData")
    with pytest.raises(FileProblem, match="UnstructuredGrid"):
        read_mesh_arrays(tmp_path / "other.vtkhdf")

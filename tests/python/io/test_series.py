"""States over time as .vtu, .pvd and .xdmf, read by meshio and by VTK."""

from xml.etree import ElementTree

import meshio
import numpy as np
import pytest
import pyvista as pv
from meshio.xdmf import TimeSeriesReader

import umform as uf
from umform.errors import FileProblem, InvalidValue
from umform.io import VtkHdfSeries
from umform.io.series import SERIES, Grid, Step, convert, write_series

TIMES = (0.0, 0.25, 1.0)


def grid_of(sheet):
    return Grid(sheet.points, sheet.cells, sheet.connectivity)


def steps_of(sheet):
    """Three states; the components of the tensors are all different."""
    rng = np.random.default_rng(3)
    n, m = len(sheet.points), len(sheet.connectivity)
    return [
        Step(time, {"displacement": time * rng.random((n, 3)), "p": rng.random(n)}, {"stress": rng.random((m, 6))})
        for time in TIMES
    ]


def grids(path):
    """The states that VTK's own readers find."""
    reader = pv.get_reader(path)
    for time in reader.time_values:
        reader.set_active_time_value(time)
        yield time, reader.read()[0]


@pytest.mark.parametrize("suffix", [".pvd", ".xdmf"])
def test_vtk_reads_all_states(sheet, tmp_path, suffix, vtk):
    steps = steps_of(sheet)
    path = write_series(tmp_path / f"a b{suffix}", grid_of(sheet), steps)
    found = list(grids(path))
    assert tuple(time for time, _ in found) == TIMES
    n = len(sheet.points)
    for step, (_, grid) in zip(steps, found, strict=True):
        np.testing.assert_array_equal(grid.points[:n], sheet.points)
        np.testing.assert_array_equal(grid.point_data["displacement"][:n], step.points["displacement"])
        stress = grid.cell_data["stress"]
        full = step.cells["stress"][:, [0, 3, 5, 3, 1, 4, 5, 4, 2]]  # 11 12 13 21 22 23 31 32 33
        np.testing.assert_array_equal(stress, full if suffix == ".xdmf" else step.cells["stress"])
    for cell in (0, len(sheet.connectivity) - 1):
        assert vtk.volume(found[-1][1].GetCell(cell)) == pytest.approx(sheet.volume(cell), rel=1e-12)


def test_meshio_reads_all_states(sheet, tmp_path):
    steps = steps_of(sheet)
    path = write_series(tmp_path / "a.xdmf", grid_of(sheet), steps)
    with TimeSeriesReader(path) as reader:
        points, (block,) = reader.read_points_cells()
        np.testing.assert_array_equal(points[: len(sheet.points)], sheet.points)
        assert block.type == {"hex8": "hexahedron", "hex18": "hexahedron27"}[sheet.cells]
        for number, step in enumerate(steps):
            time, at_points, in_cells = reader.read_data(number)
            assert time == step.time
            np.testing.assert_array_equal(at_points["p"][: len(sheet.points)], step.points["p"])
            np.testing.assert_array_equal(in_cells["stress"][0][:, :4], step.cells["stress"][:, [0, 3, 5, 1]])
    written = write_series(tmp_path / "a.vtu", grid_of(sheet), steps)
    mesh = meshio.read(written)
    assert mesh.cells[0].type == block.type
    np.testing.assert_array_equal(mesh.cells[0].data, block.data)
    np.testing.assert_array_equal(mesh.cell_data["stress"][0], steps[-1].cells["stress"])


def test_a_shorter_series_takes_its_old_frames_with_it_and_leaves_other_files(sheet, tmp_path):
    steps, path = steps_of(sheet), tmp_path / "a.pvd"
    write_series(path, grid_of(sheet), steps)
    (tmp_path / "a-frames" / "mine.vtu").touch()
    write_series(path, grid_of(sheet), steps[:2])
    assert sorted(file.name for file in (tmp_path / "a-frames").iterdir()) == ["0000.vtu", "0001.vtu", "mine.vtu"]
    listed = [row.get("file") for row in ElementTree.parse(path).iter("DataSet")]
    assert listed == ["a-frames/0000.vtu", "a-frames/0001.vtu"]
    assert sorted(file.name for file in tmp_path.iterdir()) == ["a-frames", "a.pvd"]


@pytest.mark.parametrize("suffix", list(SERIES))
def test_a_field_that_does_not_fit_leaves_the_old_files(sheet, tmp_path, suffix):
    path, steps = tmp_path / f"a{suffix}", steps_of(sheet)
    write_series(path, grid_of(sheet), steps)
    before = {file: file.read_bytes() for file in tmp_path.rglob("*") if file.is_file()}
    wrong = Step(2.0, {"p": np.zeros(3)}, {})
    with pytest.raises(InvalidValue, match="a point field must have the shape"):
        write_series(path, grid_of(sheet), [*steps, wrong])
    assert {file: file.read_bytes() for file in tmp_path.rglob("*") if file.is_file()} == before


@pytest.mark.parametrize("suffix", list(SERIES))
def test_writing_refuses(sheet, tmp_path, suffix):
    with pytest.raises(InvalidValue, match="no state"):
        write_series(tmp_path / f"a{suffix}", grid_of(sheet), [])
    with pytest.raises(FileProblem, match="does not exist") as raised:
        write_series(tmp_path / "nowhere" / f"a{suffix}", grid_of(sheet), steps_of(sheet))
    assert raised.value.where.endswith(f"a{suffix}")
    with pytest.raises(InvalidValue, match="not written in this format"):
        write_series(tmp_path / "a.stl", grid_of(sheet), steps_of(sheet))


def test_a_folder_in_the_way_of_the_frames_is_named(sheet, tmp_path):
    (tmp_path / "a-frames").touch()
    with pytest.raises(FileProblem) as raised:
        write_series(tmp_path / "a.pvd", grid_of(sheet), steps_of(sheet))
    assert raised.value.where == str(tmp_path / "a-frames")
    assert sorted(file.name for file in tmp_path.iterdir()) == ["a-frames"]


def test_a_result_is_the_same_in_all_formats(tmp_path, materials):
    model = uf.Model(uf.mesh.strip(4.0, 1.0, 0.2, (2, 1), cell="hex18"), "MI9K3DEAS", material=materials["svk"])
    model.fix("x0")
    result = uf.solve(model, uf.Move(model.prescribe("x1", "x", "pull"), 0.01, steps=2), progress=False)
    stored = pv.read(result.write(tmp_path / "run.vtkhdf"))  # the first state
    last = pv.read(result.write(tmp_path / "run.vtu"))
    for suffix in (".pvd", ".xdmf"):
        path = result.write(tmp_path / f"run{suffix}")
        found = list(grids(path))
        assert [time for time, _ in found] == [frame.time for frame in result.frames]
        assert set(found[-1][1].point_data.keys()) == set(stored.point_data.keys())
        assert set(found[-1][1].cell_data.keys()) == set(stored.cell_data.keys())
        np.testing.assert_array_equal(found[0][1].cells, stored.cells)
        np.testing.assert_array_equal(found[-1][1].point_data["displacement"], last.point_data["displacement"])
    with pytest.raises(InvalidValue, match="has Lagrange cells"):
        result.write(tmp_path / "run.vtu", lagrange=True)
    with pytest.raises(InvalidValue, match="not written in this format"):
        result.write(tmp_path / "run.vtk")


@pytest.mark.parametrize("lagrange", [False, True])
@pytest.mark.parametrize("suffix", list(SERIES))
def test_a_stored_file_becomes_what_a_result_writes(sheet, tmp_path, suffix, lagrange):
    steps = steps_of(sheet)
    with VtkHdfSeries(tmp_path / "a.vtkhdf", *grid_of(sheet), lagrange=lagrange) as series:
        for step in steps:
            series.append(*step)
    (tmp_path / "one").mkdir()
    assert convert(tmp_path / "a.vtkhdf", tmp_path / f"a{suffix}") == (1 if suffix == ".vtu" else 3)
    write_series(tmp_path / "one" / f"a{suffix}", grid_of(sheet), steps)
    for file in (file for file in (tmp_path / "one").rglob("*.*") if file.suffix != ".h5"):
        assert (tmp_path / file.relative_to(tmp_path / "one")).read_bytes() == file.read_bytes()
    if suffix == ".xdmf":
        for (_, found), (_, direct) in zip(grids(tmp_path / "a.xdmf"), grids(tmp_path / "one" / "a.xdmf"), strict=True):
            np.testing.assert_array_equal(found.cell_data["stress"], direct.cell_data["stress"])
            np.testing.assert_array_equal(found.points, direct.points)

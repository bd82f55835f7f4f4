"""``umform view``: a picture of a file of fields, and what is refused."""

import subprocess
import sys

import h5py
import numpy as np
import pytest
from matplotlib.image import imread
from typer.testing import CliRunner

import umform as uf
from umform import cli
from umform.cli.view import _add_rolling as add_rolling


def view(*arguments):
    return CliRunner().invoke(cli.app, ["view", *map(str, arguments)])


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    model = uf.Model(uf.mesh.strip(4, 1, 0.2, (4, 2)), "ANS3DEAS", material=uf.SVK(E=1000.0, nu=0.3))
    model.fix("x0", "xyz")
    move = uf.Move(model.prescribe("x1", "z", name="end"), to=1.5, steps=3)
    return uf.solve(model, move, progress=False, frames=9).write(tmp_path_factory.mktemp("view") / "run.vtkhdf")


def test_pictures_show_the_frame_and_the_field(file, tmp_path):
    """In processes of their own, as a machine without any OpenGL ends the process."""
    pictures = []
    for number, options in enumerate((["--frame", "0"], ["--frame", "3"], ["--field", "displacement"])):
        png = tmp_path / f"{number}.png"
        command = [sys.executable, "-m", "umform", "view", file, "--png", png, *options]
        run = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)
        assert run.returncode == 0, run.stderr
        assert run.stderr == ""
        pictures.append(imread(png)[:, :, :3])
    flat, bent, coloured = pictures
    assert flat.shape == (800, 1200, 3)
    for one, other in ((flat, bent), (bent, coloured)):
        assert (np.abs(one - other).max(axis=2) > 0.05).mean() > 0.02


def test_lines_along_the_rolling_direction():
    """On the faces that it lies in, and on no others."""
    pv = pytest.importorskip("pyvista")
    drawn = []

    class Plotter:
        def add_mesh(self, lines, **_):
            drawn.append(lines)

    sheet = pv.ImageData(dimensions=(3, 2, 2)).cast_to_unstructured_grid()
    sheet.cell_data["rolling"] = np.array([[0.6, 0.8, 0.0], [0.0, 1.0, 0.0]])
    add_rolling(pv, Plotter(), sheet, switch=False)
    ends = drawn[0].points.reshape(-1, 2, 3)
    along = ends[:, 1] - ends[:, 0]
    way = along / np.linalg.norm(along, axis=1, keepdims=True)
    first = ends.mean(axis=1)[:, 0] < 1.0
    above = np.abs(ends.mean(axis=1)[:, 2] - 0.5) > 0.5
    assert above.sum() == 4
    assert np.abs(way[first & above]) == pytest.approx(np.tile([0.6, 0.8, 0.0], (2, 1)), abs=1e-6)
    assert np.abs(way[~first & above]) == pytest.approx(np.tile([0.0, 1.0, 0.0], (2, 1)), abs=1e-6)
    assert len(ends) == 5  # above and below both cells; the end of the second, which its direction lies in


@pytest.mark.parametrize(
    ("options", "messages"),
    [
        (["--field", "thicknes"], ["no such field", "thickness_change"]),
        (["--field", "stress_cauchy"], ["tensor", "displacement"]),
        (["--frame", "4"], ["no such frame", "0 to 3"]),
        (["--frame", "-5"], ["no such frame"]),
    ],
)
def test_what_the_file_does_not_have_is_refused(options, messages, file, tmp_path):
    run = view(file, "--png", tmp_path / "a.png", *options)
    assert run.exit_code == 1
    for message in messages:
        assert message in run.stderr
    assert list(tmp_path.iterdir()) == []


def test_other_files_are_refused(file, tmp_path):
    text, other = tmp_path / "a.vtkhdf", tmp_path / "b.vtkhdf"
    text.write_text("step,time\n")
    h5py.File(other, "w").close()
    for path, message in ((tmp_path / "c", "no such file"), (text, "no file of fields"), (other, "no VTKHDF")):
        run = view(path, "--png", tmp_path / "a.png")
        assert run.exit_code == 1
        assert message in run.stderr
    assert "end it in .png" in view(file, "--png", tmp_path / "a.bmp").stderr


def test_a_folder_stands_for_the_one_file_in_it(file, tmp_path):
    assert "no such field" in view(file.parent, "--png", tmp_path / "a.png", "--field", "thicknes").stderr
    empty = view(tmp_path, "--png", tmp_path / "a.png")
    assert empty.exit_code == 1
    assert "a folder without a file of fields" in empty.stderr
    for name in ("bend.vtkhdf", "fields.vtkhdf"):
        (tmp_path / name).write_bytes(file.read_bytes())
    several = view(tmp_path, "--png", tmp_path / "a.png")
    assert several.exit_code == 1
    assert "bend.vtkhdf, fields.vtkhdf" in several.stderr
    assert f"umform view {tmp_path / 'bend.vtkhdf'}" in several.stderr


def test_without_pyvista_the_remedy_is_told(file, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyvista", None)
    run = view(file, "--png", tmp_path / "a.png")
    assert run.exit_code == 1
    assert 'pip install "umform[view]"' in run.stderr
    assert "Traceback" not in run.output


@pytest.mark.skipif(sys.platform != "linux", reason="other systems always have a screen")
def test_without_a_screen_a_picture_is_proposed(file, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    run = view(file)
    assert run.exit_code == 1
    assert "--png" in run.stderr

"""``umform view``: a picture of a file of fields, and what is refused."""

import os
import subprocess
import sys

import h5py
import numpy as np
import pytest
from matplotlib.image import imread
from typer.testing import CliRunner

import umform as uf
from umform import cli


def view(*arguments):
    return CliRunner().invoke(cli.app, ["view", *map(str, arguments)])


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    model = uf.Model(uf.mesh.strip(4, 1, 0.2, (4, 2)), "ANS3DEAS", material=uf.SVK(E=1000.0, nu=0.3))
    model.fix("x0", "xyz")
    move = uf.Move(model.prescribe("x1", "z", name="end"), to=1.5, steps=3)
    return uf.solve(model, move, progress=False, frames=9).write(tmp_path_factory.mktemp("view") / "run.vtkhdf")


def picture(*arguments):
    """Pixels of a picture, made in a process of its own, as a machine without any OpenGL ends the process."""
    command = [sys.executable, "-m", "umform", "view", *arguments]
    run = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)
    if run.returncode < 0:
        pytest.skip("VTK cannot render on this machine")
    assert run.returncode == 0, run.stderr
    assert run.stderr == ""
    return imread(arguments[-1])[:, :, :3]


def test_pictures_show_the_frame_and_the_field(file, tmp_path):
    bent = picture(file, "--no-tools", "--png", tmp_path / "bent.png")
    coloured = picture(file, "--field", "displacement", "--unit", "mm", "--png", tmp_path / "coloured.png")
    flat = picture(file, "--frame", "0", "--png", tmp_path / "flat.png")
    for one in (bent, coloured, flat):
        assert one.shape[1] == 1200
        assert (one[0] == 1.0).all()  # nothing touches the border
        assert (one[-1] == 1.0).all()
        assert (one < 0.9).any(axis=2)[:, :1000].any(axis=0).mean() > 0.9  # the sheet fills the picture
    assert bent.shape == coloured.shape
    assert (np.abs(bent - coloured).max(axis=2) > 0.05).mean() > 0.02
    assert bent.shape[0] > 1.2 * flat.shape[0]


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
    for age, name in enumerate(("draw.vtkhdf", "release.vtkhdf", "before.vtkhdf")):
        (tmp_path / name).write_bytes(file.read_bytes() if name == "release.vtkhdf" else b"")
        os.utime(tmp_path / name, ns=(0, -abs(age - 1) * 10**9))
    last = view(tmp_path, "--png", tmp_path / "a.png", "--field", "thicknes")
    assert "umform: release.vtkhdf, the last one in" in last.stderr
    assert "no such field" in last.stderr


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

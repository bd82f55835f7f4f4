"""umform export: the state of a run for other programs, from its folder, its state or its checkpoint."""

from __future__ import annotations

import shutil

import h5py
import pytest
import pyvista as pv
from command_line import umform

from umform.report.state_files import read_state

BEND = """
[mesh]
generator = "strip"
length = 20.0
width = 2.0
thickness = 1.0
cells = [20, 1]

[material]
library = "DC04"

[units]
length = "mm"
force = "N"

[[supports]]
kind = "fix"
nodes = "x0"

[controls.tip]
kind = "displacement"
nodes = "x1_lower"
direction = "z"

[[steps]]
kind = "move"
to = { tip = -2.0 }
increments = 4

[output]
state = true
pictures = false
report = false
"""
TRIM = """
[before]
deck = "bend.toml"
state = "results/bend/state.h5"
control = "cut"

[[trim]]
line = { corners = [[12.0, -1.0], [12.0, 3.0]], closed = false }

[[supports]]
kind = "rigid"
name = "gauge"

[[steps]]
kind = "move"
to = { cut = 0.0 }
increments = 2

[output]
state = true
pictures = false
report = false
"""


@pytest.fixture(scope="module")
def operations(tmp_path_factory):
    """A folder with two operations, both finished; the first one also left its checkpoint."""
    folder = tmp_path_factory.mktemp("operations")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        (folder / "bend.toml").write_text(BEND)
        (folder / "trim.toml").write_text(TRIM)
        assert umform("run", "bend.toml", "--checkpoint", "bend.h5").exit_code == 0
        assert umform("run", "trim.toml").exit_code == 0
    return folder


@pytest.fixture
def here(operations, monkeypatch):
    """The folder as the present one; new files in it are removed."""
    monkeypatch.chdir(operations)
    before = set(operations.iterdir())
    yield operations
    for file in set(operations.iterdir()) - before:
        shutil.rmtree(file) if file.is_dir() else file.unlink()


def new_files(folder):
    return sorted(path.name for path in folder.iterdir() if path.suffix in (".k", ".sta", ".inp"))


def test_folder_state_and_checkpoint_give_the_same_file(here):
    done = umform("export", "results/bend")
    assert done.exit_code == 0 and "Written to bend.k: 42 nodes, 20 shells" in done.stdout
    text = (here / "bend.k").read_text()
    assert "$ units: mm, N;" in text
    for source in ("results/bend/state.h5", "bend.h5"):
        assert umform("export", source, "--out", "again.k", "--overwrite").exit_code == 0
        assert (here / "again.k").read_text() == text
    assert read_state("bend.k").plastic.max() > 0.005


def test_a_stage_is_an_earlier_operation(here):
    assert umform("export", "results/trim", "--to", "radioss", "--units", "mm, N, MPa").exit_code == 0
    assert umform("export", "results/trim", "--stage", "bend").exit_code == 0
    assert umform("export", "results/bend", "--out", "own.k").exit_code == 0
    assert (here / "bend.k").read_text() == (here / "own.k").read_text()
    trimmed = read_state("trim.sta", "radioss")
    assert trimmed.points[:, 0].max() == pytest.approx(12.0, abs=0.2)
    assert "units: mm, N, MPa" in (here / "trim.sta").read_text()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["results/trim", "--stage", "draw"], ["no such stage", "one of trim, bend"]),
        (["results/bend", "--to", "nastran"], ["unknown program", "--to", "one of dynain"]),
        (["results/bend", "--to", "abaqus", "--mesh", "shells"], ["no such mesh", "--mesh"]),
        (["results/bend", "--points", "40"], ["2 to 20 points", "--points"]),
        (["results/bend", "--mirror"], ["no plane of symmetry", "--mirror"]),
        (["results/none"], ["there is no such run", "results/none"]),
        (["bend.toml"], ["no state of a run", "bend.toml"]),
        (["results"], ["no folder of a run"]),
    ],
)
def test_what_is_wrong_is_one_message_and_no_file(here, words, said):
    done = umform("export", *words)
    assert done.exit_code == 1
    for text in said:
        assert text in done.stderr
    assert "Traceback" not in done.output
    assert not new_files(here)


@pytest.mark.parametrize(("file", "words"), [("state.h5", []), ("fields.vtkhdf", ["--to", "vtu"])])
def test_a_file_that_was_cut_short_is_named(here, file, words):
    """HDF5 says why, but of which file it does not say."""
    data = (here / "results/bend" / file).read_bytes()
    (here / file).write_bytes(data[: len(data) // 2])
    said = umform("export", file, *words, "--out", "bend.vtu" if words else "bend.k").stderr
    assert "this HDF5 file is damaged" in said and f"where:  {file}" in said and "truncated" in said
    assert not new_files(here)


def test_a_file_is_not_overwritten_unasked(here):
    assert umform("export", "results/bend").exit_code == 0
    (here / "bend.k").write_text("mine")
    assert "the file exists" in umform("export", "results/bend").stderr
    assert (here / "bend.k").read_text() == "mine"


@pytest.mark.parametrize("to", ["vtu", "pvd", "xdmf"])
def test_fields_of_a_run_become_those_of_another_format(here, to):
    done = umform("export", "results/bend", "--to", to, "--out", f"bend.{to}")
    assert done.exit_code == 0, done.output
    with h5py.File("results/bend/fields.vtkhdf") as file:
        count = len(file["VTKHDF/Steps/Values"])
    assert done.stdout == f"Written to bend.{to}: {'1 state' if to == 'vtu' else f'{count} states'}\n"
    grid = pv.read(f"bend.{to}")
    grid = grid if to == "vtu" else grid[0]
    assert grid.n_cells == 20 and "displacement" in grid.point_data
    assert "the file exists" in umform("export", "results/bend", "--to", to, "--out", f"bend.{to}").stderr
    assert "end it in" in umform("export", "results/bend", "--to", to, "--out", "bend.k").stderr
    assert "there is no such file" in umform("export", "none.vtkhdf", "--to", to).stderr


def test_a_run_without_a_state_or_not_finished_is_refused(here, tmp_path):
    (tmp_path / "history.csv").write_text("time\n")
    assert "--set output.state=true" in umform("export", tmp_path).stderr
    deck = BEND.replace("tip = -2.0", "tip = -2000.0").replace("increments = 4", "increments = 2\ncuts = 1")
    (tmp_path / "far.toml").write_text(deck)
    assert umform("run", tmp_path / "far.toml", "--checkpoint", tmp_path / "far.h5", "--every", "0").exit_code == 1
    done = umform("export", tmp_path / "far.h5")
    assert done.exit_code == 1 and "not finished" in done.stderr and "umform resume" in done.stderr
    assert not new_files(here)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--to", "abaqus", "--points", "5"], "solids have layers in place of points"),
        (["--to", "radioss", "--layers", "3"], "shells have points in place of layers"),
    ],
)
def test_a_number_of_what_the_mesh_does_not_have_is_refused(words, said, tmp_path):
    done = umform("export", str(tmp_path), *words)
    assert done.exit_code == 1
    assert said in done.stderr

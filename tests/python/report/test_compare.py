"""Histories read back and compared, in Python and on the command line."""

import numpy as np
import pytest
from typer.testing import CliRunner

from umform import cli
from umform.errors import FileProblem, InvalidValue
from umform.io.histories import read_histories, read_history
from umform.io.tables import csv_style, write_csv
from umform.plotting import COLOURS, compare_histories


def plot(*arguments):
    return CliRunner().invoke(cli.app, ["plot", *map(str, arguments)])


@pytest.fixture
def runs(tmp_path):
    """A file, and two folders of the same name with a history each."""
    made = [tmp_path / "coarse.csv", tmp_path / "a" / "fine", tmp_path / "b" / "fine"]
    for factor, path in enumerate(made, start=1):
        (path if path.suffix == "" else path.parent).mkdir(parents=True, exist_ok=True)
        u = np.linspace(0.0, -1.0, 5)
        table = {"step": [0, 1, 1, 1, 1], "punch": u, "punch_force": factor * u / 3, "die_fz": -u}
        write_csv(path if path.suffix else path / "history.csv", table)
    return made


def test_numbers_come_back_bit_by_bit(runs):
    history = read_history(runs[0])
    assert list(history) == ["step", "punch", "punch_force", "die_fz"]
    np.testing.assert_array_equal(history["punch_force"], np.linspace(0.0, -1.0, 5) / 3)
    np.testing.assert_array_equal(read_history(runs[1])["punch"], read_history(runs[1] / "history.csv")["punch"])


def test_runs_have_names_that_tell_them_apart(runs):
    assert list(read_histories(runs[:2])) == ["coarse", "fine"]
    assert list(read_histories([runs[1] / "history.csv"])) == ["fine"]
    assert list(read_histories(runs)) == [str(run) for run in runs]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (None, "no history"),
        ("", "no rows"),
        ("a,b\n", "no rows"),
        ("a,b\n1,2\n3\n", "1 cells"),
        ("a,b\n1,x\n", "numbers"),
        (b"\xff\xfe\x00", "cannot be read"),
        (b"\x89PNG\r\n\x1a\n\x00", "cannot be read"),
        (b"a,b\n1,\xb5\n", "cannot be read"),
        (b"a,b\n" + 200000 * b"1", "cannot be read"),
    ],
)
def test_what_is_no_history_is_refused(text, message, tmp_path):
    path = tmp_path / "history.csv"
    if text is not None:
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
    for place in (path, tmp_path):
        with pytest.raises(FileProblem, match=message) as refused:
            read_history(place)
        assert refused.value.remedy
        assert "codec" not in str(refused.value)
        assert "convert" not in str(refused.value)


def test_a_cell_that_is_no_number_is_named(tmp_path):
    (tmp_path / "history.csv").write_text("step,force\n1,2\n2,x\n")
    with pytest.raises(FileProblem, match="numbers") as refused:
        read_history(tmp_path)
    assert refused.value.where.endswith("line 3, column force")
    assert refused.value.value == "'x'"


def test_a_mark_of_the_byte_order_is_no_part_of_a_name(tmp_path):
    (tmp_path / "history.csv").write_bytes(b"\xef\xbb\xbfstep,force\n1,2\n")
    assert list(read_history(tmp_path)) == ["step", "force"]


def test_runs_have_colours_and_columns_kinds_of_lines(runs):
    histories = read_histories(runs[:2])
    axes = compare_histories(histories, "punch", ["punch_force", "die_fz"]).axes[0]
    lines = {line.get_label(): line for line in axes.lines}
    assert list(lines) == ["coarse: punch_force", "coarse: die_fz", "fine: punch_force", "fine: die_fz"]
    assert [line.get_color() for line in lines.values()] == [COLOURS[0], COLOURS[0], COLOURS[1], COLOURS[1]]
    assert [line.get_linestyle() for line in lines.values()] == ["-", "--", "-", "--"]
    np.testing.assert_array_equal(lines["fine: punch_force"].get_ydata(), histories["fine"]["punch_force"])
    axes = compare_histories(histories, "punch", ["punch_force"]).axes[0]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("punch", "punch_force")
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["coarse", "fine"]


def test_an_unknown_column_is_refused_with_the_nearest(runs, tmp_path):
    with pytest.raises(InvalidValue, match="perhaps punch_force is meant"):
        compare_histories(read_histories(runs), "punch", ["punch_froce"])
    run = plot(*runs[:2], "--x", "punsh", "--y", "punch_force", "--out", tmp_path / "c.png")
    assert run.exit_code == 1
    assert "perhaps punch is meant" in run.stderr
    assert "where:  run coarse" in run.stderr
    assert not (tmp_path / "c.png").exists()


@pytest.mark.parametrize("style", ["plain", "german"])
def test_folders_of_bends_have_a_curve(style, tmp_path):
    u = np.linspace(0.0, 1.0, 5)
    for name in ("bend", "hem"):
        (tmp_path / name).mkdir()
        with csv_style(style):
            write_csv(tmp_path / name / "curve.csv", {"stroke mm": u, "force kN/m": u / 3})
    histories = read_histories([tmp_path / "bend", tmp_path / "hem" / "curve.csv"])
    assert list(histories) == ["bend", "hem"]
    np.testing.assert_array_equal(histories["bend"]["force kN/m"], u / 3)
    listed = plot(tmp_path / "bend")
    assert listed.stdout == "bend: stroke mm, force kN/m\n"
    drawn = plot(tmp_path / "bend", tmp_path / "hem", "--y", "force", "--out", tmp_path / "c.svg")
    assert drawn.exit_code == 0, drawn.output
    text = (tmp_path / "c.svg").read_text()
    assert "stroke mm" in text and "force kN/m" in text


def test_command_writes_a_picture(runs, tmp_path):
    run = plot(*runs, "--x", "punch", "--y", "punch_force", "--y", "die_fz", "--out", tmp_path / "c.svg")
    assert run.exit_code == 0, run.output
    assert "fine" in (tmp_path / "c.svg").read_text()


def test_without_y_the_columns_are_listed(runs):
    run = plot(runs[1])
    assert run.exit_code == 0
    assert run.stdout == "fine: step, punch, punch_force, die_fz\n"

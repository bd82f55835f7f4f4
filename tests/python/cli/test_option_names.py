"""Messages name options and commands, and errors of typing have cause and remedy."""

from __future__ import annotations

import pytest
from typer.testing import CliRunner

from umform.cli import app
from umform.cli.option_names import as_typed
from umform.problem.templates import template

TYPED = [
    ("bend --stroke 8.5", 1, ["or --bottoming"]),
    ("bend --stroke 3 --material AA6016-T4", 1, ["--rolling 90 for", "--rolling 0 for"]),
    ("bend --stroke 3 --punch-radius 20", 1, ["a smaller --punch-radius"]),
    ("bend --stroke 3 --element FOO", 1, ["where:  --element", "cause:"]),
    ("bend --stroke 3 --material S690", 1, ["where:  --material", "umform metal list", "--curve", "cause:"]),
    ("metal show S690", 1, ["where:  umform metal show", "umform metal list"]),
    ("bend --stroke 3 --material DC04 --yield-stress 200", 1, ["cause:", "leave one of them out"]),
    ("bend --stroke 3 --swift 520,0.004", 1, ["2 numbers are given", "520,0.004,0.22"]),
    ("bend correct --material DC04 --stroke 3 --measured-angle 193", 1, ["where:  --measured-angle"]),
    ("bend --stroke 3,0", 2, ["where:  --stroke", "a decimal comma", "write 3.0"]),
    ("bend --stroke 3mm", 2, ["write 3;"]),
    ("bend --layers 1.5", 2, ["a whole number", "cause:"]),
    ("bend --thicknes 3", 2, ["value:  --thicknes", "perhaps --thickness"]),
    ("--thicknes 3", 2, ["no such option", "umform --help"]),
    ("metal fit --yield-function hill48", 2, ["--young", "`umform metal fit --help`"]),
    ("draw cup --opening 200", 1, ["half of --opening"]),
    ("view", 2, ["where:  umform view", "it was left out"]),
    ("bend --stroke", 2, ["where:  --stroke", "nothing stands behind it"]),
    ("identify deck.toml --find E --most 0", 2, ["where:  --most", "a sign, or a typing mistake"]),
    ("store list all", 2, ["where:  umform store list", "an option without its dashes"]),
    ("bend --stroke 3 --material DC04 --on-top DC04,-1", 1, ["where:  --on-top, thickness"]),
    ("bend --stroke 3 --die-dxf .", 1, ["where:  .\n", "cause:  Is a directory\n"]),
    ("draw box", 2, ["umform draw cup, u", "umform new"]),
    ("bend --stroke 6 --thickness 0.08in", 2, ["lengths are in mm", "write 2.032"]),
    ('bend --stroke 6 --thickness .5"', 2, ["lengths are in mm", "write 12.7"]),
    ("bend --stroke 6 --thickness 2mm", 2, ["write 2;"]),
    ("hem --gap 1", 1, ["a flat hem has no gap", "the form open, inner or insert"]),
    ("bnd", 2, ["'bend'", "a typing mistake", "remedy:"]),
]


@pytest.mark.parametrize(("typed", "code", "said"), TYPED)
def test_messages_say_what_to_type(typed, code, said):
    done = CliRunner().invoke(app, typed.split(), prog_name="umform")
    assert done.exit_code == code
    assert done.stderr.startswith("umform: ")
    for text in (*said, "remedy:"):
        assert text in done.stderr
    for python in ("=True", "sheet_metals", "swift_from", "punch_radius", "rolling="):
        assert python not in done.stderr


def test_only_names_of_parameters_are_translated():
    options = {"bottoming": "--bottoming", "angle": "--angle", "punch_radius": "--punch-radius"}
    text = "bottoming=True, angle=90.5, a punch_radius, the angle, my_punch_radius, punch_radius(), other=3"
    said = "--bottoming, --angle 90.5, a --punch-radius, the angle, my_punch_radius, punch_radius(), other=3"
    assert as_typed(text, options) == said


@pytest.mark.parametrize("command", ["run", "check"])
def test_a_sequence_of_bends_is_no_deck(command, tmp_path):
    file = tmp_path / "z.toml"
    file.write_text("length = 110.0\n[[bends]]\nposition = 30.0\nangle = 90.0\n")
    done = CliRunner().invoke(app, [command, str(file)])
    assert done.exit_code == 1
    assert "this is a sequence of bends and no deck" in done.stderr
    assert f"umform bend --sequence {file}" in done.stderr
    assert done.stderr.count("remedy:") == 1


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ("mesh.thickness=zwei", "write a number"),
        ("mesh.thickness=2,5", "write mesh.thickness=2.5"),
        ("mesh.thickness=", "neither a number"),
        ("element.name=BEND", "BEND8"),
    ],
)
def test_values_of_keys_are_told_by_the_kind_of_the_key(change, said, tmp_path):
    (tmp_path / "deck.toml").write_text(template("free-bending"))
    done = CliRunner().invoke(app, ["check", str(tmp_path / "deck.toml"), "--set", change])
    assert done.exit_code == 1
    assert said in done.stderr
    assert "TOML" not in done.stderr


def test_a_finer_mesh_is_asked_for_with_its_limit(tmp_path):
    (tmp_path / "deck.toml").write_text(template("free-bending"))
    done = CliRunner().invoke(app, ["check", str(tmp_path / "deck.toml"), "--set", "mesh.cells=[6, 1]"])
    assert "the warning begins at" in " ".join(done.stdout.split())
    assert "pace" not in done.stdout


@pytest.mark.parametrize(
    "text", ["--want angle=90+-0.05", "angle=91.6+-.1@stroke=3", "angle=90:120", "AirBending(die_angle=88, stroke=6.0)"]
)
def test_pairs_and_calls_stay_as_they_are(text):
    assert as_typed(text, {name: f"--{name}" for name in ("angle", "stroke", "die_angle")}) == text


def test_a_text_that_no_path_contains_is_said(tmp_path):
    (tmp_path / "deck.toml").write_text(template("free-bending"))
    done = CliRunner().invoke(app, ["paths", str(tmp_path / "deck.toml"), "zzz"])
    assert done.exit_code == 1
    assert "no path contains this text" in done.stderr


@pytest.mark.parametrize(
    ("typed", "said"),
    [
        ("new --schema --out schema.json", "umform new --schema > deck-schema.json"),
        ("new --out deck.toml", "umform new TEMPLATE --out FILE"),
        ("export results --to vtu --mirror --points 3", "--points, --mirror"),
    ],
)
def test_options_that_would_do_nothing_are_refused(typed, said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, typed.split(), prog_name="umform")
    assert done.exit_code == 1
    assert said in done.stderr
    assert not list(tmp_path.iterdir())

"""`umform derive`, and `--derive` of a bend."""

import csv
from pathlib import Path

import pytest
from command_line import umform as run

from umform.problem.templates import template_file

COARSE = ["--set", "mesh.cells=[14,1]", "--set", "steps.0.to.stroke=1.0", "--set", "steps.0.increments=10"]


@pytest.fixture(scope="module")
def deck():
    return template_file("air-bending")


def rows(folder: Path):
    with (folder / "derivatives.csv").open(newline="") as text:
        return {(row["response"], row["parameter"]): row for row in csv.DictReader(text)}


def test_a_deck_has_derivatives_as_table_files_and_picture(deck, tmp_path):
    words = ["--by", "material.E", "--by", "strength", "--of", "stroke_force:peak", "--of", "springback_is_no_column"]
    refused = run("derive", deck, *words, *COARSE, "--out", tmp_path / "out")
    assert refused.exit_code == 1
    assert "the run has no such quantity or column" in refused.output
    done = run("derive", deck, *words[:6], *COARSE, "--out", tmp_path / "out")
    assert done.exit_code == 0, done.output
    assert "stroke_force:peak" in done.output
    found = rows(tmp_path / "out")
    # elastic at 1 mm but for a thin layer: the force follows Young's modulus and the strength
    parts = [
        float(found["stroke_force:peak", path]["relative"]) for path in ("material.E", "material.hardening.strength")
    ]
    assert sum(parts) == pytest.approx(1.0, abs=0.01)
    assert {"derivatives.csv", "derivatives-history.csv", "derivatives.png"} == {
        file.name for file in (tmp_path / "out").iterdir()
    }


def test_a_deck_has_slopes_of_whole_runs_in_place_of_derivatives(deck, tmp_path):
    words = ["--by", "material.E", "--of", "stroke_force:peak", *COARSE]
    done = run("derive", deck, *words, "--width", "0.02", "--out", tmp_path / "slopes")
    assert done.exit_code == 0, done.output
    assert "±" in done.output and "5 whole runs" in done.output
    assert run("derive", deck, *words, "--out", tmp_path / "out").exit_code == 0
    exact = float(rows(tmp_path / "out")["stroke_force:peak", "material.E"]["value"])
    with (tmp_path / "slopes" / "slopes.csv").open(newline="") as text:
        [row] = csv.DictReader(text)
    assert float(row["value"]) == pytest.approx(exact, rel=0.02)
    assert float(row["band"]) < 0.1 * exact


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["--by", "mesh.layers"], "it is a whole number"),
        (["--by", "solution.residual"], "its effect is an error of the solution"),
        (["--by", "nowhere"], "there is no number of this path"),
        (["--by", "material.E", "--hold", "angle"], "this holds no result"),
        (["--by", "E", "--hold", "stroke=to.stroke", "--hold", "stroke=die.opening"], "a result is held twice"),
        (["--by", "E", "--hold", "stroke=to.stroke", "--hold", "time=to.stroke"], "a parameter keeps one result"),
        (["--by", "material.E", "--hold", "stroke=nowhere"], "where:  --hold"),
        ([], "there is no parameter for derivatives"),
        (["--by", "material.E", "--width", "0.02", "--hold", "angle=E"], "slopes of whole runs hold no result"),
        (["--by", "material.E", "--width", "2"], "width"),
        (["--by", "material.E", "--width", "1e-300"], "a number from 1e-06 to 0.5"),
    ],
)
def test_what_has_no_derivative_is_refused_by_name(deck, words, text, tmp_path):
    refused = run("derive", deck, *words, *COARSE, "--out", tmp_path / "out")
    assert refused.exit_code != 0
    assert text in refused.output
    assert "Traceback" not in refused.output


def test_a_deck_may_name_its_derivatives(deck, tmp_path):
    named = tmp_path / "deck.toml"
    table = '\n[derivatives]\nby = ["material.E", "strength"]\nresults = ["stroke_force:peak", "stroke:last"]\n'
    named.write_text(deck.read_text() + table + 'hold = { "stroke_force:peak" = "to.stroke" }\n')
    done = run("derive", named, *COARSE, "--out", tmp_path / "out")
    assert done.exit_code == 0, done.output
    assert "stroke_force:peak is constant: steps.0.to.stroke follows" in done.output
    found = rows(tmp_path / "out")
    assert float(found["stroke:last", "material.hardening.strength"]["value"]) < 0.0  # stronger: less stroke
    assert run("check", named).exit_code == 0


@pytest.mark.parametrize(
    ("table", "texts"),
    [
        ('by = ["nowhere"]', ["derivatives.by", "there is no number of this path"]),
        ('by = ["mesh.layers"]', ["mesh.layers", "it is a whole number"]),
        ('by = ["material.E"]\nresults = ["stroke_farce:peak"]', ["derivatives.results", "did you mean stroke_force?"]),
        ('by = ["material.E"]\nhold = { strok = "to.stroke" }', ["derivatives.hold", "did you mean stroke?"]),
        ('by = ["material.E"]\nhold = { stroke = "E" }', ["material.E", "it is adjusted to keep stroke"]),
    ],
)
def test_the_table_of_derivatives_is_checked(deck, table, texts, tmp_path):
    wrong = tmp_path / "deck.toml"
    wrong.write_text(f"{deck.read_text()}\n[derivatives]\n{table}\n")
    for words in (["check"], ["derive", "--out", tmp_path / "out"]):
        found = run(*words, wrong, *COARSE)
        assert found.exit_code == 1
        assert all(text in " ".join(found.output.split()) for text in texts), found.output


def test_a_bend_to_an_angle_has_derivatives_at_that_angle(tmp_path):
    words = ["--layers", 1, "--elements-per-thickness", 1, "--out", tmp_path, "--derive", "thickness"]
    done = run("bend", "--angle", 150, *words, "--derive", "material.hardening.strength")
    assert done.exit_code == 0, done.output
    assert "angle is constant: stroke follows" in done.output
    found = rows(tmp_path)
    assert float(found["angle", "thickness"]["value"]) == 0.0
    # a stronger sheet springs back farther, so that the stroke must be larger
    assert float(found["stroke", "material.hardening.strength"]["value"]) > 0.0
    assert 0.8 < float(found["springback", "material.hardening.strength"]["relative"]) < 1.1


@pytest.mark.parametrize("words", [["bend", "--angle", 150], ["draw", "cup"], ["draw", "u"], ["bead"], ["hem"]])
def test_what_is_no_parameter_is_refused_before_the_run(words, tmp_path):
    """Names of a process stay as they are typed: they are no options there."""
    done = run(*words, "--out", tmp_path / "out", "--derive", "friktion")
    assert done.exit_code == 1
    for text in ("where:  --derive", "did you mean friction?", "remedy: one of ", "material.hardening.strength"):
        assert text in done.stderr
    assert "--die" not in done.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("words", "path", "kept"),
    [
        (["bend", "--angle", 150], "stroke", "angle"),
        (["bend", "--bottoming", "--force-per-metre", 400], "stroke", "force"),
        (["hem", "--form", "open"], "sheet.stroke", "first_angle"),
    ],
)
def test_a_parameter_that_follows_has_no_derivative(words, path, kept, tmp_path):
    done = run(*words, "--out", tmp_path / "out", "--derive", path)
    assert done.exit_code == 1
    assert "a parameter that follows has no derivative" in done.stderr
    assert f"it is adjusted to keep {kept}" in done.stderr
    assert not (tmp_path / "out").exists()


def test_the_force_of_bottoming_is_held(tmp_path):
    coarse = ["--layers", 1, "--elements-per-thickness", 1, "--increment", 0.05, "--out", tmp_path]
    done = run("bend", "--bottoming", "--force-per-metre", 300, *coarse, "--derive", "thickness")
    assert done.exit_code == 0, done.output
    assert "force is constant: stroke follows" in done.stdout
    assert abs(float(rows(tmp_path)["force", "thickness"]["value"])) < 1e-9

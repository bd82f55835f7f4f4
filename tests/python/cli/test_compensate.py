"""`umform compensate`, and `--want` of a bend."""

import csv

import pytest
from command_line import umform as run

from umform.problem.templates import template_file
from umform.surfaces.dxf import layers_and_unit

COARSE = ["--set", "mesh.cells=[14,1]", "--set", "steps.0.to.stroke=1.0", "--set", "steps.0.increments=10"]


def test_a_deck_is_compensated(tmp_path):
    words = ["--want", "stroke_force:peak=45 +- 0.05", "--by", "to.stroke=0.5:2", "--set", "units.length=cm"]
    done = run("compensate", template_file("air-bending"), *words, *COARSE, "--out", tmp_path)
    assert done.exit_code == 0, done.output
    assert "steps.0.to.stroke = " in done.output
    files = {file.name for file in tmp_path.iterdir()}
    assert files >= {"compensation.csv", "compensated.toml", "compensation.html", "compensated.dxf"}
    assert layers_and_unit(tmp_path / "compensated.dxf")[1] == "cm"  # the numbers of the deck, whatever they are


def test_a_bend_with_a_wanted_radius_gets_another_opening(tmp_path):
    coarse = ["--layers", 1, "--elements-per-thickness", 1, "--out", tmp_path]
    wanted = ["--want", "largest_force=40+-0.05", "--by", "opening"]
    done = run("bend", "--stroke", 3, *coarse, *wanted)
    assert done.exit_code == 0, done.output
    assert "Compensation" in done.output
    files = {file.name for file in tmp_path.iterdir()}
    assert files >= {"bend.json", "compensation.html", "compensation.png", "compensated.dxf"}
    assert "Compensation" in (tmp_path / "report.html").read_text()


def test_a_stroke_that_follows_a_wanted_result_is_not_a_given_one(tmp_path):
    coarse = ["--layers", 1, "--elements-per-thickness", 1, "--out", tmp_path, "--overwrite"]
    for wanted, source in ([], "given"), (["--want", "angle=134+-1", "--by", "stroke"], ""):
        done = run("bend", "--stroke", 3, *coarse, *wanted)
        assert done.exit_code == 0, done.output
        strokes = list(csv.DictReader((tmp_path / "quantities.csv").read_text().splitlines()))[:2]
        assert [(one["name"], one["source"]) for one in strokes] == [("stroke", source), ("below_die", source)]


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["--want", "angle", "--by", "strength"], "this is no wanted result"),
        (["--want", "stroke_force:peak=45+-0", "--by", "strength"], "a tolerance of at least"),
        (["--want", "stroke_force:peak=45+-1", "--by", "strength=1"], "these are no bounds"),
        (["--want", "stroke_force:peak=45+-1", "--by", "nowhere"], "there is no number of this path"),
        (["--want", "nothing=45+-1", "--by", "strength"], "the run has no such quantity or column"),
        (["--shape", "upper", "--by", "anvil"], "remedy: one of die, punch"),
        (["--shape", "upper", "--by", "die", "--within", "0"], "where:  --within"),
    ],
)
def test_what_cannot_be_wanted_is_refused(words, text, tmp_path):
    refused = run("compensate", template_file("air-bending"), *words, *COARSE, "--out", tmp_path)
    assert refused.exit_code != 0
    assert text in refused.output
    assert "Traceback" not in refused.output


def test_a_wanted_result_of_a_bend_needs_a_parameter():
    refused = run("bend", "--stroke", 3, "--want", "angle=100+-1")
    assert refused.exit_code != 0
    assert "a wanted result needs a parameter that follows" in refused.output

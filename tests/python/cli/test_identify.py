"""``umform identify``."""

import csv
import re

import numpy as np
import pytest
from typer.testing import CliRunner

import umform as uf
from umform import cli
from umform.problem import load
from umform.problem.templates import template_file

SET = {"mesh.cells": [14, 1], "steps.0.to.stroke": 1.0, "steps.0.increments": 10}
COARSE = [word for key, value in SET.items() for word in ("--set", f"{key}={value}")]


def umform(*words):
    return CliRunner().invoke(cli.app, ["identify", *map(str, words)])


@pytest.fixture(scope="module")
def deck():
    return template_file("air-bending")


@pytest.fixture(scope="module")
def measured(deck, tmp_path_factory):
    """A file of the force of a stiffer sheet."""
    problem = load(deck, SET | {"material.E": 216e3, "material.hardening.strength": 560.0}).build()
    found = uf.solve(problem.model, problem.steps, solver=problem.solver, options=problem.options, progress=False)
    up = found["step"] <= 1
    file = tmp_path_factory.mktemp("measured") / "force.csv"
    x = np.linspace(0.1, 0.95, 9)
    y = np.interp(x, found["stroke"][up], found["stroke_force"][up])
    file.write_text("\n".join(["stroke,stroke_force", *(f"{a:.4f},{b:.6f}" for a, b in zip(x, y, strict=True))]))
    return file


def test_a_deck_takes_its_numbers_from_a_measured_curve(deck, measured, tmp_path):
    words = ["--find", "material.E=150e3:250e3", "--find", "strength=400:700@500"]
    done = umform(deck, *words, "--curve", f"stroke,stroke_force={measured}+-.5", *COARSE, "--out", tmp_path / "out")
    assert done.exit_code == 0, done.output
    assert "Traceback" not in done.output
    assert re.search(r"umform: run 1: misfit \d", done.stderr)
    with (tmp_path / "out" / "identified.csv").open(newline="") as text:
        found = {row["number"]: float(row["value"]) for row in csv.DictReader(text)}
    assert found == pytest.approx({"material.E": 216e3, "material.hardening.strength": 560.0}, rel=2e-3)
    written = {one.path: one.value for one in load(tmp_path / "out" / "deck.toml").paths()}
    assert written["material.E"] == pytest.approx(found["material.E"], rel=1e-6)
    assert (tmp_path / "out" / "identified.png").is_file()
    again = umform(deck, *words, "--curve", f"stroke,stroke_force={measured}", *COARSE, "--out", tmp_path / "out")
    assert again.exit_code == 1
    assert "holds the results of another run" in again.output


CURVE = ("--curve", "stroke,stroke_force=FILE")


@pytest.mark.parametrize(
    ("words", "texts"),
    [
        (["--find", "nowhere=1:2", *CURVE], ["there is no number of this path", "--find"]),
        (["--find", "strength=1,5:2", *CURVE], ["this option cannot be read", "a decimal comma", "--find"]),
        (["--find", "strength=700:400", *CURVE], ["the lower bound is not below the upper one"]),
        (["--find", "strength=1:2", "--find", "strength=2:3", *CURVE], ["looked for twice"]),
        (["--find", "mesh.layers=1:3", *CURVE], ["it is a whole number"]),
        (["--find", "strength", "--curve", "stroke=FILE"], ["this option cannot be read", "--curve"]),
        (["--find", "strength", "--curve", "stroke,force=FILE"], ["the column force is missing"]),
        (["--find", "strength", "--quantity", "angle"], ["this option cannot be read", "--quantity"]),
        (["--find", "strength", "--quantity", "angel=90+-1"], ["no such quantity or column", "where:  --quantity"]),
        (["--find", "strength"], ["nothing was measured", "where:  --quantity, --curve"]),
        (["--find", "strength", "--quantity", "stroke_force:peak=90@strength=5"], ["sought, and given with"]),
        (["--find", "strength", "--quantity", "stroke_force:peak=90@nowhere=5"], ["nowhere"]),
        (["--find", "strength", "--quantity", "stroke_force:peak=90@width=5"], ["a path is ambiguous"]),
        (["--find", "strength", "--quantity", "stroke_force:peak=90@stroke"], ["this option cannot be read"]),
        (["--curve", "stroke,stroke_force=FILE"], ["missing option '--find'"]),
        (["--find", "thickness", "--find", "material.nu=.2:.4", *CURVE, "--quantity", "stroke=1+-.1"], ["deviation"]),
    ],
)
def test_what_cannot_be_read_or_found_is_refused_with_a_remedy(deck, measured, words, texts, tmp_path):
    given = [word.replace("FILE", str(measured)) for word in words]
    refused = umform(deck, *given, *COARSE, "--out", tmp_path / "out")
    assert refused.exit_code in (1, 2)
    for text in texts:
        assert text in refused.output
    assert "Traceback" not in refused.output
    assert not (tmp_path / "out").exists()


def test_a_measured_bend_corrects_its_metal(tmp_path):
    coarse = ["--layers", 1, "--elements-per-thickness", 1, "--stroke", 4.0, "--out", tmp_path / "out"]
    words = ["bend", *coarse, "--find", "strength=400:800", "--quantity", "largest_force=105+-1"]
    done = CliRunner().invoke(cli.app, list(map(str, words)))
    assert done.exit_code == 0, done.output
    numbers = {one.path: one.value for one in load(tmp_path / "out" / "deck.toml").paths()}
    strength = numbers["material.hardening.strength"]
    words = ["bend", *coarse[:-1], tmp_path / "bend", "--curve", f"Swift,{strength},0.004,0.22"]
    again = CliRunner().invoke(cli.app, list(map(str, words)))
    assert re.search(r"largest force .* 105\.0 ", again.output)


def test_measurements_of_sheets_of_two_thicknesses(deck, measured, tmp_path):
    """Their numbers are behind them; the last part of a path will do."""
    problem = load(deck, SET | {"material.hardening.strength": 560.0, "mesh.thickness": 1.9}).build()
    run = uf.solve(problem.model, problem.steps, solver=problem.solver, options=problem.options, progress=False)
    force = run["stroke_force"][run["step"] <= 1][-1]
    first = f"stroke_force:peak={force}+-.1@thickness=1.9"
    curve = f"stroke,stroke_force={measured}+-.5@material.E=216e3@thickness=2"
    words = ["--find", "strength=400:700@500", "--quantity", first, "--curve", curve]
    done = umform(deck, *words, *COARSE, "--out", tmp_path / "out")
    assert done.exit_code == 0, done.output
    with (tmp_path / "out" / "identified.csv").open(newline="") as text:
        (row,) = csv.DictReader(text)
    assert float(row["value"]) == pytest.approx(560.0, rel=2e-3)


def test_a_measured_bend_has_no_other_goal(tmp_path):
    words = ["--find", "strength", "--quantity", "force=100+-1", "--out", str(tmp_path / "out")]
    refused = CliRunner().invoke(cli.app, ["bend", "--angle", "90", *words])
    assert refused.exit_code == 1
    assert "without other goals and studies" in refused.output
    assert not (tmp_path / "out").exists()

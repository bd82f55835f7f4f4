"""`umform sigma`, and the options of scatter of processes."""

import csv
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import umform as uf
from umform.cli.commands import application
from umform.problem.templates import write_template
from umform.processes.air_bending import AirBending
from umform.processes.draw import draw
from umform.processes.draw.u_bend import NUMISHEET, UBend
from umform.processes.problems import frames_of, outcome_of, problem_of

#: A bend in less than a second.
COARSE = ["--stroke", "3", "--layers", "1", "--thickness-points", "5", "--increment", "0.05"]
COARSE += ["--elements-per-thickness", "1.5"]


def call(*words):
    return CliRunner().invoke(application(), list(words), env={"COLUMNS": "160"})


@pytest.fixture
def deck(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_template("cantilever", tmp_path / "deck.toml")
    return "deck.toml"


def table(file):
    with Path(file).open(newline="") as text:
        return {row["name"]: row for row in csv.DictReader(text)}


def test_a_deck(deck):
    few = ["--set", "steps.0.increments=2", "--set", "mesh.cells=[4,1]", "--set", "steps.0.to.force=0.01"]
    words = ["--scatter", "material.E=3%", "--tolerance-of", "thickness=±0.004", "--measure", "force_force"]
    done = call("sigma", deck, *few, *words, "--correlate", "E,thickness=0.5", "--limit", "external_work=0:1")
    assert done.exit_code == 0, done.output
    assert "Shares of the variance" in done.output
    found = table("results/deck-sigma/scatter.csv")
    # the work of a small force is its square over the stiffness, (p t)^2 / (E t^3)
    sizes = np.array([-3.0, -0.4 / 3.0 / 0.1])
    variance = sizes @ np.array([[1.0, 0.5], [0.5, 1.0]]) @ sizes
    relative = float(found["external_work.deviation"]["value"]) / float(found["external_work.mean"]["value"])
    assert 100.0 * relative == pytest.approx(np.sqrt(variance), rel=2e-3)


def test_a_thickness_that_scatters_names_the_press_that_stops_at_one_height(tmp_path):
    """A thicker sheet is touched earlier: at the same depth the punch goes farther from first contact."""
    words = ["bend", *COARSE, "--scatter", "thickness=1%", "--measure", "angle", "--out", str(tmp_path), "--overwrite"]
    free, held = call(*words), call(*words, "--hold", "below_die=stroke")
    assert free.exit_code == held.exit_code == 0, free.output + held.output
    assert "--hold below_die=stroke" in free.output and "--hold" not in held.output
    found = table(tmp_path / "scatter.csv")
    assert float(found["stroke.deviation"]["value"]) == pytest.approx(0.02, rel=1e-6)
    assert float(found["angle.deviation"]["value"]) > 0.15  # the angle changes by some 15 degrees for each mm


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["--scatter", "nu=1%"], ["where:  material.nu", "a part of zero is no scatter"]),
        (["--scatter", "mu=1%"], ["where:  --scatter", "material.E"]),
        (["--scatter", "E"], ["where:  --scatter", "the sign = is missing", "PATH=SIZE"]),
        (["--scatter", "E=1%", "--scatter", "E=2%"], ["where:  --scatter", "a name has two values"]),
        (["--tolerance-of", "E=±x"], ["where:  E", "a scatter is a number"]),
        (["--scatter", "E=1%", "--correlate", "E,nu=a"], ["where:  --correlate"]),
        (["--scatter", "E=1%", "--limit", "force_force=4"], ["where:  --limit", "low:high"]),
        (["--scatter", "E=1%", "--hold", "force_force=mu"], ["where:  --hold"]),
        (["--limit", "force_force=1:4"], ["where:  --scatter", "no parameter scatters"]),
    ],
)
def test_refusals(deck, words, expected):
    done = call("sigma", deck, *words)
    assert done.exit_code == 1
    for text in (*expected, "remedy:"):
        assert text in done.output
    assert "Traceback" not in done.output


def test_one_parameter_has_no_table_of_shares(deck):
    few = ["--set", "steps.0.increments=1", "--set", "mesh.cells=[4,1]", "--set", "steps.0.to.force=0.01"]
    done = call("sigma", deck, *few, "--scatter", "E=1%", "--measure", "force_force")
    assert done.exit_code == 0, done.output
    assert "Scatter of the results" in done.output and "Shares" not in done.output


def test_an_unknown_result_is_refused(deck):
    done = call("sigma", deck, "--set", "steps.0.increments=1", "--scatter", "E=1%", "--limit", "angle=1:4")
    assert done.exit_code == 1
    assert "where:  --limit" in done.output
    assert "force_force" in done.output


def test_a_bend_at_a_held_angle(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    words = [
        "--scatter",
        "thickness=1%",
        "--scatter",
        "strength=4%",
        "--hold",
        "angle=stroke",
        "--limit",
        "stroke=2.9:",
    ]
    done = call("bend", *COARSE, *words)
    assert done.exit_code == 0, done.output
    found = table("results/bend/scatter.csv")
    case = AirBending(stroke=3.0, layers=1, thickness_points=5, increment=0.05, elements_per_thickness=1.5)
    by = ["thickness", "material.hardening.strength"]
    follow = uf.derivatives(case, by, ["angle"], hold={"angle": "stroke"}, progress=False)
    sizes = [0.02, 0.04 * 520.0]
    expected = np.hypot(*(follow["stroke", path].value * size for path, size in zip(by, sizes)))
    assert float(found["stroke.deviation"]["value"]) == pytest.approx(expected)
    cpk = float(found["stroke.cpk"]["value"])
    assert cpk == pytest.approx(0.1 / (3.0 * expected))


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["bend", "--angle", "90", "--scatter", "die-radius=1%"], "did you mean die_radius?"),
        (["bend", "--angle", "90", "--scatter", "die_radius=1%", "--limit", "angel=89:91"], "did you mean angle?"),
        (["bend", "--angle", "90", "--scatter", "die_radius=1%", "--measure", "punch_fs:max"], "where:  --measure"),
        (["bend", "--stroke", "6", "--want", "angel=90+-1", "--by", "stroke"], "did you mean angle?"),
        (["draw", "u", "--coarse", "--scatter", "friction=1%", "--measure", "theta3"], "did you mean theta2?"),
    ],
)
def test_a_process_refuses_before_it_runs(words, text, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("umform.analysis.newton.newton.Newton.solve", None)
    done = call(*words)
    assert done.exit_code == 1
    assert text in done.output
    assert not (tmp_path / "results").exists()


def test_a_drawn_part_is_that_of_a_run_of_its_problem():
    sizes = {"length": 110.0, "stroke": 12.0, "turn": 30.0}
    case = UBend(**NUMISHEET | UBend.meshes["coarse"] | sizes, material=AirBending().material)
    problem = problem_of(case).build()
    run = uf.solve(problem.model, problem.steps, options=problem.options, frames=frames_of(case), progress=False)
    found, drawn = outcome_of(case, run).values, draw(case, progress=False).values
    assert found == drawn


def test_a_bend_to_an_angle_says_that_its_stroke_is_constant(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    coarse = ["--layers", "1", "--elements-per-thickness", "1", "--increment", "0.05", "--tolerance", "0.5"]
    done = call("bend", "--angle", "160", *coarse, "--scatter", "thickness=1%")
    assert done.exit_code == 0, done.output
    assert "the stroke is constant: --hold angle=stroke keeps the angle" in done.stdout


def test_a_part_whose_bends_have_angles_says_that_its_strokes_are_constant_unless_they_follow(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "part.toml").write_text(
        "length = 60.0\n[[bends]]\nposition = 20.0\nangle = 160.0\n[[bends]]\nposition = 40.0\nangle = 160.0\n"
    )
    coarse = ["--layers", "1", "--elements-per-thickness", "1", "--increment", "0.05", "--tolerance", "0.5"]
    given = ["--scatter", "thickness=1%", "--measure", "flange 1", "--hold", "bend 1: angle=bends.0.stroke"]
    done = call("bend", "--sequence", "part.toml", *coarse, *given)
    assert done.exit_code == 0, done.output
    (note,) = [line for line in done.stdout.splitlines() if "the stroke is constant" in line]
    assert "--hold 'bend 2: angle=bends.1.stroke' keeps the bend 2: angle" in note

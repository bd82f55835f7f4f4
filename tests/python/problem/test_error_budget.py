"""Error budgets of decks: coarser variants, the bands that follow, and the command."""

import math

import pytest
from typer.testing import CliRunner

from umform.cli import app
from umform.problem import Problem
from umform.problem.coarser import MESH, VARIANTS, coarser
from umform.problem.error_budget import SAFETY, ends_of_steps, error_budget
from umform.problem.forming import Forming
from umform.problem.measured import Taken
from umform.problem.templates import template, write_template

#: A strip of few elements on a hat rail's tools, drawn by a little.
RAIL = {"mesh.cells": [15, 1], "mesh.length": 75.0, "steps.1.to.stroke": 3.0, "steps.0.force": -20.0}


def changes(name, **more):
    deck = Problem.read(template(name)).with_(more)
    return coarser(deck, deck.build())


def test_each_variant_has_one_change_on_the_coarser_mesh():
    found = changes("hat-rail", **RAIL)
    assert tuple(found) == VARIANTS
    assert found[MESH] == {"mesh.cells": [8, 1]}
    own = {name: {key: one for key, one in change.items() if key != "mesh.cells"} for name, change in found.items()}
    assert all(change["mesh.cells"] == [8, 1] for change in found.values())
    assert own["step*2"]["steps.1.pace.turn"] == 4.0 and own["step*2"]["steps.2.increments"] == 3
    assert own["t-pts-2"] == {"element.thickness_points": 10, "element.thickness_rule": "staggered"}
    assert own["c-pts-1"] == {f"contacts.{name}.points": 2 for name in ("die", "holder", "punch")}
    assert own["depth*2"] == {f"contacts.{name}.penetration": 0.01 for name in ("die", "holder", "punch")}
    assert own["tol*10"] == {"solution.residual": 0.01, "solution.increment": 0.1}


def test_a_mesh_of_a_file_stays(tmp_path):
    write_template("own-mesh", tmp_path / "deck.toml")
    deck = Problem.read((tmp_path / "deck.toml").read_text(encoding="utf-8"), folder=tmp_path)
    found = coarser(deck, deck.build())
    assert set(found) == {"step*2", "t-pts-2"} and found["step*2"]["steps.0.increments"] == 10


@pytest.mark.parametrize(
    ("name", "more", "expected"),
    [
        ("square-cup", {"mesh.x": [0.0, 1.0, 2.0, 75.0], "mesh.y": [0.0, 75.0]}, {"mesh.x": [0.0, 2.0, 75.0]}),
        ("cup", {"mesh.cells": [3, 4]}, {"mesh.cells": [2, 2]}),
        ("cantilever", {"mesh.cells": [1, 1]}, None),
    ],
)
def test_meshes_are_halved(name, more, expected):
    assert changes(name, **more).get(MESH) == expected


def test_a_penalty_is_halved_and_two_contact_points_become_three():
    found = changes(
        "square-cup",
        **{"mesh.x": [0.0, 35.0, 75.0], "mesh.y": [0.0, 75.0], "contacts.die.points": 2, "contacts.die.penalty": 1e3},
    )
    assert found["depth*2"]["contacts.die.penalty"] == 500.0
    assert (found["c-pts-1"]["contacts.die.points"], found["c-pts-1"]["contacts.punch.points"]) == (3, 2)


@pytest.fixture(scope="module")
def rail():
    deck = Problem.read(template("hat-rail")).with_(RAIL | {"steps.1.increments": 4})
    built = deck.build()
    result = built.solve(progress=False)
    return deck, built, result, Taken.of(deck, built, result, complete=True)


def test_the_error_is_that_of_all_changes(rail):
    deck, built, result, taken = rail
    found = error_budget(deck, built, result, taken, processes=1, progress=False)
    force = next(one for one in found.quantities if one.name == "stroke_force.step 2")
    assert force.value == result["stroke_force"][result["step"] == 2][-1] and not force.of_mesh
    assert set(force.band.parts) == set(found.budget.changes) == set(VARIANTS)
    assert force.band.error == pytest.approx(SAFETY * math.hypot(*force.band.parts.values()))
    coarse = deck.with_({"mesh.cells": [8, 1]})
    built = coarse.build()
    other = built.solve(progress=False)
    assert force.band.parts[MESH] == pytest.approx(other["stroke_force"][other["step"] == 2][-1] - force.value)
    assert "stroke.step 2" not in {one.name for one in found.quantities}  # it is prescribed
    header, *rows = found.table
    assert header == ["quantity", "value", "error", *VARIANTS, "unit"] and len(rows) == len(found.quantities)
    used = {one.name: one for one in found.quantities}["forming.forming limit used, by paths"]
    assert used.band.parts[MESH] != 0.0
    forming = Forming.of(deck, result, found.ends)
    assert used in forming.numbers and len(forming.numbers) == 6
    assert "its band" in {text.get_text() for text in forming.diagram.axes[1].get_legend().texts}
    assert used.error_text in "".join(forming.parts())
    assert all(one.band is not None for one in found.leading) and not any(one.of_mesh for one in found.leading)


def test_a_variant_that_fails_leaves_the_error_unknown(rail, monkeypatch):
    monkeypatch.setattr("umform.problem.error_budget._run", lambda task: "it does not converge")
    deck, built, result, taken = rail
    found = error_budget(deck, built, result, taken, processes=1, progress=False)
    assert all(math.isnan(one.band.error) for one in found.quantities)
    assert f"error budget, {MESH}: it does not converge" in result.warnings


def test_ends_of_steps_are_without_loads_and_round_off(rail):
    names = [one.name for one in ends_of_steps(rail[2])]
    assert "stroke_force.step 2" in names and "stroke.step 1" not in names and "hold_force.step 1" not in names


def test_the_command_prints_and_writes_the_errors_also_of_a_run_that_goes_on(tmp_path):
    write_template("own-mesh", tmp_path / "deck.toml")
    keys = ["steps.0.increments=2", "steps.1.increments=2", "output.report=false", "output.pictures=false"]
    given = [word for key in keys for word in ("--set", key)]
    kept, again = str(tmp_path / "kept.h5"), str(tmp_path / "again")
    run = ["run", str(tmp_path / "deck.toml"), "--budget", "--out", str(tmp_path / "out"), "--checkpoint", kept, *given]
    done = CliRunner().invoke(app, run)
    assert done.exit_code == 0, done.output
    assert "of this mesh" in done.output and "t-pts-2" in done.output and "from a file" in done.output
    written = (tmp_path / "out" / "quantities.csv").read_text(encoding="utf-8")
    assert "down_force.step 1" in written
    resumed = CliRunner().invoke(app, ["resume", kept, "--out", again])
    assert resumed.exit_code == 0, resumed.output
    assert (tmp_path / "again" / "quantities.csv").read_text(encoding="utf-8") == written


def test_ranks_have_no_budget(tmp_path):
    write_template("cantilever", tmp_path / "deck.toml")
    done = CliRunner().invoke(app, ["run", str(tmp_path / "deck.toml"), "--budget", "--solver", "petsc"])
    assert done.exit_code != 0 and "one process" in done.output

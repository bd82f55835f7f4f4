import numpy as np
import pytest

from umform.errors import InvalidValue
from umform.problem import Problem, load
from umform.problem.check import check
from umform.problem.findings import Level
from umform.problem.templates import template, template_file, templates, write_template
from umform.processes import FreeBending, free_bending
from umform.processes.problems import problem_of
from umform.processes.solution import drawing_options
from umform.results.penetration import penetrations
from umform_book.nonlinear.hinged_roofs import limit_load
from umform_book.references import table

#: Changes that make a run of a template short.
SHORT = {
    "air-bending": {"steps.0.increments": 12, "steps.0.to.stroke": 0.6, "mesh.cells": [20, 1]},
    "cup": {"steps.1.to.stroke": 1.0, "mesh.cells": [2, 3]},
    "cantilever": {"steps.0.increments": 3, "steps.0.to.force": 0.6},
    "dome": {"steps.0.to.stroke": 2.0, "mesh.cells": [2, 3]},
    "hat-rail": {"steps.1.to.stroke": 1.0, "steps.2.increments": 2, "mesh.cells": [30, 1]},
    "square-cup": {"steps.1.to.stroke": 0.5, "mesh.x": [0.0, 25.0, 35.0, 45.0, 75.0], "mesh.y": [0.0, 35.0, 75.0]},
    "unconstrained-bending": {"steps.0.to.stroke": 2.0, "steps.1.increments": 2, "mesh.cells": [30, 1]},
    "wiping": {"steps.0.to.stroke": 1.5, "steps.1.increments": 2, "mesh.cells": [30, 1]},
    "free-bending": {"steps.0.increments": 5, "steps.0.to.punch": -1.0},
    "hinged-roof": {"steps.0.most": 3, "mesh.cells": [2, 2]},
    "own-mesh": {"steps.0.increments": 4, "steps.0.to.down": -0.5},
}


def test_the_list_is_whole():
    assert set(templates()) == set(SHORT)
    assert all(templates().values())


@pytest.mark.parametrize("name", ["cup", "hat-rail", "square-cup"])
def test_templates_of_drawn_parts_have_the_tolerances_of_drawing(name):
    assert load(template_file(name)).build().options == drawing_options()


@pytest.mark.parametrize("name", SHORT)
def test_each_template_passes_check(name):
    deck = load(template_file(name))
    findings = list(check(deck, deck.build()))
    assert {finding.level for finding in findings} == {Level.OK}
    assert "#:schema deck-schema.json" in template(name).splitlines()[0]


@pytest.mark.parametrize("name", SHORT)
def test_each_template_runs(name):
    problem = load(template_file(name), SHORT[name]).build()
    result = problem.solve(progress=False)
    assert len(result) > 3
    assert result["external_work"][-1] != 0.0
    assert int(result["step"][-1]) == len(problem.steps)
    assert name == "free-bending" or all(one.kept for one in penetrations(result.model, result).values())  # the paper's


def test_free_bending_is_the_example_to_the_last_bit():
    result = load(template_file("free-bending")).build().solve(progress=False)
    bending = free_bending(FreeBending(), progress=False)
    assert np.array_equal(-result["punch"], bending.u)
    assert np.array_equal(-result["punch_force"], bending.F)


@pytest.mark.parametrize(
    "case",
    [
        FreeBending(stroke=1.0, steps=4, contact="nodes", hardening=500.0, mesh=(12, 1)),
        FreeBending(
            stroke=0.5, steps=3, element="MI9K3DEAS", mesh=(6, 1), contact=3, thickness_order=3, tie_E33=True,
            thickness_points=8, thickness_rule="split", unload=False, tool_z=-20.4, solver="superlu", line_search=True,
        ),
    ],
    ids=lambda case: case.name,
)  # fmt: skip
def test_the_deck_of_a_case_gives_its_numbers(case):
    result = Problem.read(problem_of(case).toml()).build().solve(progress=False)
    bending = free_bending(case, progress=False)
    assert np.array_equal(-result["punch"], bending.u)
    assert np.array_equal(-result["punch_force"], bending.F)


def test_cantilever_meets_the_benchmark():
    """Sze, Liu & Lo (2004): the tip comes back by 3.286 and down by 6.698 at the force 4."""
    problem = load(template_file("cantilever")).build()
    problem.solve(progress=False)
    model = problem.model
    tip = model.u.reshape(-1, 3)[model.mesh.nodes("x1")].mean(axis=0)
    assert tip[0] == pytest.approx(-3.286, rel=0.005)
    assert tip[2] == pytest.approx(-6.698, rel=0.005)


def test_hinged_roof_meets_the_benchmark():
    """Sze, Liu & Lo (2004): first maximum of the force."""
    result = load(template_file("hinged-roof")).build().solve(progress=False)
    reference = limit_load(table("sze_hinged_roof_12.7.csv"))
    assert any("a maximum of the load" in event for event in result.events)
    assert 3000 * result["load"][: len(result) // 2].max() == pytest.approx(reference, rel=0.02)
    assert result["load"][-1] == 1.0


def test_written_templates_bring_their_files(tmp_path):
    files = write_template("own-mesh", tmp_path / "deck.toml")
    assert [file.name for file in files] == ["deck.toml", "sheet.inp"]
    load(tmp_path / "deck.toml").build()
    with pytest.raises(InvalidValue, match="there is a file"):
        write_template("own-mesh", tmp_path / "deck.toml")
    with pytest.raises(InvalidValue, match="did you mean air-bending"):
        template("air")

"""Decks of several operations: contact points keep their friction through a cut."""

from __future__ import annotations

import numpy as np
import pytest

from umform.analysis.newton.growing_penalties import relaxed
from umform.errors import UmformError
from umform.problem import load
from umform.problem.check import before_run
from umform.problem.coarser import coarser
from umform.problem.findings import Level
from umform.problem.previous_operation import write_state

#: Tool and contact of both operations.
TOOL = """
[tools.plane]
shape = "Plane"
point = [0.0, 0.0, -0.5]
normal = [0.0, 0.0, 1.0]

[contacts.die]
tool = "plane"
faces = "lower"
friction = 0.3
penalty = 1e4
"""
FIRST = (
    TOOL
    + """
[mesh]
generator = "strip"
length = 10.0
width = 2.0
thickness = 1.0
cells = [10, 1]

[material]
law = "SVK"
E = 210e3
nu = 0.3

[[supports]]
kind = "fix"
nodes = "upper"
directions = "y"

[controls.down]
kind = "displacement"
nodes = "upper"
direction = "z"

[controls.aside]
kind = "displacement"
nodes = "upper"
direction = "x"

[[steps]]
kind = "move"
to = { down = -1e-3 }
increments = 1

[[steps]]
kind = "move"
to = { aside = -0.03 }
increments = 2

[[steps]]
kind = "move"
to = { aside = -0.0299 }
increments = 1
"""
)
SECOND = (
    TOOL
    + """
[before]
deck = "press.toml"
state = "state.h5"
control = "cut"
keep = ["die"]

[[trim]]
line = { corners = [[7.3, -1.0], [7.3, 3.0]], closed = false }
formed = false
edge = "EDGE"

[[supports]]
kind = "fix"
nodes = "upper"

[[steps]]
kind = "move"
to = { cut = 0.0 }
increments = 1
"""
)


@pytest.fixture(scope="module")
def pressed(tmp_path_factory):
    """A folder with the first deck and its state; and its contact at the end."""
    folder = tmp_path_factory.mktemp("friction")
    (folder / "press.toml").write_text(FIRST)
    deck = load(folder / "press.toml")
    problem = deck.build()
    problem.solve(progress=False)
    write_state(problem.model, folder / "state.h5", deck.source.data)
    return folder, problem.contacts["die"].found


@pytest.mark.parametrize(("edge", "same"), [("line", 6), ("elements", 7)])
def test_a_tool_that_stays_keeps_its_friction(pressed, edge, same):
    folder, before = pressed
    (folder / "trim.toml").write_text(SECOND.replace("EDGE", edge))
    problem = load(folder / "trim.toml").build()
    assert ("fitted to the line" in problem.notes[0]) == (edge == "line")
    die = problem.contacts["die"]
    found = problem.model.evaluate(problem.model.system.x).found[die]
    points = same * die.block.per_facet
    np.testing.assert_allclose(found.friction[:points], before.friction[:points], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(found.slip[:points], before.slip[:points], rtol=1e-9)
    assert before.slip[:points].min() > 0.02
    result = problem.solve(progress=False)
    assert result["cut"][-1] == 0.0


def test_coarser_variants_of_an_error_budget_keep_the_points_that_have_friction(pressed):
    folder, _ = pressed
    (folder / "budget.toml").write_text(SECOND.replace("EDGE", "elements"))
    deck = load(folder / "budget.toml")
    (changed,) = coarser(deck, deck.build()).values()
    assert changed == {"contacts.die.penalty": 5e3}
    assert deck.with_(changed).build().solve(progress=False)["cut"][-1] == 0.0


def test_a_tool_that_stays_keeps_the_penalty_that_has_grown(tmp_path):
    """Its points carry what they carried; with the estimate they would carry less."""
    first = FIRST.replace("penalty = 1e4\n", "").replace("down = -1e-3", "down = -6e-3")
    (tmp_path / "press.toml").write_text(first)
    deck = load(tmp_path / "press.toml")
    problem = deck.build()
    problem.solve(progress=False)
    write_state(problem.model, tmp_path / "state.h5", deck.source.data)
    before = problem.contacts["die"]
    (tmp_path / "trim.toml").write_text(SECOND.replace("penalty = 1e4\n", "").replace("EDGE", "elements"))
    problem = load(tmp_path / "trim.toml").build()
    die = problem.contacts["die"]
    assert die.penalty == die.initial_penalty == before.penalty > 1.1 * before.initial_penalty
    points = 7 * die.block.per_facet
    found = problem.model.evaluate(problem.model.system.x).found[die]
    np.testing.assert_allclose(found.pressure[:points], before.found.pressure[:points], rtol=1e-9)
    problem.solve(progress=False)
    assert die.penalty >= before.penalty
    estimate = load(tmp_path / "trim.toml", {"before.keep": []}).build().contacts["die"].penalty
    assert relaxed(problem.model) and die.penalty == estimate < before.penalty


ROLLED = """
[tools.roll]
shape = "Cylinder"
centre = [8.25, 0.0, CENTRE]
axis = "y"
radius = 3.0

[contacts.roll]
tool = "roll"
faces = "upper"
points = 5
friction = 0.2

[[supports]]
kind = "fix"
nodes = "x0"

[controls.way]
kind = "tool"
contact = "roll"
direction = "z"
"""


def rolled(*ways):
    return "".join(f'[[steps]]\nkind = "move"\nto = {{ way = {way} }}\nincrements = 3\n' for way in ways)


@pytest.mark.parametrize("option", ["friction = 0.2\n", "", "augmented = true\n"])
def test_a_tool_that_has_moved_keeps_its_penalty_so_that_two_stages_are_one_run(tmp_path, option):
    """The estimate for a tool at its last place, and a sheet at its first one, is another; multipliers keep forces."""
    metal = 'law = "J2"\nhardening = { curve = "Linear", yield_stress = 200.0, modulus = 1000.0 }'
    sheet = FIRST[FIRST.index("[mesh]") : FIRST.index("[[supports]]")].replace('law = "SVK"', metal)
    sheet = sheet.replace("cells = [10, 1]", "cells = [4, 1]")
    tool = ROLLED.replace("friction = 0.2\n", option)
    for name, text in {
        "whole": sheet + tool.replace("CENTRE", "3.5") + rolled(-1.0, -1.5),
        "press": sheet + tool.replace("CENTRE", "3.5") + rolled(-1.0),
        "next": '[before]\ndeck = "press.toml"\nstate = "state.h5"\nkeep = ["roll"]\n'
        + tool.replace("CENTRE", "2.5")
        + rolled(-0.5),
    }.items():
        (tmp_path / f"{name}.toml").write_text(f"{text}[solution]\nresidual = 1e-11\n")
    deck = load(tmp_path / "press.toml")
    problem = deck.build()
    problem.solve(progress=False)
    write_state(problem.model, tmp_path / "state.h5", deck.source.data)
    after = load(tmp_path / "next.toml").build()
    roll = after.contacts["roll"]
    if not roll.augmented:
        assert roll.penalty == roll.initial_penalty == problem.contacts["roll"].penalty
        estimate = load(tmp_path / "next.toml", {"before.keep": []}).build().contacts["roll"].penalty
        assert abs(estimate / roll.penalty - 1.0) > 1e-3
    staged, whole = after.solve(progress=False), load(tmp_path / "whole.toml").build().solve(progress=False)
    assert staged["way_force"][0] == pytest.approx(whole["way_force"][3], rel=1e-5 if roll.augmented else 1e-9)
    np.testing.assert_allclose(staged.model.u, whole.model.u, atol=1e-6 if roll.augmented else 1e-9)


@pytest.mark.parametrize("rule", ["points = 3", "cells = 3"])
def test_a_tool_that_keeps_its_friction_stands_where_it_stood(rule, tmp_path):
    """It is no overlap that is pressed out, and the travel of the stage before belongs to its place."""
    metal = 'law = "J2"\nhardening = { curve = "Linear", yield_stress = 200.0, modulus = 1000.0 }'
    sheet = FIRST[FIRST.index("[mesh]") : FIRST.index("[[supports]]")].replace('law = "SVK"', metal)
    tools = ROLLED.replace("points = 5", f"{rule}\npenalty = 200.0")
    after = '[before]\ndeck = "press.toml"\nstate = "state.h5"\nkeep = ["roll"]\n'
    placed = "[placement]\nrotation = [[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]]\nshift = [0.0, 0.0, 4.0]\n"
    for name, text in {
        "press": sheet + tools.replace("CENTRE", "3.5") + rolled(-1.0),
        "next": after + tools.replace("CENTRE", "2.5") + rolled(-0.5),
        "first": after + tools.replace("CENTRE", "3.5") + rolled(-0.5),
        "lower": after + tools.replace("CENTRE", "2.45") + rolled(-0.5),
        "left": after + placed + tools.replace("CENTRE", "2.5") + rolled(-0.5),
        "placed": after + placed + tools.replace("CENTRE", "6.5").replace("[8.25", "[-8.25") + rolled(-0.5),
    }.items():
        (tmp_path / f"{name}.toml").write_text(f"{text}[solution]\nresidual = 1e-11\n")
    deck = load(tmp_path / "press.toml")
    problem = deck.build()
    problem.solve(progress=False)
    write_state(problem.model, tmp_path / "state.h5", deck.source.data)
    one, other = (load(tmp_path / f"{name}.toml").build().solve(progress=False) for name in ("next", "placed"))
    for column, sign in (("roll_fx", -1.0), ("roll_fz", 1.0), ("roll_friction_work", 1.0)):
        assert other[column] == pytest.approx(sign * one[column], rel=1e-7)
    assert abs(one["roll_fx"][0]) > 0.03 * one["roll_fz"][0] > 0.0
    deck = load(tmp_path / "next.toml")
    (found,) = (one for one in before_run(deck, deck.build()) if "overlap" in one.text)
    assert found.level is Level.OK
    for name, away in (("first", r"0\.9\d*|1"), ("lower", r"0\.0(5|4\d*)"), ("left", r"[1-9].*")):
        with pytest.raises(UmformError, match=rf"(?s)must stand where it stood.*roll.*up to ({away}) away"):
            load(tmp_path / f"{name}.toml").build()


def test_a_contact_that_keeps_nothing_is_refused(pressed):
    folder, _ = pressed
    (folder / "other.toml").write_text(SECOND.replace("EDGE", "line").replace('keep = ["die"]', 'keep = ["punch"]'))
    with pytest.raises(UmformError, match=r"(?s)no contact of this name.*punch.*one of die"):
        load(folder / "other.toml").build()
    text = SECOND.replace("EDGE", "line").replace("contacts.die", "contacts.base")
    (folder / "renamed.toml").write_text(text)
    with pytest.raises(UmformError, match=r"(?s)no contact of this name.*die.*one of base"):
        load(folder / "renamed.toml").build()

"""Decks of several operations: the second one begins with the state of the first, trims it, and goes on."""

from __future__ import annotations

import csv
import re
import shutil
from pathlib import Path
from types import SimpleNamespace

import meshio
import numpy as np
import pytest
from command_line import umform

import umform as uf
from umform.errors import UmformError
from umform.problem import Problem, load
from umform.problem.check import before_run
from umform.problem.findings import Level
from umform.problem.measured import Taken
from umform.problem.measures.base import FORMED, Formed
from umform.problem.resolution import bends

FIXED = """
[[supports]]
kind = "fix"
nodes = "x0"
"""
SLIDING = "".join(
    f"""
[[supports]]
kind = "symmetry"
nodes = "{nodes}"
normal = "{normal}"
"""
    for nodes, normal in (("x0", "x"), ("y0", "y"), ("lower", "z"))
)
OUTPUT = """
[output]
state = true
report = false
pictures = false
vtkhdf = false
"""
SECOND = """
[before]
deck = "draw.toml"
state = "draw/state.h5"
control = "cut"

[[trim]]
line = { corners = [[4.0, -1.0], [4.0, 3.0]], closed = false }
formed = false

[[supports]]
kind = "rigid"
name = "gauge"

[[steps]]
kind = "move"
to = { cut = 0.0 }
increments = 2
"""


def first(strip):
    """The strip of a metal that flows, whose state is kept."""
    changes = {
        FIXED: SLIDING,
        "[4, 2]": "[5, 1]",
        '"SVK"': '"J2"',
        "nu = 0.3": 'nu = 0.3\nhardening = { curve = "Linear", yield_stress = 160.0, modulus = 500.0 }',
        "to = { pull = 0.1 }\nincrements = 2": "to = { pull = 0.04 }\nincrements = 3",
    }
    for old, new in changes.items():
        assert old in strip
        strip = strip.replace(old, new)
    return strip + OUTPUT


@pytest.fixture(scope="module")
def finished(strip, tmp_path_factory):
    """Folder with both decks, and what a run of the first one has written."""
    folder = tmp_path_factory.mktemp("operations")
    (folder / "draw.toml").write_text(first(strip))
    (folder / "trim.toml").write_text(SECOND + OUTPUT)
    answer = umform("run", folder / "draw.toml", "--out", folder / "draw")
    assert answer.exit_code == 0, answer.output
    assert (folder / "draw" / "state.h5").exists()
    return folder


@pytest.fixture
def drawn(finished, tmp_path):
    """A copy of it, to be changed."""
    return Path(shutil.copytree(finished, tmp_path, dirs_exist_ok=True))


def test_a_deck_goes_on_where_another_has_ended(drawn):
    answer = umform("run", drawn / "trim.toml", "--out", drawn / "trim")
    assert answer.exit_code == 0, answer.output
    assert "trim 1: 2 cells are left" in answer.output
    problem = load(drawn / "trim.toml").build()
    result = problem.solve(progress=False)
    assert result["cut"].tolist() == [1.0, 0.5, 0.0]
    first = load(drawn / "draw.toml").build().solve(progress=False)
    part = uf.Trim([(4.0, -1.0), (4.0, 3.0)], formed=False).of(first)
    gauge = part.model.hold_rigid(name="gauge")
    part.model.put_back(gauge)
    expected = uf.solve(part.model, uf.Move(part.model.unbalanced("cut"), 0.0, steps=2), frames=0)
    np.testing.assert_array_equal(problem.model.u, expected.model.u)
    np.testing.assert_array_equal(result["elastic_energy"], expected["elastic_energy"])
    assert result["elastic_energy"][-1] < 1e-8 * result["elastic_energy"][0]


def test_motions_in_time_begin_with_the_deck(drawn):
    """The time of the model goes on, for laws that know it."""
    floor = """
[tools.floor]
shape = "Plane"
point = [0.0, 0.0, -3.0]
[contacts.floor]
tool = "floor"
faces = "lower"
penalty = 1e3
motion = { time = [0, 1], translation = [[0, 0, 0], [0, 0, 2]] }
"""
    (drawn / "moved.toml").write_text(SECOND + floor + OUTPUT)
    problem = load(drawn / "moved.toml").build()
    heights = {}
    for start in (0.0, 0.5, 1.0):
        problem.model.system.time = 1.0 + start
        heights[start] = problem.contacts["floor"].pose[1][2]
    assert heights == {0.0: 0.0, 0.5: 1.0, 1.0: 2.0}


def test_pressed_tools_are_there_with_the_unbalanced_forces(drawn):
    pad = """
[tools.pad]
shape = "Plane"
point = [0.0, 0.0, 0.5]
normal = [0.0, 0.0, -1.0]
[contacts.pad]
tool = "pad"
faces = "upper"
[controls.held]
kind = "spring"
contact = "pad"
direction = "z"
stiffness = 10.0
"""
    (drawn / "held.toml").write_text(SECOND + pad + OUTPUT)
    problem, alone = load(drawn / "held.toml").build(), load(drawn / "trim.toml").build()
    np.testing.assert_array_equal(problem.controls["cut"].vector, alone.controls["cut"].vector)


PLACED = """
[before]
deck = "draw.toml"
state = "draw/state.h5"

[placement]
rotation = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
shift = [7.0, -2.0, 0.5]

[controls.pull]
kind = "traction"
faces = "x1"
traction = [1.0, 0.0, 0.0]

[[steps]]
kind = "move"
to = { pull = 1.0 }
increments = 1
"""


def test_draw_in_is_measured_from_the_blank_wherever_the_part_is_placed(drawn):
    placed = PLACED + '[measures.edge]\nkind = "draw_in"\nedge = "x1"\n' + FIXED + OUTPUT
    turned = placed.replace("[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]", "[[0.8, -0.6, 0.0], [0.6, 0.8, 0.0]")
    there = placed[: placed.index("[placement]")] + placed[placed.index("[controls") :]
    found, values = [], []
    for text in (there, placed, turned):
        (drawn / "edge.toml").write_text(text)
        deck = load(drawn / "edge.toml")
        model = deck.sheet()
        formed = {FORMED: model.u.reshape(-1, 3)}
        part = Formed(SimpleNamespace(model=model), None, formed, 0, deck.contents.units, placed=deck.placed)
        found.append(part.from_blank(FORMED))
        if text is not turned:
            problem = deck.build()
            taken = Taken.of(deck, problem, problem.solve(progress=False), complete=True)
            values.append(next(one.value for one in taken.quantities if one.name == "edge.draw-in, mean.formed"))
    np.testing.assert_allclose(found[1:], [found[0]] * 2, atol=1e-12)
    assert values[0] < -0.03
    assert values[1] == pytest.approx(values[0], rel=1e-9)


def test_sections_are_measured_from_the_blank_wherever_the_part_is_placed(drawn):
    cut = '[measures.{0}]\nkind = "{0}"\n'
    placed = PLACED + cut.format("angle") + cut.format("section") + FIXED + OUTPUT
    there = placed[: placed.index("[placement]")] + placed[placed.index("[controls") :]
    found = []
    for rows in (None, "[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]", "[0, 0, 1.0], [0, 1.0, 0], [-1.0, 0, 0]"):
        old = "[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]"
        text = there if rows is None else placed.replace(f"[{old}]", f"[{rows}]")
        text = text.replace("{ pull = 1.0 }", "{ pull = 1e-9 }")  # along x of the new place
        (drawn / "cut.toml").write_text(text)
        deck = load(drawn / "cut.toml")
        problem = deck.build()
        taken = Taken.of(deck, problem, problem.solve(progress=False), complete=True)
        numbers = {one.name: one.value for one in taken.quantities if "bow" not in one.name}
        found.append([*numbers.values(), *np.column_stack(list(taken.measures["section"].columns.values())).ravel()])
    assert numbers["angle.angle.formed"] == pytest.approx(180.0, abs=1e-3)
    np.testing.assert_allclose(found[1:], [found[0]] * 2, atol=1e-9)


def test_a_rigid_support_holds_a_part_where_it_lies(drawn):
    rigid = '[[supports]]\nkind = "rigid"\nname = "gauge"\nnodes = "x0"\n'
    straight = "[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]"
    shapes = []
    for rows in (straight, "[0, 0, 1.0], [0, 1.0, 0], [-1.0, 0, 0]", "[0, -1.0, 0], [1.0, 0, 0], [0, 0, 1.0]"):
        text = PLACED.replace(straight, rows).replace("pull = 1.0", "pull = 0.0") + rigid
        problem = Problem.read(text, folder=drawn).build()
        problem.solve(progress=False)
        x = problem.model.positions
        shapes.append(np.linalg.norm(x[:, None] - x, axis=-1))  # all distances
    np.testing.assert_allclose(shapes[1:], [shapes[0]] * 2, atol=1e-9)


def test_faces_of_sheets_look_at_each_other_where_the_part_lies(drawn):
    below = '[added.base]\ngenerator = "strip"\nlength = 10.0\nwidth = 2.0\nthickness = 1.0\ncells = [4, 1]\n'
    touch = '[sheet_contacts.stack]\nfaces = "{} of part"\nothers = "upper of base"\n'
    text = PLACED.replace("[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]", "[0.0, -1.0, 0.0], [0.0, 0.0, -1.0]]")  # upside down
    text = text.replace("[7.0, -2.0, 0.5]", "[0.0, 2.0, 0.0]").replace('"x1"', '"x1 of part"')
    text += f"{below}shift = [0.0, 0.0, -1.2]\n"
    Problem.read(text + touch.format("upper"), folder=drawn).build()
    with pytest.raises(UmformError, match="look the same way"):
        Problem.read(text + touch.format("lower"), folder=drawn).build()


ROLL = """
[tools.roll]
shape = "Cylinder"
centre = [0.0, 0.0, 7.0]
axis = "y"
radius = 6.0

[contacts.roll]
tool = "roll"
faces = "upper"
points = "auto"
"""


def test_sizes_of_elements_are_those_where_the_part_lies(drawn):
    text = (drawn / "draw.toml").read_text()
    (drawn / "draw.toml").write_text(text.replace("[5, 1]", "[20, 1]"))  # short elements along x
    assert umform("run", drawn / "draw.toml", "--out", drawn / "draw", "--overwrite").exit_code == 0
    placed = PLACED.replace("[7.0, -2.0, 0.5]", "[0.0, 0.0, 0.0]") + FIXED + ROLL
    there = placed[: placed.index("[placement]")] + placed[placed.index("[controls") :]
    turned = placed.replace("[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]", "[[0.0, -1.0, 0.0], [1.0, 0.0, 0.0]")
    found = []
    for text in (there, turned.replace('axis = "y"', 'axis = "x"')):
        deck = Problem.read(text, folder=drawn)
        problem = deck.build()
        size = [one.text for one in bends(deck, problem) if "an element is" in one.text]
        found.append(size)
    assert found[1] == found[0] != []


def test_tools_are_written_near_the_place_of_the_part(drawn):
    floor = '[tools.floor]\nshape = "Plane"\npoint = [0.0, 0.0, -0.5]\nnormal = "z"\n'
    floor += '[contacts.floor]\ntool = "floor"\nfaces = "lower"\n'
    (drawn / "far.toml").write_text(PLACED.replace("[7.0, -2.0, 0.5]", "[70.0, -2.0, 0.5]") + floor + FIXED + OUTPUT)
    umform("check", drawn / "far.toml", "--tools", drawn / "tools")
    points = meshio.read(drawn / "tools" / "floor.stl").points
    low, high = (getattr(load(drawn / "far.toml").sheet().positions, end)(axis=0)[:2] for end in ("min", "max"))
    assert (points[:, :2].min(axis=0) < low).all()
    assert (points[:, :2].max(axis=0) > high).all()


@pytest.mark.parametrize("row", ["[0.0, 0.0, -1.0]", "[0.0, 0.0, 0.999]"])
def test_a_placement_is_a_rotation(row, drawn):
    with pytest.raises(UmformError, match=r"right-handed(.*\n)*.*placement.rotation(.*\n)*.*cosines with all digits"):
        Problem.read(PLACED.replace("[0.0, 0.0, 1.0]]", f"{row}]"), folder=drawn)


@pytest.mark.parametrize("control", ["", 'control = "left"'])
def test_supports_of_a_formed_part_do_not_move_it_back(control, drawn):
    """They would be where the nodes were in the blank, in the first increment."""
    aside = '[controls.aside]\nkind = "displacement"\nnodes = "x1"\ndirection = "x"\n'
    step = '[[steps]]\nkind = "move"\nto = { aside = 0.1 }\nincrements = 2\n'
    begins = PLACED.replace('state = "draw/state.h5"\n', f'state = "draw/state.h5"\n{control}\n')
    stays = begins.replace("[7.0, -2.0, 0.5]", "[0.0, 0.0, 0.0]")
    for text in (begins + SLIDING, stays + aside + step + SLIDING):
        (drawn / "moved.toml").write_text(text + OUTPUT)
        with pytest.raises(
            UmformError, match=r"holds a node elsewhere than it is(.*\n)*.*before(.*\n)*.*kind = \"fix\""
        ):
            load(drawn / "moved.toml").build()


def test_a_changed_deck_and_its_paths_are_without_the_sheet_of_the_one_before(drawn):
    problem = load(drawn / "trim.toml", {"steps.0.increments": 3})
    (drawn / "three.toml").write_text(problem.toml(remarks=["in three increments"]))
    text = (drawn / "three.toml").read_text()
    assert text.startswith("# in three increments") and "[mesh]" not in text
    assert load(drawn / "three.toml").build().steps[0].steps == 3
    assert {one.path.partition(".")[0] for one in problem.paths()} == {"trim", "steps", "solution"}


def test_a_trimmed_part_is_measured_before_and_after_its_forces_have_gone(drawn):
    measure = '\n[measures.along]\nkind = "section"\n[measures.fit]\nkind = "gauge"\n'
    (drawn / "measured.toml").write_text(SECOND + measure + OUTPUT)
    answer = umform("run", drawn / "measured.toml", "--out", drawn / "measured")
    assert answer.exit_code == 0, answer.output
    with (drawn / "measured" / "measures.csv").open() as file:
        rows = {row["quantity"]: row for row in csv.DictReader(file)}
    along = rows["length of the mid-surface"]
    assert float(along["released"]) < float(along["formed"])  # the pulled strip springs back
    assert float(rows["largest distance from the gauge"]["released"]) > 0.0


def test_what_was_cut_off_is_said_of_a_run_that_ends_early_too(drawn):
    text = SECOND.replace("to = { cut = 0.0 }", "to = { cut = -1e9 }\ncuts = 0")
    (drawn / "early.toml").write_text(text)
    with pytest.raises(UmformError) as caught:
        load(drawn / "early.toml").build().solve(progress=False)
    assert any("trim 1: 2 cells are left" in event for event in caught.value.result.events)


def test_a_third_operation_and_a_run_that_was_stopped(drawn):
    assert umform("run", drawn / "trim.toml", "--out", drawn / "trim").exit_code == 0
    third = (SECOND + OUTPUT).replace('"draw.toml"', '"trim.toml"').replace('"draw/', '"trim/')
    third = third.replace("[4.0, -1.0], [4.0, 3.0]", "[2.0, -1.0], [2.0, 3.0]")
    (drawn / "again.toml").write_text(third)
    deck = load(drawn / "again.toml")
    assert len(deck.sheet().mesh.connectivity) == 1
    checkpoint = drawn / "kept.h5"
    answer = umform("run", drawn / "again.toml", "--out", drawn / "again", "--checkpoint", checkpoint)
    assert answer.exit_code == 0, answer.output
    resumed = umform("resume", checkpoint, "--out", drawn / "resumed")
    assert resumed.exit_code == 0, resumed.output
    whole, taken_up = (drawn / name / "history.csv" for name in ("again", "resumed"))
    assert whole.read_text() == taken_up.read_text()


def test_decks_cannot_be_before_each_other(tmp_path):
    table = '[before]\ndeck = "{}.toml"\nstate = "state.h5"\ncontrol = "cut"\n'
    for name, other in (("a", "b"), ("b", "c"), ("c", "a")):
        (tmp_path / f"{name}.toml").write_text(table.format(other))
    with pytest.raises(UmformError, match=r"(?s)operation before itself.*c.toml"):
        load(tmp_path / "a.toml")


def test_a_state_is_that_of_a_run_to_the_end(drawn):
    (drawn / "draw" / "state.h5").unlink()
    answer = umform("run", drawn / "draw.toml", "--set", "solution.max_iterations=1", "--out", drawn / "failed")
    assert answer.exit_code == 1
    assert not (drawn / "failed" / "state.h5").exists()


@pytest.mark.parametrize(
    ("deck", "change", "said"),
    [
        ("trim", ('deck = "draw.toml"', 'deck = "trim.toml"'), "operation before itself"),
        ("trim", ('state = "draw/', 'state = "nowhere/'), "has left no state"),
        ("trim", ("[[trim]]", "[element]\n[[trim]]"), "element is that of the deck before"),
        ("trim", ("[4.0, -1.0], [4.0, 3.0]", "[40.0, -1.0], [40.0, 3.0]"), "cuts nothing off"),
        ("trim", ("formed = false", 'view = "r"'), "trim"),
        ("trim", ('kind = "rigid"\nname = "gauge"', 'kind = "fix"\nnodes = "x1"'), "cut off"),
        ("trim", ("to = { cut = 0.0 }", "to = { cur = 0.0 }"), "did you mean cut"),
        ("draw", ("cells = [5, 1]", "cells = [6, 1]"), "belongs to another model"),
        ("draw", ("modulus = 500.0", "modulus = 400.0"), "material of the run: other than in the deck"),
        ("trim", ("[before]", "[befor]"), "names none"),
    ],
)
def test_mistakes_are_named(drawn, deck, change, said):
    path = drawn / f"{deck}.toml"
    assert change[0] in path.read_text()
    path.write_text(path.read_text().replace(*change))
    with pytest.raises(UmformError) as caught:
        load(drawn / "trim.toml").build()
    assert said in str(caught.value)


@pytest.mark.parametrize(
    ("deck", "change", "said"),
    [
        ("draw", ("to = { pull = 0.04 }", "to = { pull = 0.05 }"), "other values than draw.toml has now: steps"),
        ("trim", ("to = { cut = 0.0 }", "to = { cut = 0.5 }"), "the last step that moves it ends at 0.5"),
        ("draw", ("report = false", "report = true"), ""),
    ],
)
def test_a_state_of_other_values_and_forces_that_stay_are_warned_of(drawn, deck, change, said):
    path = drawn / f"{deck}.toml"
    assert change[0] in path.read_text()
    path.write_text(path.read_text().replace(*change))
    problem = load(drawn / "trim.toml")
    warned = [found for found in before_run(problem, problem.build()) if found.level is Level.WARNING]
    told = [found.text for found in warned if found.about in ("before", "control cut")]
    assert [said in text for text in told] == [True] * bool(said)


def test_the_remedy_for_a_missing_state_names_its_folder(drawn):
    path = drawn / "trim.toml"
    path.write_text(path.read_text().replace("draw/state.h5", "results/other/state.h5"))
    with pytest.raises(UmformError, match=r"--out .*results/other"):
        load(path).build()


def test_numbers_of_a_part_whose_metal_is_of_the_library_can_be_changed(drawn):
    text = (drawn / "draw.toml").read_text()
    metal = re.search(r'law = "J2"(\n.*){3}\n', text).group()
    (drawn / "draw.toml").write_text(text.replace(metal, 'library = "DC04"\n'))
    (drawn / "pull.toml").write_text(PLACED + FIXED + OUTPUT)
    deck = load(drawn / "pull.toml")
    assert "controls.pull.traction.0" in {one.path for one in deck.paths()}
    assert deck.with_({"controls.pull.traction.0": 2.0}).contents.controls["pull"].traction[0] == 2.0

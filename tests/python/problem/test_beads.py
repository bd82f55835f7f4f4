"""Draw beads in decks."""

import numpy as np

from umform.history_variables import named
from umform.model.contact.kept_history import KeptContact
from umform.problem import Problem

BEADED = """
[mesh]
generator = "strip"
length = 30.0
width = 2.0
thickness = 1.0
cells = [12, 1]
[material]
law = "SVK"
E = 210e3
nu = 0.3
[tools.bed]
shape = "Plane"
point = [0, 0, -0.5]
normal = [0, 0, 1]
[contacts.bed]
tool = "bed"
faces = "lower"
penalty = 1e3
[beads.front]
contact = "bed"
curve = [[9, -9, -0.5], [9, 9, -0.5]]
restraint = 30.0
width = 6.0
[[supports]]
kind = "fix"
nodes = { min = [-1, -9, -9], max = [99, 9, 9] }
directions = "yz"
[controls.pull]
kind = "displacement"
nodes = "x1"
direction = "x"
[[steps]]
kind = "move"
to = { pull = 0.5 }
increments = 4
"""


def test_a_deck_with_a_bead_is_solved():
    result = Problem.read(BEADED, "deck.toml").build().solve()
    np.testing.assert_allclose(result["pull_force"][1:], 60.0, rtol=2e-3)
    np.testing.assert_allclose(result["front_restraint"][-1], 60.0, rtol=2e-3)


def test_faces_of_a_bead_are_those_of_its_contact_or_its_own():
    problem = Problem.read(BEADED, "deck.toml").build()
    (bead,) = problem.model.system.others
    np.testing.assert_array_equal(bead.faces, problem.contacts["bed"].faces)
    fewer = BEADED.replace("width = 6.0", "width = 6.0\nfaces = { min = [-1, -9, -9], max = [20, 9, -0.4] }")
    (bead,) = Problem.read(fewer, "deck.toml").build().model.system.others
    assert 0 < len(bead.faces) < 12


def test_a_bead_of_no_contact_a_negative_one_and_one_beside_its_tool_are_named(errors):
    (error,) = errors(BEADED.replace('contact = "bed"', 'contact = "bad"'))
    assert "no contact of this name" in error.what and "line 21, beads.front.contact" in error.where
    (error,) = errors(BEADED.replace("restraint = 30.0", "restraint = -30.0"))
    assert "line 23, beads.front.restraint" in error.where
    (error,) = errors(BEADED.replace("[9, -9, -0.5]", "[9, -9, -9.5]"))
    assert "beside its tool" in error.what and "beads.front" in error.where


def test_a_bead_holds_a_placed_part_from_where_it_lies():
    """The way from the place of the blank was one along the tool: the bead slipped at once, and had its work."""
    pulled = BEADED.replace("displacement", "force").replace('direction = "x"', "force = [90.0, 0.0, 0.0]")
    pulled = pulled.replace("E = 210e3", "E = 2e3").replace("pull = 0.5", "pull = 1.0")
    pulled = '[[supports]]\nkind = "fix"\nnodes = "x0"\n' + pulled
    moved = "[placement]\nrotation = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\nshift = [50.0, 3.0, 0.0]\n"
    placed = moved + pulled.replace("[[9, -9, -0.5], [9, 9, -0.5]]", "[[59, -9, -0.5], [59, 9, -0.5]]")
    here, there = (Problem.read(text, "deck.toml").build().solve() for text in (pulled, placed))
    for column in ("front_restraint", "front_slipping", "front_work", "external_work"):
        np.testing.assert_allclose(there[column], here[column], rtol=1e-9, atol=1e-9)
    assert here["front_restraint"][0] == here["front_work"][0] == 0.0
    assert here["front_work"][-1] > 1.0


def test_the_forces_of_a_kept_bead_turn_with_it():
    problem = Problem.read(BEADED.replace("width = 6.0", "width = 6.0\nuplift = 2.0"), "deck.toml").build()
    problem.solve()
    (bead,) = problem.model.system.others
    kept, turn = KeptContact.of(bead), np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
    moved = kept.moved((turn, np.array([5.0, 3.0, -7.0])))
    before, after = (named(one.history, one.history_variables) for one in (kept, moved))
    assert abs(before["traction"]).max() > 1.0 and abs(before["lift"]).max() > 0.1
    for name in ("traction", "lift"):
        np.testing.assert_allclose(after[name], before[name] @ turn.T)
    np.testing.assert_allclose(after["place"], before["place"] @ turn.T + [5.0, 3.0, -7.0])

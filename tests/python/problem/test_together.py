"""Decks with several sheets."""

from __future__ import annotations

import numpy as np
import pytest

from umform.problem import Problem
from umform.problem.coarser import MESH, coarser
from umform.problem.error_budget import error_budget
from umform.problem.errors import DeckError
from umform.problem.measured import Taken

DECK = """
title = "Two strips"

[mesh]
generator = "together"

[mesh.sheets.base]
mesh = { generator = "strip", length = 10.0, width = 2.0, thickness = 1.0, cells = [5, 1] }

[mesh.sheets.cover]
mesh = { generator = "strip", length = 10.0, width = 2.0, thickness = 0.5, cells = [6, 1] }
shift = [0.0, 0.0, 0.75]
material = { library = "AA6016-T4", rolling = "x" }

[material]
law = "SVK"
E = 210e3
nu = 0.3

[sheet_contacts.stack]
faces = "upper of base"
others = "lower of cover"

[[supports]]
kind = "fix"
nodes = "x0 of base"

[[supports]]
kind = "fix"
nodes = "x0 of cover"

[controls.end]
kind = "displacement"
nodes = "x1 of cover"
direction = "z"

[[steps]]
kind = "move"
to = { end = -0.05 }
increments = 2
"""


@pytest.mark.parametrize("kind", ["angle", "section", "springback"])
def test_measures_of_a_section_are_those_of_one_sheet(kind):
    with pytest.raises(DeckError, match=r"a section is that of one sheet(.*\n)*.*measures.it(.*\n)*.*2 sheets are cut"):
        Problem.read(f'{DECK}[measures.it]\nkind = "{kind}"\n').build()


@pytest.mark.parametrize(
    ("mesh", "message"),
    [
        ('generator = "together"\nsheets = {}', "this generator is unknown"),
        (
            'generator = "outline"\noutline = { corners = [[0, 0], [9, 0], [9, 2]] }\nthickness = 1\nsize = 3\n'
            "turn = 5",
            "elements that follow the tools need a deck with one sheet",
        ),
    ],
)
def test_a_sheet_beside_others_is_one_of_a_constant_size(mesh, message):
    with pytest.raises(DeckError, match=f"{message}(.*\n)*.*added.cover"):
        Problem.read(f"{DECK}[added.cover]\n{mesh}\n")


def test_sheets_of_a_deck_have_laws_of_their_own():
    problem = Problem.read(DECK)
    prepared = problem.build()
    model = prepared.model
    assert [body.name for body in model.bodies] == ["base", "cover"]
    assert [type(body.material).__name__ for body in model.bodies] == ["SVK", "Metal"]
    assert [len(body.cells) for body in model.bodies] == [5, 6]
    assert model.bodies[1].rolling is not None
    result = prepared.solve(progress=False)
    assert result["stack_active"][-1] > 0
    assert result["stack_fz"][-1] < 0.0


def test_a_deck_of_one_law_has_one_body():
    text = DECK.replace('material = { library = "AA6016-T4", rolling = "x" }', "")
    model = Problem.read(text).build().model
    assert len(model.bodies) == 1
    assert np.ptp(model.mesh.points[model.mesh.nodes("cover"), 2]) == pytest.approx(0.5)


def test_bonded_sheets_share_nodes_and_keep_their_laws():
    text = DECK.replace("cells = [6, 1]", "cells = [5, 1]").replace(
        "[mesh]\n", '[mesh]\nbonds = [["upper of base", "lower of cover"]]\n'
    )
    contact = '[sheet_contacts.stack]\nfaces = "upper of base"\nothers = "lower of cover"\n'
    prepared = Problem.read(text.replace(contact, "")).build()
    assert len(prepared.model.mesh.points) == 3 * 6 * 2
    assert [len(body.cells) for body in prepared.model.bodies] == [5, 5]
    assert prepared.solve(progress=False)["end_force"][-1] < 0.0
    with pytest.raises(DeckError, match=r"upper of base"):
        Problem.read(text).build()


def test_numbers_of_the_sheets_have_paths():
    problem = Problem.read(DECK)
    paths = {one.path for one in problem.paths()}
    assert {"mesh.sheets.cover.mesh.thickness", "mesh.sheets.cover.shift.2"} <= paths
    thicker = problem.with_({"mesh.sheets.cover.mesh.thickness": 0.6, "mesh.sheets.cover.shift.2": 0.8})
    assert np.ptp(thicker.build().model.mesh.nodes("cover")) > 0


def test_coarser_variants_are_those_of_all_sheets_and_of_their_contact():
    deck = Problem.read(DECK)
    built = deck.build()
    result = built.solve(progress=False)
    (pair,) = built.model.system.sheet_contacts
    found = coarser(deck, built)
    coarse = {"mesh.sheets.base.mesh.cells": [3, 1], "mesh.sheets.cover.mesh.cells": [3, 1]}
    assert found.pop(MESH) == coarse
    assert {name: {key: one for key, one in change.items() if key not in coarse} for name, change in found.items()} == {
        "step*2": {"steps.0.increments": 1},
        "t-pts-2": {"element.thickness_points": 10, "element.thickness_rule": "staggered"},
        "c-pts-1": {"sheet_contacts.stack.points": 3},
        "depth*2": {"sheet_contacts.stack.penalty": 0.5 * pair.penalty},
    }
    taken = Taken.of(deck, built, result, complete=True)
    (force,) = error_budget(deck, built, result, taken, processes=1, progress=False).quantities
    assert force.name == "end_force.step 1" and all(force.band.parts.values()) and not force.of_mesh


def test_bonded_sheets_have_a_coarser_mesh_if_their_nodes_still_meet():
    bonded = DECK.replace("[mesh]\n", '[mesh]\nbonds = [["upper of base", "lower of cover"]]\n')
    contact = '[sheet_contacts.stack]\nfaces = "upper of base"\nothers = "lower of cover"\n'
    bonded = bonded.replace(contact, "")
    own = "length = 10.0, width = 2.0, thickness = 0.5, cells = [6, 1]"
    for length, cells, there in ((10.0, 5, True), (6.0, 3, False)):
        text = bonded.replace(own, f"length = {length}, width = 2.0, thickness = 0.5, cells = [{cells}, 1]")
        deck = Problem.read(text)
        assert (MESH in coarser(deck, deck.build())) is there


@pytest.mark.parametrize(
    ("old", "new", "match"),
    [
        ('generator = "strip", length = 10.0, width = 2.0, thickness = 0.5', 'generator = "stripe"', "generator"),
        ("shift = [0.0, 0.0, 0.75]", "shif = [0.0, 0.0, 0.75]", "did you mean shift"),
        ('library = "AA6016-T4", rolling = "x"', 'library = "AA6016-T4"', "rolling"),
        ('nodes = "x0 of cover"', 'nodes = "x0"', "x0"),
        ("[mesh]\n", '[mesh]\nbonds = [["upper of base", "lower of cover"]]\n', "bonded faces have the same nodes"),
        ("[mesh]\n", '[mesh]\nbonds = [["upper of base", "lower of lid"]]\n', "lower of lid"),
    ],
)
def test_a_mistake_in_a_sheet_has_its_place(old, new, match):
    with pytest.raises(DeckError, match=match):
        Problem.read(DECK.replace(old, new)).build()

"""Tools of a deck that forces hold: pressed, sprung, turned by moments, stopped, closed and opened."""

from __future__ import annotations

import numpy as np
import pytest

from umform.errors import UmformError
from umform.problem import Problem
from umform.problem.check import check
from umform.problem.findings import Level

DRAWN = """
[mesh]
generator = "strip"
length = 20.0
width = 2.0
thickness = 0.8
cells = [10, 1]

[element]
name = "ANS3DEAS"

[material]
law = "J2"
E = 206e3
nu = 0.3
hardening = { curve = "Linear", yield_stress = 200.0, modulus = 500.0 }

[tools.bed]
shape = "Plane"
translation = [0.0, 0.0, -0.4]

[tools.lid]
shape = "Plane"
normal = [0.0, 0.0, -1.0]
translation = [0.0, 0.0, 1.4]

[contacts.die]
tool = "bed"
faces = "lower"
penalty = 2e3

[contacts.holder]
tool = "lid"
faces = "upper"
penalty = 2e3

[[supports]]
kind = "rigid"
name = "gauge"

[[supports]]
kind = "fix"
nodes = "y0"
directions = "y"

[[supports]]
kind = "symmetry"
nodes = "x0"
normal = "x"

[controls.hold]
kind = "press"
contact = "holder"
direction = "z"
stops = [{ at = -5.0, stiffness = 1e4, below = true }]

[controls.push]
kind = "force"
nodes = "x1"
force = [1.0, 0.0, 0.0]

[[steps]]
kind = "close"
control = "hold"
force = -80.0

[[steps]]
kind = "move"
to = { push = 2.0 }
increments = 2
follow = { hold = [[0.0, -80.0], [2.0, -100.0]] }

[[steps]]
kind = "free"
contacts = ["die", "holder"]
on = "gauge"
increments = 3
"""


def built(text):
    """The problem of a deck."""
    return Problem.read(text).build()


def test_a_deck_closes_holds_and_opens_tools():
    problem = built(DRAWN)
    result = problem.solve()
    step = result["step"]
    closed = np.flatnonzero(step == 1)[-1]
    assert result["holder_fz"][closed] == pytest.approx(80.0, rel=1e-9)
    np.testing.assert_allclose(result["hold"][step == 2], [-90.0, -100.0])
    assert result["die_left"][-1] == 0.0
    assert result["holder_fz"][-1] == 0.0
    gauge = next(support for support in problem.model.supports if support.name == "gauge")
    reactions = result.frames[-1].points["reaction"].ravel()[gauge.held]
    assert len(gauge.held) == 1  # along z
    assert np.abs(reactions).max() < 1e-6


def test_a_rigid_support_may_take_the_place_of_one_of_the_same_nodes():
    clamp = '[[supports]]\nkind = "fix"\nnodes = "x1"\ndirections = "z"\nname = "clamp"\n\n[[supports]]\nkind = "rigid"'
    text = DRAWN.replace('[[supports]]\nkind = "rigid"', clamp).replace(
        'name = "gauge"', 'name = "gauge"\nnodes = "x1"\ninstead_of = ["clamp"]'
    )
    gauge = next(support for support in built(text).model.supports.all if support.name == "gauge")
    clamped = next(support for support in built(text).model.supports if support.name == "clamp")
    assert len(gauge.held) == 1
    assert set(gauge.held) < set(clamped.held)
    with pytest.raises(UmformError, match=r"that the deck names[\s\S]*clip[\s\S]*names of supports: clamp"):
        built(text.replace('["clamp"]', '["clip"]'))


def test_all_that_holds_a_tool_can_be_said_in_a_deck():
    controls = """
[controls.slide]
kind = "tool"
contact = "die"
direction = "x"
followers = ["holder"]

[controls.tilt]
kind = "turn"
contact = "die"
axis = "y"
about = [1.0, 0.0, 0.0]

[controls.pad]
kind = "spring"
contact = "holder"
direction = "y"
stiffness = 10.0
preload = 1.0

[controls.twist]
kind = "moment"
contact = "holder"
axis = "z"

[controls.push]
"""
    model = built(DRAWN.replace("[controls.push]\n", controls)).model
    die, holder = model.tools
    assert [way.name for way in holder.ways] == ["hold_way", "slide", "pad_way", "twist_way"]
    assert [way.name for way in die.ways] == ["slide", "tilt"]
    assert [press.stiffness for press in holder.presses] == [0.0, 10.0, 0.0]
    assert holder.presses[0].stops[0].at == -5.0


def test_a_deck_keeps_a_gap():
    """Rigid blocks between die and holder, and a rigid stop: no stiffness is given."""
    gap = DRAWN.replace('direction = "z"\nstops', 'direction = "z"\ngap = { to = "die", least = 0.798 }\nstops')
    result = built(gap).solve()
    drawn = result["step"] == 2
    np.testing.assert_allclose(result["hold_way"][drawn], -1.002, rtol=1e-12)
    np.testing.assert_allclose(result["holder_fz"][drawn] + result["hold_stop"][drawn], [90.0, 100.0], rtol=1e-9)
    assert result["hold_stop"][drawn].min() > 1.0
    stop = built(DRAWN.replace("at = -5.0, stiffness = 1e4", "at = -5.0")).model.tools[1].presses[0].stops[0]
    assert stop.rigid
    with pytest.raises(UmformError, match="there is no contact of this name"):
        built(gap.replace('to = "die"', 'to = "dye"'))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('control = "hold"\nforce = -80.0', 'control = "hold"\nforce = 0.0', "finite force"),
        ('control = "hold"\nforce = -80.0', 'control = "push"\nforce = -80.0', "pressed tool"),
        ('contacts = ["die", "holder"]\n', "", "frees a support, or contacts"),
        ('"die", "holder"]', '"die", "holde"]', "there is no contact of this name"),
        ('on = "gauge"', 'on = "gage"', "there is no support of this name"),
        ("hold = [[0.0", "hole = [[0.0", "there is no control of this name"),
        ("[2.0, -100.0]", "[0.0, -100.0]", "function or a table"),
        ("stiffness = 1e4", "stiffness = 0.0", "stiffness"),
    ],
)
def test_mistakes_are_named(old, new, message):
    assert old in DRAWN
    with pytest.raises(UmformError, match=message):
        built(DRAWN.replace(old, new))


def test_a_deck_that_holds_tools_is_checked():
    deck = Problem.read(DRAWN)
    findings = list(check(deck, deck.build()))
    assert not [finding for finding in findings if finding.level == "error"]
    assert "supports" in [finding.about for finding in findings]


def test_a_deck_lets_a_loose_sheet_rest_on_springs():
    """By itself, with a stiffness of its own, or not at all; a check says so."""
    hovering = DRAWN.replace("translation = [0.0, 0.0, -0.4]", "translation = [0.0, 0.0, -1.0]")
    deck = Problem.read(hovering)
    problem = deck.build()
    supports, effort = (
        next(one for one in check(deck, problem) if one.about == about) for about in ("supports", "effort")
    )
    assert {supports.level, effort.level} == {Level.OK}
    assert "rests on weak springs: translation z" in supports.text
    assert not problem.model.system.others
    result = problem.solve()
    assert result["rest_acts"][[0, -1]].tolist() == [1.0, 0.0]
    own = built(hovering + "\n[solution]\nrest = 1e-5\n").model
    assert own.system.others[0].each * len(own.mesh.points) == pytest.approx(1e-5)
    with pytest.raises(UmformError, match="rigid whole in 1 way"):
        built(hovering + '\n[solution]\nrest = "off"\n').solve()

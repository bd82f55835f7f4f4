"""Supports of a deck: in cylindrical axes, of directors, and freed by a step."""

from __future__ import annotations

import numpy as np
import pytest

from umform.errors import UmformError
from umform.problem import Problem
from umform.problem.check import check

PROPPED = """
[mesh]
generator = "strip"
length = 10.0
width = 1.0
thickness = 0.3
cells = [8, 1]

[element]
name = "ANS3DEAS"

[material]
law = "SVK"
E = 1e4
nu = 0.3

[[supports]]
kind = "fix"
nodes = "x0"

[[supports]]
kind = "fix"
nodes = "x1"
directions = "r"
axes = { origin = [0.0, 0.0, -20.0], axis = "y" }
name = "roller"

[[supports]]
kind = "director"
nodes = "x1"
directions = "y"

[controls.push]
kind = "traction"
faces = "upper"
traction = [0.0, 0.0, -0.01]

[[steps]]
kind = "move"
to = { push = 1.0 }
increments = 2

[[steps]]
kind = "free"
support = "roller"
increments = 3
"""


def test_a_deck_holds_in_cylindrical_axes_and_frees_a_support_by_name():
    problem = Problem.read(PROPPED).build()
    model = problem.model
    roller = model.supports[1]
    assert roller.name == "roller"
    assert len(model.supports.rows) == 2
    result = problem.solve(progress=False)
    np.testing.assert_allclose(result["roller"], [0, 0, 0, 2 / 3, 1 / 3, 0], atol=1e-12)
    assert roller.removed
    u = model.u.reshape(-1, 3)[model.mesh.nodes("x1")]
    assert np.abs(u[:, 2]).min() > 1e-3
    assert np.ptp(u[:, 1]) < 1e-2


def test_a_name_that_no_support_has_is_told_with_those_there_are():
    with pytest.raises(UmformError, match="no support of this name") as caught:
        Problem.read(PROPPED.replace('support = "roller"', 'support = "rollers"')).build()
    assert "roller" in str(caught.value)


def test_a_deck_with_a_step_that_frees_a_support_is_checked():
    deck = Problem.read(PROPPED)
    assert "supports" in [finding.about for finding in check(deck, deck.build())]

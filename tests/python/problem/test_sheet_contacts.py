"""Decks in which sheets touch each other: their friction is a parameter, and a stopped run goes on to the same bits."""

from __future__ import annotations

import meshio
import numpy as np
import pytest

import umform as uf
from umform.problem import Problem

DECK = """
[mesh]
file = "stack.vtu"

[material]
law = "J2"
E = 200e3
nu = 0.3
hardening = { curve = "Swift", strength = 500.0, offset = 0.01, exponent = 0.2 }

[sheet_contacts.stack]
faces = { intersection = ["upper", { max = [inf, inf, 0.51] }] }
others = { intersection = ["lower", { min = [-inf, -inf, 0.49] }] }
friction = 0.15

[[supports]]
kind = "fix"
nodes = { max = [0.0, inf, inf] }

[controls.below]
kind = "pressure"
faces = { intersection = ["lower", { max = [inf, inf, 0.0] }] }

[controls.above]
kind = "pressure"
faces = { intersection = ["upper", { min = [-inf, -inf, 1.0] }] }

[controls.end]
kind = "displacement"
nodes = { min = [20.0, -inf, 0.51] }
direction = "z"

[[steps]]
kind = "move"
to = { below = 2.0, above = 2.0 }
increments = 1

[[steps]]
kind = "move"
to = { end = -1.5 }
increments = 6
"""


@pytest.fixture
def problem(tmp_path):
    lower = uf.mesh.strip(20.0, 2.0, 1.0, (10, 1))
    upper = uf.mesh.strip(20.0, 2.0, 0.8, (13, 1)).moved((0.0, 0.0, 0.9))
    mesh = uf.mesh.together(a=lower, b=upper)
    meshio.write(tmp_path / "stack.vtu", meshio.Mesh(mesh.points, [("hexahedron", mesh.connectivity)]))
    return Problem.read(DECK, folder=tmp_path)


def test_friction_between_sheets_is_a_parameter(problem):
    path = "sheet_contacts.stack.friction"
    assert path in {one.path for one in problem.paths()}
    found = uf.derivatives(problem, [path], ["end_force:last"], progress=False)
    ends = [problem.with_({path: mu}).build().solve(progress=False)["end_force"][-1] for mu in (0.1501, 0.1499)]
    wanted = (ends[0] - ends[1]) / 2e-4
    assert wanted < -0.1
    assert found["end_force:last", path].value == pytest.approx(wanted, rel=1e-3)


def test_a_stopped_run_with_slip_goes_on_to_the_same_bits(problem, copies, tmp_path):
    whole = problem.build().solve(progress=False, checkpoint=tmp_path / "run.h5", every=0)
    again = problem.build().resume(copies[4], progress=False)
    assert whole["stack_slipping"][4:].min() > 10
    assert (again.columns(), again.warnings) == (whole.columns(), whole.warnings)
    for column in whole.columns():
        np.testing.assert_array_equal(again[column], whole[column], err_msg=column)
    np.testing.assert_array_equal(again.model.u, whole.model.u)

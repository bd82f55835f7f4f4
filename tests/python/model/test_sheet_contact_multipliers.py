"""Multipliers of sheets that touch: the allowed penetration is met with a penalty that stays."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf


def pressed(way=-0.02, second=(5, 2), augmented=True, **options):
    """Two plates between flat walls, and their contact."""
    lower = uf.mesh.strip(10.0, 4.0, 1.0, (5, 2))
    upper = uf.mesh.strip(10.0, 4.0, 1.0, second).moved((0.0, 0.0, 1.0))
    model = uf.Model(uf.mesh.together(a=lower, b=upper), material=uf.SVK(E=210e3, nu=0.0))
    contact = model.sheet_contact("upper of a", "lower of b", name="stack", augmented=augmented, **options)
    model.fix("lower of a", "z")
    for sheet in "ab":
        model.fix(f"x0 of {sheet}", "x")
        model.fix(f"y0 of {sheet}", "y")
    wall = model.prescribe("upper of b", "z", "wall")
    return model, contact, uf.Move(wall, way, steps=2)


@pytest.mark.parametrize("options", [{"points": 2}, {"cells": 3}, {"points": 3, "friction": 0.1}], ids=str)
def test_a_uniform_pressure_needs_no_penetration(options):
    model, contact, move = pressed(**options)
    result = uf.solve(model, move, progress=False)
    assert contact.penalty == contact.initial_penalty
    assert result["stack_penetration"][1:].max() <= contact.allowed
    assert not result["stack_multipliers_stay"].any()
    without = uf.solve(*pressed_softly(contact.penalty, **options), progress=False)
    assert without["stack_penetration"][-1] > 2.0 * contact.allowed
    sides = contact.found.sides
    pressures = np.concatenate([side.pressure for side in sides])
    assert np.abs(pressures / pressures.mean() - 1.0).max() < 1e-9
    assert result["wall_force"][-1] == pytest.approx(-40.0 * pressures.mean(), rel=1e-3)


def pressed_softly(penalty, **options):
    model, _, move = pressed(penalty=penalty, augmented=False, **options)
    return model, move


def test_meshes_that_do_not_match_keep_the_allowed_penetration_too():
    model, contact, move = pressed(second=(8, 3), cells=3)
    result = uf.solve(model, move, progress=False)
    assert 0.0 < result["stack_penetration"][1:].max() <= contact.allowed
    pressures = np.concatenate([side.pressure for side in contact.found.sides])
    assert np.abs(pressures / pressures.mean() - 1.0).max() < 0.05


def test_faces_that_part_lose_their_multipliers():
    model, contact, move = pressed()
    result = uf.solve(model, [move, uf.Move(move.control, 0.01, steps=2)], progress=False)
    assert result["stack_active"][2] > 0 and result["stack_active"][-1] == 0
    assert abs(result["wall_force"][-1]) < 1e-6
    assert not np.concatenate([one.multipliers for one in contact.passes]).any()


def test_multipliers_are_part_of_a_snapshot():
    model, contact, move = pressed()
    uf.solve(model, move, progress=False)
    snapshot, forces = model.system.snapshot(), model.evaluate(model.u).residual
    again, other, _ = pressed()
    again.system.restore(snapshot)
    for one, two in zip(contact.passes, other.passes, strict=True):
        assert one.multipliers.min() > 0.0
        np.testing.assert_array_equal(one.multipliers, two.multipliers)
    np.testing.assert_array_equal(again.evaluate(model.u).residual, forces)


def test_an_arc_refuses_them():
    model, *_ = pressed()
    load = model.pressure("upper of b", "load")
    with pytest.raises(uf.errors.InvalidValue, match="multipliers of contact") as caught:
        uf.solve(model, uf.Arc(load, 1.0), progress=False)
    assert caught.value.value == "contact stack"

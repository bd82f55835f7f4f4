"""A sheet laid beside a bent part: the part keeps its state, and both meet in contact."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.errors import InvalidValue
from umform.model.transfer.beside import laid_beside
from umform.problem import Problem

STEEL = uf.J2(E=210e3, nu=0.3, hardening=uf.Swift(strength=520.0, offset=0.004, exponent=0.2))
STRIP = uf.mesh.strip(10.0, 1.0, 0.5, (10, 1))


@pytest.fixture(scope="module")
def bent():
    model = uf.Model(STRIP, material=STEEL)
    model.fix("x0")
    end = model.prescribe("x1", "z", "end")
    uf.solve(model, uf.Move(end, 2.0, steps=5), progress=False)
    return model


def test_the_part_keeps_its_state_and_the_other_sheet_is_undeformed(bent):
    model = laid_beside(bent, cover=STRIP.moved((0.0, 0.0, 3.0)))
    part, cover = model.bodies
    before = bent.bodies[0].state()
    for name, values in part.state().items():
        np.testing.assert_array_equal(values, before[name])
    assert before["history"].shape == cover.state()["history"].shape
    np.testing.assert_array_equal(model.u[: bent.u.size], bent.u)
    assert not model.u[bent.u.size :].any()
    here, there = bent.evaluate(bent.u).residual, model.evaluate(model.u).residual
    np.testing.assert_allclose(there[: here.size], here, atol=1e-9 * np.abs(here).max())
    assert np.abs(there[here.size :]).max() < 1e-9 * np.abs(here).max()


def test_parts_of_several_bodies_are_refused(bent):
    with pytest.raises(InvalidValue, match="one body"):
        laid_beside(bent, part=STRIP)
    halves = [uf.Body(material=STEEL, cells=half, name=name) for name, half in (("a", range(5)), ("b", range(5, 10)))]
    with pytest.raises(InvalidValue, match="one body"):
        laid_beside(uf.Model(STRIP, bodies=halves), cover=STRIP)


def test_a_deck_lays_a_sheet_on_the_part():
    flat = {"generator": "strip", "length": 10.0, "width": 1.0, "thickness": 0.5, "cells": (10, 1)}
    on = {"faces": "upper of part", "others": "lower of cover", "cells": 3}
    tables = {
        "mesh": flat,
        "material": {"law": "SVK", "E": 210e3, "nu": 0.3},
        "added": {"cover": flat | {"shift": (0.0, 0.0, 0.5)}},
        "sheet_contacts": {"joint": on},
        "supports": [{"kind": "fix", "nodes": f"x0 of {name}"} for name in ("part", "cover")],
        "controls": {"tip": {"kind": "displacement", "nodes": "x1 of cover", "direction": "z"}},
        "steps": [{"kind": "move", "to": {"tip": -0.2}, "increments": 2}],
    }
    result = Problem.of(tables).build().solve(progress=False, solver="auto")
    assert result["joint_active"][-1] > 0 and result["joint_fz"][-1] < 0.0

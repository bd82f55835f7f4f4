"""Derivatives of several operations: what they are taken of, files, scatter, refusals."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import umform as uf
from umform.errors import InvalidValue
from umform.processes.bend_sequence import Bend, bend_sequence
from umform.processes.hemming import hemming
from umform.processes.problems import outcome_of, quantities_named
from umform_book.derivatives.chains import HEM, PART, SHEET


@cache
def part():
    by = ["bends.0.stroke", "bends.1.stroke", "sheet.thickness", "strength", "bends.1.position"]
    return uf.derivatives(PART, by, progress=False)


def test_the_outcome_of_the_runs_is_that_of_the_process():
    done = bend_sequence(PART, progress=False, frames=1)
    for one, other in zip(done.quantities, outcome_of(PART, *done.stages.values()).quantities, strict=True):
        assert (one.name, one.value) == (other.name, other.value)
    assert list(done.values) == quantities_named(PART)
    made = hemming(HEM, progress=False, frames=1)
    for one, other in zip(made.quantities, outcome_of(HEM, *made.stages.values()).quantities, strict=True):
        assert (one.name, one.value) == (other.name, other.value)


def test_a_bend_line_moves_its_flanges():
    found = part()
    for name, change in {"flange 1": 0.0, "flange 2": 1.0, "flange 3": -1.0, "bend 1: angle": 0.0}.items():
        assert found[name, "bends.1.position"].value == pytest.approx(change, abs=1e-6)
    assert abs(found["bend 1: angle", "bends.1.stroke"].value) < 1e-6  # it comes later
    assert found["bend 2: angle", "bends.1.stroke"].value < -5.0


def test_angles_that_are_held():
    """Strokes follow, each of its own bend."""
    held = part().holding({"bend 1: angle": "bends.0.stroke", "bend 2: angle": "bends.1.stroke"})
    assert held["bend 2: angle", "sheet.material.hardening.strength"].value == 0.0
    assert held["bends.1.stroke", "sheet.material.hardening.strength"].value > 0.0
    assert held._main == "bend 1: springback"


def test_files_of_each_operation(tmp_path):
    names = [path.name for path in part().write(tmp_path)]
    assert names[1:3] == ["derivatives-history-bend-1.csv", "derivatives-history-bend-2.csv"]
    column = part().column("stroke_force", "bends.0.stroke", "bend-1")
    assert len(column) == len(part().stages["bend-1"].run) and np.isfinite(column).all()


def test_a_goal_is_no_stroke():
    angles = replace(PART, bends=(Bend(20.0, angle=100.0), *PART.bends[1:]))
    with pytest.raises(InvalidValue, match="the way of the punch is missing") as caught:
        uf.derivatives(angles, ["strength"])
    assert caught.value.where == "bends.0.stroke"


def test_a_stroke_that_changes_the_steps_of_a_later_bend_is_varied_downwards():
    way = 5 * SHEET.way
    edge = replace(PART, bends=(PART.bends[0], replace(PART.bends[1], stroke=2.0 * way)))
    found = uf.derivatives(edge, ["bends.1.stroke"], ["bend 2: angle"], progress=False)
    assert found.sizes["bends.1.stroke"] < 0.0


def test_scatter_of_a_part():
    found = uf.scatter(
        PART, {"strength": "4%", "bends.0.stroke": 0.01}, ["bend 1: angle", "bend 2: angle"], progress=False
    )
    assert found["bend 1: angle"].largest == "bends.0.stroke"
    assert found["bend 2: angle"].largest == "sheet.material.hardening.strength"
    assert found["bend 1: angle"].deviation.value == pytest.approx(0.01 * 14.0, rel=0.3)
    assert not found.failures

"""Bottoming: where the flanks meet, force and angle, refusals, the deck of the bend."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from umform.errors import InvalidValue
from umform.problem import Problem
from umform.processes.air_bending import AirBending, air_bending
from umform.processes.air_bending.bottoming import press_to_force, with_travel
from umform.processes.air_bending.problem import problem_of

COARSE = AirBending(
    die_angle=88.0, punch_angle=88.0, elements_per_thickness=2.0, layers=1, increment=0.0125, bottoming=True
)


@pytest.fixture(scope="module")
def pressed():
    return press_to_force(COARSE, 400.0, progress=False, frames=5)


def test_nothing_is_left_of_the_force_after_unloading(pressed):
    """Two thousandths of it, as of a bend in the air, are a part of the force that bends the legs."""
    force = pressed.bend.result["stroke_force"]
    assert abs(force[-1]) <= 2e-5 * abs(force).max()


@pytest.mark.parametrize(("die", "punch", "radius"), [(88.0, 88.0, 1.5), (90.0, 85.0, 0.5), (80.0, 60.0, 3.0)])
def test_at_the_bottom_tip_and_flanks_are_a_thickness_apart(die, punch, radius):
    """The point of the round tip that faces the flank is one thickness from the exact surface of the die, (5.90)."""
    case = AirBending(die_angle=die, punch_angle=punch, punch_radius=radius, opening=24.0, bottoming=True)
    axis = case.thickness + radius - case.bottom_stroke
    flank = math.radians(90.0 - 0.5 * die)
    facing = [radius * math.sin(flank), 0.0, axis - radius * math.cos(flank)]
    assert case.die.gap([facing])[0][0] == pytest.approx(case.thickness, rel=1e-12)


def test_the_force_is_the_one_asked_for(pressed):
    m = pressed.measures
    assert m.force == pytest.approx(400.0, rel=0.005)
    assert m.largest_force == m.force
    assert pressed.bend.against == "die"
    assert pressed.bend["stroke"].band is None  # found, not given
    assert not any("air bending" in text or "bottoms" in text for text in pressed.bend.warnings)


def test_a_punch_that_is_meant_to_bottom_is_not_warned_of(caplog):
    air_bending(with_travel(COARSE, 0.1), progress=False, frames=1)
    assert "bottoms" not in caplog.text


def test_the_flanks_take_the_springback_away(pressed):
    """In the air, just before the flanks, a sheet springs back by more than a degree; pressed, it follows the die."""
    air = air_bending(replace(COARSE, bottoming=False, stroke=6.0), progress=False, frames=1).measures
    m = pressed.measures
    assert air.springback > 1.0
    assert abs(m.springback) < air.springback
    assert abs(m.angle - COARSE.die_angle) < 3.0
    assert m.force > 3.0 * air.largest_force


def test_more_force_brings_the_angle_to_that_of_the_die():
    hard = air_bending(with_travel(COARSE, 0.0), progress=False, frames=1).measures
    assert hard.force > 500.0
    assert abs(hard.springback) < 0.5
    assert abs(hard.angle - COARSE.die_angle) < 1.0


def test_the_deck_is_the_bend(pressed):
    deck = Problem.read(problem_of(pressed.case).toml()).build().solve(progress=False)
    np.testing.assert_array_equal(deck["stroke_force"], pressed.bend.result["stroke_force"])


def test_a_stroke_short_of_the_flanks_is_told():
    bend = air_bending(with_travel(COARSE, -3.0), progress=False, frames=1)
    assert any("no bottoming yet" in text for text in bend.warnings)


def test_what_does_not_bottom_is_refused():
    with pytest.raises(InvalidValue, match="sharper die") as refused:
        AirBending(die_angle=85.0, punch_angle=88.0, bottoming=True)
    assert refused.value.where == "punch_angle"
    with pytest.raises(InvalidValue, match="half of its thickness"):
        with_travel(COARSE, 1.5)
    with pytest.raises(InvalidValue, match="are for air bending"):
        press_to_force(replace(COARSE, bottoming=False), 400.0, progress=False)
    with pytest.raises(InvalidValue, match="must be a number of more than 0"):
        press_to_force(COARSE, -400.0, progress=False)
    with pytest.raises(InvalidValue, match="that of air bending") as low:
        press_to_force(COARSE, 60.0, progress=False, frames=1)
    assert low.value.where == "force_per_metre"
    with pytest.raises(InvalidValue, match="half of its thickness"):
        press_to_force(COARSE, 1e6, progress=False, frames=1)

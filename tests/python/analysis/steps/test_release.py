"""A release finds lift-off whatever the tolerances of Newton's method are."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest

from umform import NewtonOptions
from umform import materials as mt
from umform.analysis.run import solve
from umform.analysis.steps import Arc, Close, Free, Move, Pace, Release, release
from umform.errors import InvalidValue
from umform.mesh import strip
from umform.model import Model
from umform.surfaces import Cylinder

LOOSE = NewtonOptions(residual=1e-4, increment=1e-2)
STEEL = mt.J2(kappa=175e3, mu=80.77e3, hardening=mt.Linear(160.0, 500.0))


def bent_and_released(cells, half, penalty, options):
    """A strip bent over a narrow cylinder; half of it is all that the plane y = 0 leaves."""
    model = Model(strip(60.0, 10.0, 2.0, (cells, 1)), "BEND8", material=STEEL)
    model.symmetry("x0", normal="x")
    if half:
        model.symmetry("y0", normal="y")
    else:
        model.symmetry(lambda x, y, z: (x < 1e-9) & (y < 1e-9) & (z < 0), normal="y")
    punch = model.prescribe("x0_lower", "z", "punch")
    model.contact("lower", Cylinder((40.0, 0, -11.0), "y", 10.0), penalty=penalty, points=5, name="tool")
    return solve(model, [Move(punch, -15.0, steps=20), Release(punch)], options=options, frames=0)


def springback(result):
    return result["punch"][-1] - result["punch"].min()


@pytest.mark.parametrize(
    ("cells", "half", "penalty"),
    [(8, False, 100.0), (8, True, 1e4), (10, True, 100.0), (16, True, 100.0), (20, True, 100.0), (24, True, 100.0)],
)
def test_springback_with_loose_tolerances_is_that_with_tight_ones(cells, half, penalty):
    """A residual that leaves more force than counts as zero hid lift-off, or a force of the wrong sign closed it in."""
    loose, tight = (bent_and_released(cells, half, penalty, options) for options in (LOOSE, NewtonOptions()))
    assert springback(loose) == pytest.approx(springback(tight), abs=3e-4)
    assert abs(loose["punch_force"][-1]) <= 1e-6 * np.abs(loose["punch_force"]).max()


def test_a_force_that_the_residual_may_hide_is_no_reason_to_go_on_after_lift_off(monkeypatch):
    """Lift-off in one increment, with a force just above what counts as zero that the residual has left."""
    monkeypatch.setattr(release, "_PART", np.inf)
    loose = bent_and_released(8, False, 100.0, LOOSE)
    assert springback(loose) == pytest.approx(0.8236, abs=1e-3)


def test_only_the_release_is_solved_more_tightly():
    result = bent_and_released(8, True, 100.0, LOOSE)
    step, iterations = np.array(result["step"])[1:], result.iterations[-(len(result) - 1) :]
    last = np.array([records[-1].residual for records in iterations])
    assert last[step == 1].max() > 1e-6
    assert last[step == 2].max() < 1e-7


def test_an_increment_that_went_too_far_is_not_tried_again_for_a_rounding_error():
    """From 2.0201... back by 0.04, where contact has lifted off: the way to that bound is 0.04 and one ulp."""
    value, size = 2.0201269080136908, -0.04
    bound = value + size
    assert abs(size) < abs(bound - value)
    again = release._next_release(value, force=-715.0, before=None, bound=bound, size=size, resolution=2e-6)
    assert again == pytest.approx(value + 0.5 * size)


def test_a_number_of_steps_bounds_the_increments():
    strip_ = strip(20.0, 2.0, 1.0, (10, 1))
    ends = []
    for words in ({}, {"steps": 40}, {"increment": 0.01}):
        model = Model(strip_, material=STEEL)
        model.fix("x0")
        tip = model.prescribe("x1_lower", "z", "tip")
        result = solve(model, [Move(tip, -2.0, steps=6), Release(tip, **words)], progress=False)
        back = np.abs(np.diff(result["tip"][7:]))
        ends.append(result["tip"][-1])
        if "steps" in words:
            assert back.max() == pytest.approx(0.05)
            assert len(back) < 8
    assert np.ptp(ends) < 1e-5
    with pytest.raises(InvalidValue, match="not both"):
        Release(tip, increment=0.1, steps=4)


@pytest.mark.parametrize("step", [Move, Release, Close, Free, Arc, Pace])
def test_steps_say_their_words(step):
    with pytest.raises(InvalidValue, match=f"{step.__name__} has no parameter duration") as refused:
        step(duration=3.0)
    words = refused.value.remedy.removeprefix("its parameters are ").split(", ")
    assert words == [field.name for field in fields(step)]

"""What earlier increments teach the next one."""

from __future__ import annotations

from umform.solution.habits import Habits


def increment(habits, fails):
    """Whether the extrapolation was tried, and failed, in an increment that the tangent can make."""
    tried = habits.extrapolates
    failed = ["extrapolation"] if tried and fails else []
    habits.learn(failed=failed, won="extrapolation" if tried and not fails else "tangent", negative_pivots=0)
    return tried


def test_an_extrapolation_that_goes_too_far_rests_longer_each_time():
    habits = Habits()
    tried = [increment(habits, fails=True) for _ in range(60)]
    gaps = [k for k, one in enumerate(tried) if one]
    assert gaps == [0, 2, 6, 14, 30, 46]


def test_one_that_holds_again_is_trusted_again():
    habits = Habits()
    tried = [increment(habits, fails=number < 3) for number in range(12)]
    assert tried == [True, False, True, False, False, False, True, True, True, True, True, True]
    assert habits.misses == 0


def test_negative_pivots_at_an_equilibrium_are_remembered():
    habits = Habits()
    for pivots, stable in ((0, True), (2, False), (None, True)):
        habits.learn(failed=[], won="tangent", negative_pivots=pivots)
        assert habits.stable == stable

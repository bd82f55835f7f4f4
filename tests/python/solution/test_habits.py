"""What earlier increments teach the next one."""

from __future__ import annotations

from umform.solution.habits import Habits
from umform.solution.records import Cause

SOFT = "softer penalties"


def increment(habits, fails):
    """Whether the extrapolation was tried, and failed, in an increment that the tangent can make."""
    tried = habits.extrapolates
    failed = {"extrapolation": Cause.STALL} if tried and fails else {}
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
        habits.learn(failed={}, won="tangent", negative_pivots=pivots)
        assert habits.stable == stable


def cut(habits, cause=Cause.STALL):
    """Whether softer penalties were tried, in vain, in an increment that all strategies failed in."""
    tried = habits.softens
    habits.learn_of_cut({"tangent": Cause.INDEFINITE} | ({SOFT: cause} if tried else {}))
    return tried


def test_softer_penalties_that_lead_nowhere_rest_for_some_cuts():
    habits = Habits()
    assert [cut(habits) for _ in range(11)] == [True, False] + 2 * [True, False, False, False] + [True]
    assert habits.extrapolates  # nothing is learnt of the extrapolation
    assert habits.stable


def test_softer_penalties_that_won_are_trusted_again():
    habits = Habits()
    tried = [cut(habits) for _ in range(3)]
    habits.learn(failed={"tangent": Cause.STALL}, won=SOFT, negative_pivots=0)
    assert habits.soft_misses == 0
    tried += [cut(habits) for _ in range(5)]
    assert tried == [True, False, True, False, False, False, True, False]


def test_contact_that_is_lost_does_not_make_softer_penalties_rest():
    habits = Habits()
    assert all(cut(habits, Cause.SINGULAR) for _ in range(4))


def test_an_increment_that_will_not_be_cut_has_softer_penalties():
    habits = Habits()
    cut(habits)
    assert not habits.softens
    habits.last_chance()
    assert habits.softens
    assert habits.soft_misses == 1


def test_only_the_last_attempt_may_jump():
    habits = Habits()
    assert not habits.last
    habits.last_chance()
    assert habits.last
    habits.learn(failed={}, won="tangent", negative_pivots=0)
    assert not habits.last


def test_an_increment_may_exceed_the_allowed_penetration_after_three_failures_more_than_were_kept():
    habits = Habits()
    yields = []
    for kept in (False, False, True, False, False, False, True, False, True, True, True, True, False, False, False):
        habits.count(kept=kept)
        yields.append(habits.yields)
    assert yields == [False, False, False, False, True, True, False, True, *[False] * 6, True]

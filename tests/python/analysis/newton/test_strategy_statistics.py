"""What earlier increments teach the next one."""

from __future__ import annotations

from umform.analysis.newton.strategy_statistics import StrategyStatistics
from umform.results.records import Cause

SOFT = "softer penalties"


def increment(statistics, fails):
    """Whether the extrapolation was tried, and failed, in an increment that the tangent can make."""
    tried = statistics.extrapolates
    failed = {"extrapolation": Cause.STALL} if tried and fails else {}
    statistics.record(failed=failed, won="extrapolation" if tried and not fails else "tangent", negative_pivots=0)
    return tried


def test_an_extrapolation_that_goes_too_far_rests_longer_each_time():
    statistics = StrategyStatistics()
    tried = [increment(statistics, fails=True) for _ in range(60)]
    gaps = [k for k, one in enumerate(tried) if one]
    assert gaps == [0, 2, 6, 14, 30, 46]


def test_one_that_holds_again_is_trusted_again():
    statistics = StrategyStatistics()
    tried = [increment(statistics, fails=number < 3) for number in range(12)]
    assert tried == [True, False, True, False, False, False, True, True, True, True, True, True]
    assert statistics.misses == 0


def test_negative_pivots_at_an_equilibrium_are_remembered():
    statistics = StrategyStatistics()
    for pivots, stable in ((0, True), (2, False), (None, True)):
        statistics.record(failed={}, won="tangent", negative_pivots=pivots)
        assert statistics.stable == stable


def cut(statistics, cause=Cause.STALL):
    """Whether softer penalties were tried, in vain, in an increment that all strategies failed in."""
    tried = statistics.softens
    statistics.record_cut({"tangent": Cause.INDEFINITE} | ({SOFT: cause} if tried else {}))
    return tried


def test_softer_penalties_that_lead_nowhere_rest_for_some_cuts():
    statistics = StrategyStatistics()
    assert [cut(statistics) for _ in range(11)] == [True, False] + 2 * [True, False, False, False] + [True]
    assert statistics.extrapolates  # nothing is learnt of the extrapolation
    assert statistics.stable


def test_softer_penalties_that_won_are_trusted_again():
    statistics = StrategyStatistics()
    tried = [cut(statistics) for _ in range(3)]
    statistics.record(failed={"tangent": Cause.STALL}, won=SOFT, negative_pivots=0)
    assert statistics.soft_misses == 0
    tried += [cut(statistics) for _ in range(5)]
    assert tried == [True, False, True, False, False, False, True, False]


def test_contact_that_is_lost_does_not_make_softer_penalties_rest():
    statistics = StrategyStatistics()
    assert all(cut(statistics, Cause.SINGULAR) for _ in range(4))


def test_an_increment_that_will_not_be_cut_has_softer_penalties():
    statistics = StrategyStatistics()
    cut(statistics)
    assert not statistics.softens
    statistics.begin_last_attempt()
    assert statistics.softens
    assert statistics.soft_misses == 1


def test_only_the_last_attempt_may_jump():
    statistics = StrategyStatistics()
    assert not statistics.last
    statistics.begin_last_attempt()
    assert statistics.last
    statistics.record(failed={}, won="tangent", negative_pivots=0)
    assert not statistics.last


def test_an_increment_may_exceed_the_allowed_penetration_after_three_failures_more_than_were_kept():
    statistics = StrategyStatistics()
    yields = []
    for kept in (False, False, True, False, False, False, True, False, True, True, True, True, False, False, False):
        statistics.count_penetration(kept=kept)
        yields.append(statistics.yields)
    assert yields == [False, False, False, False, True, True, False, True, *[False] * 6, True]

"""Verdicts follow from the numbers, and from nothing else."""

from __future__ import annotations

import pytest

from umform_book.checks import Check, Verdict


@pytest.mark.parametrize(
    ("found", "options", "verdict"),
    [
        (1.01, {}, Verdict.GREEN),
        (0.97, {}, Verdict.RED),
        (0.97, {"known": 0.05, "cause": "the sun"}, Verdict.AMBER),
        (1.01, {"known": 0.05, "cause": "the sun"}, Verdict.GREEN),
        (0.90, {"known": 0.05, "cause": "the sun"}, Verdict.RED),
        (float("nan"), {"known": 0.05, "cause": "the sun"}, Verdict.RED),
        (float("inf"), {}, Verdict.RED),
    ],
)
def test_verdict(found, options, verdict):
    assert Check("load", found, 1.0, 0.02, **options).verdict is verdict


def test_a_negative_reference():
    check = Check("load", -1.01, -1.0, 0.02)
    assert check.deviation == pytest.approx(-0.01)
    assert check.verdict is Verdict.GREEN


def test_an_absolute_error():
    check = Check("error", 2e-11, 0.0, 1e-10, relative=False)
    assert check.verdict is Verdict.GREEN
    assert check.cells()[3] == "+2.00e-11"


def test_nothing_is_relative_to_zero():
    with pytest.raises(ValueError, match="relative=False"):
        Check("error", 1.0, 0.0, 0.1)


@pytest.mark.parametrize("options", [{"known": 0.1}, {"cause": "the sun"}])
def test_a_known_deviation_has_a_cause(options):
    with pytest.raises(ValueError, match="cause"):
        Check("load", 1.0, 1.0, 0.1, **options)


def test_the_cause_stands_in_the_table_only_where_it_is_needed():
    known = {"known": 0.5, "cause": "the sun"}
    assert "the sun" in Check("load", 1.2, 1.0, 0.1, **known).cells()[-1]
    assert "the sun" not in Check("load", 1.0, 1.0, 0.1, **known).cells()[-1]

"""Verdicts follow from the numbers, and from nothing else."""

from __future__ import annotations

import pytest

from umform_book.checks import Check, Verdict
from umform_book.printed import about, bounded, shown


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
    assert check.cells()[2:5] == ("below 1e-10", "-", "1e-10")


def test_nothing_is_relative_to_zero():
    with pytest.raises(ValueError, match="relative=False"):
        Check("error", 1.0, 0.0, 0.1)


@pytest.mark.parametrize("options", [{"known": 0.1}, {"cause": "the sun"}])
def test_a_known_deviation_has_a_cause(options):
    with pytest.raises(ValueError, match="cause"):
        Check("load", 1.0, 1.0, 0.1, **options)


def test_the_cause_is_noted_only_where_it_is_needed():
    known = {"known": 0.5, "cause": "the sun"}
    assert Check("load", 1.2, 1.0, 0.1, **known).note == "the sun"
    assert Check("load", 1.0, 1.0, 0.1, **known).note == ""


@pytest.mark.parametrize(
    ("found", "verdict"),
    [(0.8, Verdict.EXPECTED), (0.99, Verdict.AMBER), (0.4, Verdict.RED), (float("nan"), Verdict.RED)],
)
def test_an_expected_failure_has_a_size_and_a_pass_is_shown(found, verdict):
    check = Check("locking", found, 1.0, 0.02, known=0.5, cause="it locks", theory="MacNeal 1987")
    assert check.verdict is verdict
    assert ("passes, but theory predicts" in check.note) == (found == 0.99)
    assert ("it locks (MacNeal 1987)" in check.note) == (verdict is not Verdict.RED)


def test_an_expected_failure_has_a_cause():
    with pytest.raises(ValueError, match="expected failure"):
        Check("locking", 0.8, 1.0, 0.02, theory="MacNeal 1987")


@pytest.mark.parametrize(
    ("value", "limit", "text"),
    [
        (7.4e-15, 1e-12, "below 1e-12"),
        (7.2e-15, 1e-12, "below 1e-12"),
        (0.0, 1e-10, "below 1e-10"),
        (-3e-11, 1e-10, "below 1e-10"),
        (6.45e-10, 1e-9, "below 1e-9"),
        (2.4e-10, 1e-6, "below 1e-6"),
        (7.4e-15, 1e-2, "below 1e-12"),
        (2.7e-13, 1e-2, "below 1e-12"),
        (2e-11, 1e-2, ""),  # not far enough below to be round-off
        (3e-5, 1e-2, ""),
        (2e-10, 1e-10, ""),  # a miss is printed
        (0.0, 0.0, ""),  # a count
        (0.0, 1.0, ""),
        (float("nan"), 1e-10, ""),
    ],
)
def test_round_off_is_printed_as_a_bound(value, limit, text):
    assert bounded(value, limit) == text


def test_numbers_of_tables():
    assert [shown(value) for value in (0.0, 1e-15, -1e-15, 5e-11, 1.23456e-9, 0.123456, float("nan"))] == [
        "0",
        "below 1e-10",
        "below 1e-10",
        "below 1e-10",
        "1.235e-09",
        "0.1235",
        "-",
    ]
    assert [about(count) for count in (7, 99, 903, 1248, 0)] == [7, 99, 900, 1200, 0]

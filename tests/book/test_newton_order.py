"""The order of Newton's method from the records of its iterations, and the reason where it is low."""

from __future__ import annotations

from dataclasses import replace

import pytest

from umform.results.records import Iteration
from umform_book.newton_order import (
    CONTACT,
    FEW,
    FLOW,
    OPEN,
    REASONS,
    SEARCH,
    TURNS,
    measurable,
    measure,
    newton_order,
    reason,
)

SLOW = [0.1, 0.03, 0.009, 0.0027]


def records(errors, last=1e-15, kinds=()):
    """Iterations with these errors, and one more with a residual at round-off; kinds are residuals over errors."""
    kinds = [*kinds, *(len(errors) + 1 - len(kinds)) * [1.0]]
    return [
        Iteration(
            number=k,
            residual=error * kind,
            increment=error,
            energy=0.0 if error == last else error**2,
            entered=0,
            left=0,
            step_length=1.0,
            negative_pivots=None,
            seconds=0.0,
        )
        for k, (error, kind) in enumerate(zip([*errors, last], kinds, strict=True), start=1)
    ]


def changed(at, **change):
    """Slow iterations with a change in one of them, counted from the end."""
    iterations = records(SLOW)
    iterations[at] = replace(iterations[at], **change)
    return iterations


@pytest.mark.parametrize("order", [1.0, 1.5, 2.0])
def test_order_of_newton(order):
    errors = [0.3, *[0.3 ** (order**k) for k in range(1, 4)]] if order > 1 else SLOW
    assert newton_order(records(errors)) == pytest.approx(order, rel=1e-6)


def test_an_error_at_round_off_tells_no_order():
    errors = [0.1, 0.01, 1e-4]
    assert newton_order(records([*errors, 2e-9], last=1e-9)) == pytest.approx(2.0)


def test_no_order_from_too_few_iterations_or_without_progress():
    assert newton_order(records([0.1, 0.01])) is None
    assert newton_order(records([0.1, 0.2, 0.1])) is None
    assert newton_order([]) is None


def test_of_several_passes_the_last_one_counts():
    quadratic = records([0.1, 0.01, 1e-4])
    assert newton_order([*records(SLOW), *quadratic]) == pytest.approx(2.0)
    assert newton_order([*quadratic, *records(SLOW)]) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        ({"entered": 1}, CONTACT),
        ({"left": 2}, CONTACT),
        ({"switched": 3}, FLOW),
        ({"step_length": 0.5}, SEARCH),
        ({"entered": 1, "switched": 3, "step_length": 0.5}, CONTACT),
        ({"switched": 3, "step_length": 0.5}, FLOW),
    ],
)
def test_what_was_recorded_in_the_last_two_steps_is_the_reason(change, expected):
    for at in (-2, -3):
        assert reason(measurable(changed(at, **change))) == expected
    assert reason(measurable(changed(-4, **change))) == OPEN  # what led to the first of the three errors


def test_stiff_and_soft_errors_in_turns():
    assert reason(measurable(records(SLOW, kinds=(1.0, 1.0, 5.0, 1.0)))) == TURNS
    assert reason(measurable(records(SLOW, kinds=(1.0, 1.0, 5.0, 25.0)))) == OPEN
    assert reason(measurable(records(SLOW, kinds=(1.0, 1.0, 1.5, 1.0)))) == OPEN


def test_steps_from_an_error_that_need_not_be_small():
    assert reason(measurable(records(SLOW[1:]))) == FEW
    assert reason(measurable(records([0.04, *SLOW[1:]]))) == FEW
    assert reason(measurable(records(SLOW))) == OPEN


def test_reasons_are_counted_where_the_order_is_low():
    found = measure(
        [records([0.1, 0.01, 1e-4]), records(SLOW), changed(-2, left=1), changed(-2, left=1), records([0.1])]
    )
    assert found.measured == 4
    assert found.order == pytest.approx(1.0)
    assert found.low == {CONTACT: 2, OPEN: 1}
    assert found.why() == "contact 2, open 1"
    assert measure([records([0.1])]).why() == "too short to tell"
    assert set(REASONS) >= set(found.low)

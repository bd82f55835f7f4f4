"""Between the angles of a table: a stated error, checked by a run, and nothing beyond."""

from __future__ import annotations

from dataclasses import replace

import pytest

from umform.errors import InvalidValue
from umform.studies.bend_table import bend, bend_table
from umform.studies.bend_table import table as module


@pytest.fixture(scope="module")
def checked(table, store):
    (part,) = bend_table([table.parts[0].setup], [120, 135, 150], check=True, store=store, processes=1).parts
    return part


def test_an_angle_between_has_the_error_of_its_interval(checked, store):
    assert [one.wanted for one in checked.checks] == [127.5, 142.5]
    for angle in (130.0, 140.0):
        found, truth = checked.at(angle), bend(checked.setup.case, angle, store=store)
        assert 0.0 < found.error < 0.02
        assert abs(found.deduction - truth.deduction) < 1.5 * found.error + 2e-4
        assert abs(found.allowance - truth.allowance) < 0.05
    assert checked.cubic_error == max(checked.at(127.5).error, checked.at(142.5).error)
    assert checked.linear_error > checked.cubic_error


def test_a_bend_of_the_table_is_itself(checked):
    one = checked.bends[1]
    assert checked.at(135.0).deduction == one.deduction and checked.at(135.0).error == 0.0


@pytest.mark.parametrize(("failed", "checks"), [(120, [142.5]), (135, [127.5, 142.5]), (150, [127.5])])
def test_a_bend_that_fails_takes_its_intervals_with_it(checked, store, monkeypatch, failed, checks):
    def failing(case, angles, *, on_failure, **options):
        on_failure(failed, InvalidValue("the sheet springs back flat"))
        return bends(case, [angle for angle in angles if angle != failed], on_failure=on_failure, **options)

    bends = module.bends
    monkeypatch.setattr(module, "bends", failing)
    (part,) = bend_table([checked.setup], [120, 135, 150], check=True, store=store, processes=1).parts
    assert list(part.failed) == [failed] and [one.wanted for one in part.checks] == checks
    errors = [abs(part.at(one.wanted).deduction - one.deduction) for one in part.checks]
    for one in (part, replace(part, checks=part.checks[::-1])):
        assert one.at(checks[0] + 1.0).error == one.cubic_error == max(errors)
    assert 0.0 < part.linear_error < 0.1


@pytest.mark.parametrize("angle", [119.9, 150.1])
def test_nothing_is_extrapolated(checked, angle):
    with pytest.raises(InvalidValue, match="120 to 150 degrees"):
        checked.at(angle)


def test_nothing_unchecked_is_interpolated(table):
    with pytest.raises(InvalidValue, match="not checked by runs"):
        table.parts[0].at(130.0)

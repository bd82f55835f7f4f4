"""Derivatives by shadows beside whole runs: every law, and every kind of step, tool, control and load."""

from __future__ import annotations

from dataclasses import replace

import pytest

from umform_book.derivatives.chains import CHAINS, compared_chain
from umform_book.derivatives.differences import compared
from umform_book.derivatives.laws import LAWS, example
from umform_book.derivatives.steps import EXAMPLES


@pytest.mark.parametrize("name", LAWS)
def test_all_constants_of_a_law(name):
    """The shadow is the whole run with the same change; the change itself is seen in the derivative."""
    for one in compared(example(LAWS[name])):
        assert one.shadow < 1e-5, one
        assert one.derivative < 2e-4, one
        assert one.switched == 0, one


@pytest.mark.parametrize("name", EXAMPLES)
def test_a_model(name):
    for one in compared(EXAMPLES[name]):
        assert one.derivative < EXAMPLES[name].limit, one
        assert EXAMPLES[name].ends or one.shadow < 1e-4, one


@pytest.mark.long
@pytest.mark.parametrize("name", CHAINS)
def test_operations_one_after_the_other(name):
    for one in compared_chain(CHAINS[name]):
        assert one.derivative < CHAINS[name].limit, one


def test_the_second_bend_begins_with_what_the_first_has_left():
    chain = replace(CHAINS["part of two bends"], by=("sheet.material.hardening.strength",))
    (one,) = compared_chain(chain)
    assert one.derivative < chain.limit

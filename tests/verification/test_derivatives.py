"""Derivatives by shadows beside whole runs: every law, and every kind of step, tool, control and load."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform_book.derivatives.chains import CHAINS, compared_chain
from umform_book.derivatives.differences import SHADOW, compared
from umform_book.derivatives.laws import LAWS, example
from umform_book.derivatives.sheets import SHEETS
from umform_book.derivatives.steps import EXAMPLES

MODELS = {**EXAMPLES, **SHEETS}


@pytest.mark.parametrize("name", LAWS)
def test_all_constants_of_a_law(name):
    """The shadow is the whole run with the same change; the change itself is seen in the derivative."""
    for one in compared(example(LAWS[name])):
        assert one.shadow < 1e-5, one
        assert one.derivative < 2e-4, one
        assert one.switched == 0, one


@pytest.mark.parametrize("name", MODELS)
def test_a_model(name):
    for one in compared(MODELS[name]):
        assert one.derivative < MODELS[name].limit, one
        assert MODELS[name].ends or one.shadow < SHADOW, one


def test_a_clamped_strip_slips_back_and_still_rubs_at_the_end_of_its_release():
    """What makes the derivatives of this release those of its friction, too."""
    one = EXAMPLES["Release of a clamped strip; friction"]
    run = uf.solve(*one.build(**one.values), frames=0, progress=False)
    pulled, end = np.flatnonzero(run["step"] == 2)[-1], -1
    assert abs(run["pull_force"][end]) < 1e-6 * run["pull_force"][pulled]
    assert run["bed_active"][end] == run["bed_active"][pulled] > run["bed_slipping"][end] > 0
    assert run["bed_fx"][pulled] > 50.0 > -5.0 > run["bed_fx"][end]


@pytest.mark.long
@pytest.mark.parametrize("name", CHAINS)
def test_operations_one_after_the_other(name):
    for one in compared_chain(CHAINS[name]):
        assert one.derivative < CHAINS[name].limit, one

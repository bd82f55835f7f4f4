"""Permanent set of a mild bend: defaults of plastic sheets against fibres integrated in numpy."""

from __future__ import annotations

import numpy as np
import pytest

from umform_book.case import Case
from umform_book.page import Page
from umform_book.sharp_bends.cantilever import cantilever_sets, fibres, permanent_sets

LEVELS = (1.1, 1.35)
PAGE = Page(Case("springback", "", "", "", lambda page: None))


@pytest.mark.parametrize("element", ["ANS3DEAS", "BEND18"])
def test_defaults_find_the_permanent_set_of_a_mild_bend(element):
    exact = permanent_sets(fibres(), LEVELS)
    assert np.abs(cantilever_sets(PAGE, "", element, LEVELS) / exact - 1.0).max() < 0.03


def test_the_element_of_the_literature_does_not():
    exact = permanent_sets(fibres(), LEVELS)
    found = cantilever_sets(PAGE, "", "ANS3DEAS", LEVELS, thickness_order=1, thickness_points=5)
    assert found[0] < 0.1 * exact[0]
    assert found[1] < 0.9 * exact[1]

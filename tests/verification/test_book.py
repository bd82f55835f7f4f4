"""Every case of the verification book on its short meshes: no red verdict, and a page that says something."""

from __future__ import annotations

import pytest

from umform_book.book import cases
from umform_book.checks import Verdict
from umform_book.page import Page
from umform_book.writing import page_text

#: Cases that take longest even on their short meshes: `make test-long`, as does `make verification` on the full ones.
LONG = (
    "derivatives-differences",
    "friction-draw-bead",
    "friction-u-bend",
    "reality-orders",
    "reality-split-ring",
    "scatter-u-bend",
)


@pytest.mark.parametrize("name", [pytest.param(one, marks=[pytest.mark.long] * (one in LONG)) for one in cases()])
def test_short(name):
    page = Page(cases()[name], short=True)
    page.case.run(page)
    assert page.checks
    reds = [check.cells() for check in page.checks if check.verdict is Verdict.RED]
    assert not reds
    assert "| verdict |" in page_text(page)

"""Results of cases, stored beside the pages, and the pages of all cases that are written from them."""

from __future__ import annotations

import importlib.util
import json
import math
from dataclasses import replace
from pathlib import Path

import pytest

import umform as uf
from umform_book import book
from umform_book.case import Case, Chapter
from umform_book.checks import Check, Verdict
from umform_book.outcome import CheckRecord, Outcome
from umform_book.page import StudyRecord
from umform_book.stored import RESULTS, store, stored

ROOT = Path(__file__).parents[2]
BOOK = ROOT / "docs" / "verification"


def case(name, found=1.0):
    return Case(name, f"Case {name}", "A number.", "One.", lambda page: page.check(f"{name}: it", found, 1.0, 0.1))


@pytest.fixture
def use(monkeypatch):
    """Make cases the book."""

    def make(*cases):
        monkeypatch.setattr(book, "chapters", lambda: (Chapter("Numbers", "Of all kinds.", cases),))

    return make


def test_the_committed_pages_of_all_cases_are_those_of_the_committed_results():
    for page, text in book.pages_of_all(BOOK).items():
        assert (BOOK / page).read_text(encoding="utf-8") == text, page


def test_every_case_has_results_and_no_other():
    assert {path.stem for path in (BOOK / RESULTS).iterdir()} == set(book.cases())


def test_the_committed_results_are_those_of_the_committed_pages():
    for name, outcome in stored(BOOK, book.cases()).items():
        page = (BOOK / f"{name}.md").read_text(encoding="utf-8")
        assert f"**{outcome.verdict.mark}**" in page
        checks = page.split("\n## Checks\n")[1].split("**Causes**")[0]
        for check in outcome.checks:
            row = (check.what, check.reference, check.found, check.deviation, check.limit, check.verdict.mark)
            assert f"| {' | '.join(row)}" in checks, name


def test_a_run_changes_its_own_row_and_the_totals(use, tmp_path):
    use(case("one"), case("two"))
    book.run_cases(["one", "two"], tmp_path, processes=1)
    row = "| [Case two](two.md) | 🟢 | < 1 % | two: it |"
    before = (tmp_path / "README.md").read_text()
    assert "**2 cases: 2 🟢 green, 0 🟠 amber, 0 🔴 red.** 2 of 2 checks hold" in before
    assert row in before
    use(case("one", 1.2), case("two", 1.2))
    book.run_cases(["one"], tmp_path)
    after = (tmp_path / "README.md").read_text()
    assert "**2 cases: 1 🟢 green, 0 🟠 amber, 1 🔴 red.** 1 of 2 checks hold" in after
    assert "| [Case one](one.md) | 🔴 | 200 % | one: it |" in after
    assert row in after


def test_cases_without_results_are_counted_and_those_that_are_gone_dropped(use, tmp_path):
    use(case("old"), case("one"))
    book.run_cases(["old"], tmp_path)
    assert "**1 of 2 cases: 1 🟢 green" in (tmp_path / "README.md").read_text()
    use(case("one"))
    book.run_cases(["one"], tmp_path)
    text = (tmp_path / "README.md").read_text()
    assert "**1 case: 1 🟢 green" in text
    assert "Case old" not in text


def test_results_are_read_as_they_were_written(tmp_path):
    (tmp_path / RESULTS).mkdir()
    checks = (
        Check("a | b", 1.01, 1.0, 0.1),
        Check("exact", 1.0, 0.0, 0.0, relative=False),
        Check("no number", math.nan, 1.0, 0.1),
        Check("known", 1.3, 1.0, 0.1, known=0.5, cause="it is coarse"),
    )
    outcome = Outcome(
        "bar",
        Verdict.RED,
        tuple(CheckRecord.of(check) for check in checks),
        {"runs": "3", "drift": "1.0e-03"},
        (StudyRecord("bar", "force", {"A": {2: 0.5, 4: 1.0}, "B": {}}),),
        versions="umform 1",
    )
    store(tmp_path, outcome)
    assert stored(tmp_path, ["bar", "other"]) == {"bar": outcome}
    store(tmp_path, replace(outcome, studies=(StudyRecord("bar", "force", {"A": {2: math.inf}}),)))
    assert math.isnan(stored(tmp_path, ["bar"])["bar"].studies[0].values["A"][2])
    failed = Outcome("bar", Verdict.RED, failure="two\nlines", versions="umform 1")
    store(tmp_path, failed)
    assert stored(tmp_path, ["bar"])["bar"] == failed


@pytest.mark.parametrize("text", ["{", "[]", '{"verdict": "BLUE", "versions": "", "checks": []}'])
def test_results_that_cannot_be_read(use, tmp_path, text):
    use(case("one"), case("two"))
    (tmp_path / RESULTS).mkdir()
    (tmp_path / RESULTS / "two.json").write_text(text)
    with pytest.raises(uf.errors.FileProblem, match="results of a case cannot be read") as caught:
        book.run_cases(["one"], tmp_path)
    assert "umform verify two --out" in str(caught.value)


def test_the_readme_reads_its_numbers_from_results(tmp_path, monkeypatch):
    spec = importlib.util.spec_from_file_location("readme_numbers", ROOT / "tools" / "readme_numbers.py")
    numbers = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(numbers)
    (tmp_path / RESULTS).mkdir()
    check = Check("poor", 1.3, 1.0, 0.1, known=0.5, cause="the mesh")
    store(tmp_path, Outcome("bar", Verdict.AMBER, (CheckRecord.of(check),)))
    assert json.loads((tmp_path / RESULTS / "bar.json").read_text())["checks"][0]["share"] == 3.0
    monkeypatch.setattr(numbers, "BOOK", tmp_path)
    assert numbers.rows("bar") == {"poor": ["1", "1.3", "+30.00 %"]}

"""Pages, the summary and what is drawn from all cases: made here from a case that takes no time."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from matplotlib.figure import Figure

import umform as uf
from umform_book import book
from umform_book.balance import BalanceRow
from umform_book.case import Case, Chapter
from umform_book.checks import Check, Verdict
from umform_book.convergence import normalised, show, study
from umform_book.errata import errata_text
from umform_book.linear_algebra import linear_solution
from umform_book.markdown import unfolded
from umform_book.newton_order import NewtonOrder
from umform_book.outcome import CheckRecord, Outcome
from umform_book.page import Page, StudyRecord
from umform_book.variants import SEVEN, VARIANTS, Variant
from umform_book.which_element import which_element_text
from umform_book.writing import page_text, worst


def stretched(page):
    """A bar under tension: exact on every mesh."""

    def elongation(variant, divisions):
        mesh = uf.mesh.strip(10, 1, 1, (variant.cells(divisions), 1), cell=variant.cell)
        model = uf.Model(mesh, variant.element, material=uf.SVK(E=100, nu=0.3))
        for plane, normal in (("x0", "x"), ("y0", "y"), ("lower", "z")):
            model.symmetry(plane, normal)
        load = model.traction("x1", (1, 0, 0))
        return linear_solution(model, load.vector)[mesh.nodes("x1"), 0].mean()

    pair = (Variant("ANS3DEAS"), Variant("MI9K3DEAS"))
    found = study(page, pair, page.pick((2, 4, 8), (2, 4)), elongation)
    show(page, "convergence", "elongation over 0.1", normalised(found, 0.1))
    page.check("ANS3DEAS, 4 intervals", found[pair[0]][4], 0.1, within=1e-8)
    page.check("a count", 3, 3, within=0)
    page.check("an expectation that is too high", 0.9, 1.0, 0.01, known=0.2, cause="it was too high")
    page.heading("More")
    page.table("A table", ("a", "b"), [("x", None), ("y", 0.123456), ("z", float("nan"))])


def failing(page):
    raise uf.errors.InvalidValue("this case cannot be run", value=1)


STRETCHED = Case("bar-stretched", "A bar under tension", "A bar.", "Hooke.", stretched)
OWN = Case("bar-own", "A bar of our own", "A bar.", "Finer bars.", stretched, own="a finer bar, umform itself")
FAILING = Case("bar-failing", "A bar that fails", "A bar.", "Nobody.", failing)


@pytest.fixture
def small_book(monkeypatch):
    chapters = (Chapter("Bars", "Simple things.", (STRETCHED, FAILING)),)
    monkeypatch.setattr(book, "chapters", lambda: chapters)


def test_pages_and_what_is_drawn_from_them(small_book, tmp_path):
    outcomes = book.run_cases(["bar-stretched", "bar-failing"], tmp_path / "deep" / "book", processes=1)
    folder = tmp_path / "deep" / "book"
    page = (folder / "bar-stretched.md").read_text()
    for part in ("**🟠 amber**", "Hooke.", "1. it was too high", "### More", "| x | - |", "| y | 0.1235 |"):
        assert part in page
    assert (folder / "images" / "bar-stretched-convergence.svg").stat().st_size > 1000
    summary = (folder / "README.md").read_text()
    assert "**2 cases: 0 🟢 green, 1 🟠 amber, 1 🔴 red.** 2 of 3 checks hold; 0 more fail" in summary
    assert "| [A bar under tension](bar-stretched.md) | 🟠 | 1000 % | an expectation that is too high |" in summary
    assert "| [A bar that fails](bar-failing.md) | 🔴 | - | this case cannot be run" in summary
    assert "<summary>1 🟠, 1 🔴: all cases</summary>" in summary
    missed = summary[summary.index("## What misses") :].splitlines()
    assert [line.count("|") for line in missed[2:6]] == [6] * 4 and "(bar-failing.md) | 🔴" in missed[4]
    assert missed[5].endswith("| 🟠 | 1000 % | an expectation that is too high | it was too high |")
    errata = (folder / "errata.md").read_text()
    assert "  * an expectation that is too high: -10.00 %, limit 1 %. It was too high." in errata
    assert "because the run failed: bar-failing." in errata
    assert (folder / "balance.md").read_text().startswith("# Balance")
    assert "| 1 / 1 | 1 / 1 |" in (folder / "which-element.md").read_text()
    assert outcomes["bar-failing"].verdict is Verdict.RED
    assert not list(folder.glob(".*"))


def test_a_reference_of_umform_itself_is_marked_on_its_page_and_in_the_summary(monkeypatch, tmp_path):
    monkeypatch.setattr(book, "chapters", lambda: (Chapter("Bars", "Simple things.", (STRETCHED, OWN)),))
    book.run_cases(["bar-stretched", "bar-own"], tmp_path, processes=1)
    assert "**Own reference:** a finer bar, umform itself." in (tmp_path / "bar-own.md").read_text()
    assert "Own reference" not in (tmp_path / "bar-stretched.md").read_text()
    summary = (tmp_path / "README.md").read_text()
    assert "[A bar of our own](bar-own.md) \\* |" in summary
    assert "(bar-stretched.md) |" in summary


def test_cases_whose_reference_says_that_it_is_our_own_are_marked():
    """The words that such references are written with."""
    words = ("our own", "own stack", "own computation", "stack of", "finest mesh", "stiffest penalty stands")
    for chapter in book.chapters():
        for case in chapter.cases:
            if any(word in case.reference.lower() for word in words):
                assert case.own, case.name


def test_verdict_and_picture_stand_first_and_long_tables_are_folded(tmp_path):
    page = Page(STRETCHED, tmp_path)
    stretched(page)
    page.table("Long", ("a", "b < c"), [(str(number), 1.0) for number in range(20)])
    page.balances.append(BalanceRow("bar", "a run", 3, 9, 2e-15, 3e-9, 1e-3, NewtonOrder(2.04, 3, {})))
    text = page_text(page)
    order = ["# A bar", "**🟠 amber** · 2 of 3 checks hold", "Misses most: an expectation", "![elongation over 0.1;"]
    order += ["## Problem", "## Reference", "## Results", "### More", "## Checks", "Checks that miss: 1", "## Balance"]
    places = [text.index(part) for part in order]
    assert places == sorted(places)
    assert text.count("![") == 1
    assert "<details>\n<summary>Long</summary>\n\n| a | b < c |" in text
    assert "**A table**" in text
    assert "| a run | 3 | below 1e-6 | below 1e-6 | 1.0e-03 | quadratic |" in text
    assert "<" not in unfolded(text).replace("b < c", "")


def test_a_picture_of_choice_stands_first(tmp_path):
    page = Page(replace(STRETCHED, picture="second"), tmp_path)
    for name in ("first", "second"):
        page.figure(name, Figure(), name)
    assert page.main.startswith("![second]")
    assert page.blocks == ["![first](images/bar-stretched-first.svg)\n\n*first*"]


def test_the_main_picture_of_every_case_is_one_that_it_draws():
    """Names of pictures stand in the module of the case."""
    for chapter in book.chapters():
        for case in chapter.cases:
            page = Path(__file__).parents[2] / "docs" / "verification" / f"{case.name}.md"
            assert not case.picture or f"(images/{case.name}-{case.picture}." in page.read_text(), case.name


def test_the_pages_have_the_words_of_the_code():
    """Title, problem and reference of each case; all of the pages that are made from stored results."""
    folder = Path(__file__).parents[2] / "docs" / "verification"
    for name, case in book.cases().items():
        text = (folder / f"{name}.md").read_text(encoding="utf-8")
        assert text.startswith(f"# {case.title}\n"), name
        for part in (case.problem, case.reference, case.own):
            assert part.strip() in text, name
    for name, text in book.pages_of_all(folder).items():
        assert (folder / name).read_text(encoding="utf-8") == text, name


def test_an_expected_failure_leaves_a_page_green_and_is_listed():
    theory = {"known": 0.5, "cause": "it locks", "theory": "MacNeal 1987"}
    page = Page(STRETCHED, short=True)
    page.check("sound", 1.0, 1.0, 0.1)
    page.check("locks", 0.7, 1.0, 0.1, **theory)
    assert page.verdict is Verdict.GREEN
    text = page_text(page)
    assert "**🟢 green** · 1 of 1 checks hold, 1 expected failure ·" in text
    assert "Expected failures: 1" in text
    assert "1. it locks (MacNeal 1987)" in text
    outcome = Outcome("bar", page.verdict, tuple(CheckRecord.of(check) for check in page.checks))
    errata = errata_text({"bar": outcome})
    assert errata.index("None.") < errata.index("## Expected failures") < errata.index("locks: -30.00 %, limit 10 %")
    page.check("locks no more", 0.99, 1.0, 0.1, **theory)
    assert page.verdict is Verdict.AMBER
    assert "passes, but theory predicts a failure: it locks (MacNeal 1987)" in page_text(page)


def test_round_off_does_not_choose_the_worst_check():
    checks = [Check("load", 1.01, 1.0, 0.1), Check("noise", 9e-11, 0.0, 1e-10, relative=False)]
    assert worst(checks) is checks[0]
    assert worst(reversed(checks)) is checks[0]


def test_progress_is_told(small_book, tmp_path):
    told = []
    book.run_cases(["bar-stretched"], tmp_path, short=True, tick=lambda what, done: told.append((what, done)))
    assert told[0] == ("ANS3DEAS, 2", 0.0)
    assert told[-1][1] == 1.0


def test_an_unknown_case_is_told_with_the_nearest_one(small_book):
    with pytest.raises(uf.errors.InvalidValue, match="no such verification case") as caught:
        book.chosen(["bar-streched"])
    assert "did you mean bar-stretched?" in str(caught.value)


def test_without_checks_nothing_is_proved():
    assert Page(STRETCHED).verdict is Verdict.RED


def test_no_pictures_without_a_folder():
    page = Page(STRETCHED, short=True)
    stretched(page)
    assert not page.pictures
    assert "![" not in "".join(page.blocks)


def test_the_variants_are_the_seven_elements_twice():
    assert len(VARIANTS) == 14
    assert {variant.name for variant in VARIANTS} == set(SEVEN)
    assert Variant("MI9K3DEAS").cells(8) == 4
    assert len(set(VARIANTS)) == 14


def test_drawn_from_nothing():
    assert "None." in errata_text({})
    assert "0 / 0" not in which_element_text({})


def test_advice_counts_the_problems_that_an_element_meets():
    def study(case, good, poor):
        values = {"MI9K3DEAS, E_33 tied": {8: good, 16: 1.0}, "ANS3DEAS, E_33 tied": {8: poor, 16: poor}}
        return StudyRecord(case, "deflection", values)

    studies = (study("scordelis-lo", 0.99, 0.9), study("nonlinear-hemisphere", 0.9, 0.99), study("plastic-tube", 1, 1))
    studies += (StudyRecord("pinched-cylinder", "of one of them alone", {"ANS3DEAS, E_33 tied": {8: 1.0}}),)
    checks = Check("right", 1.0, 1.0, 0.01), Check("known", 1.1, 1.0, 0.01, known=0.2, cause="that is why")
    records = tuple(CheckRecord.of(check) for check in checks)
    told = which_element_text(
        {
            "any": Outcome("any", Verdict.GREEN, studies=studies),
            "bend-stability": Outcome("bend-stability", Verdict.AMBER, records),
        }
    )
    assert "| MI9K3DEAS, E_33 tied: 2 of 2, 12 intervals; ANS3DEAS, E_33 tied: 1 of 2, 8 intervals |" in told
    assert "| [bend-stability](bend-stability.md): 1 of 2 checks hold |" in told

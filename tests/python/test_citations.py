"""What is cited exists: equations and sections of docs/theory, files of its table, keys of references.bib."""

from __future__ import annotations

import re
from collections import Counter
from itertools import pairwise
from pathlib import Path

import pytest

from umform.elements import CATALOGUE, element

ROOT = Path(__file__).parents[2]
THEORY = ROOT / "docs" / "theory"
BOOK = ROOT / "book" / "src" / "umform_book"  # cites what it puts to the test, and holds no equation
PAGES = {page: page.read_text(encoding="utf-8") for page in sorted(THEORY.glob("*.md"))}
CODE = {
    file: file.read_text(encoding="utf-8")
    for folder in ("cpp", "src", "book/src")
    for file in sorted((ROOT / folder).rglob("*"))
    if file.suffix in (".hpp", ".cpp", ".py")
}
KEYS = Counter(re.findall(r"^@\w+\{(\w+),", (ROOT / "references.bib").read_text(encoding="utf-8"), flags=re.M))
TAGS = Counter(tag for text in PAGES.values() for tag in re.findall(r"\\tag\{(\d\.\d+)\}", text))

NUMBER = r"\(\d\.\d{1,3}\)"
CITED = re.compile(rf"\b[Ee]qs?\.\s*({NUMBER}(?:\s*(?:,|and|to|-)\s*{NUMBER})*)")


def expanded(text: str) -> list[str]:
    """Numbers of a citation such as "(3.5), (3.6)" or "(5.8)-(5.11)", those between the ends of a range too."""
    found = list(re.finditer(r"\((\d)\.(\d{1,3})\)", text))
    numbers = [match[0].strip("()") for match in found]
    for first, last in pairwise(found):
        if text[first.end() : last.start()].strip() in ("-", "to"):
            assert first[1] == last[1], f"{text}: a range stays in its chapter"
            numbers += [f"{first[1]}.{k}" for k in range(int(first[2]) + 1, int(last[2]))]
    return numbers


def cited(text: str) -> set[str]:
    """Equations that a file of the code cites."""
    return {number for match in CITED.finditer(text) for number in expanded(match[1])}


CITATIONS = {file: cited(text) for file, text in CODE.items()}


def table() -> list[tuple[str, str]]:
    """Rows of the table "Equation, what it is, file": equations and files as they stand there."""
    section = PAGES[THEORY / "README.md"].split("## Equation, what it is, file")[1].split("\n## ")[0]
    return [(row[0], row[2]) for row in re.findall(r"^\| (\(.*?) \| (.*?) \| (.*?) \|$", section, flags=re.M)]


def code_file(name: str) -> Path:
    if name.startswith("umform_book/"):
        return BOOK.parent / name
    return ROOT / ("src/umform" if name.endswith(".py") else "cpp/include/umform") / name


def test_citations_are_read():
    assert cited("// eqs. (3.5), (3.6)") == {"3.5", "3.6"}
    assert cited('"""Convergence.\neqs. (5.8)-(5.11)"""') == {"5.8", "5.9", "5.10", "5.11"}
    assert sum(map(bool, CITATIONS.values())) > 15


def test_no_equation_has_the_number_of_another():
    assert [tag for tag, count in TAGS.items() if count > 1] == []


@pytest.mark.parametrize("file", [file for file, found in CITATIONS.items() if found], ids=lambda file: file.name)
def test_equations_cited_in_the_code_exist(file):
    assert CITATIONS[file] - set(TAGS) == set()


def test_equations_cited_in_the_theory_exist():
    for page, text in PAGES.items():
        assert {number.strip("()") for number in re.findall(NUMBER, text)} - set(TAGS) == set(), page.name


def test_sections_cited_in_the_code_exist():
    sections = {number for text in PAGES.values() for number in re.findall(r"^## (\d\.\d+) ", text, flags=re.M)}
    wanted = {number for text in CODE.values() for number in re.findall(r"docs/theory, (\d\.\d+)", text)}
    assert wanted
    assert wanted - sections == set()


def test_the_table_has_each_equation_once():
    assert Counter(number for equations, _ in table() for number in expanded(equations)) == TAGS


@pytest.mark.parametrize("row", table(), ids=lambda row: row[0])
def test_files_of_the_table_exist_and_hold_the_citation(row):
    """Where the code cites the equation at all, one of the files of the row does."""
    equations, files = row
    names = re.findall(r"`(.+?)`", files)
    assert names or files in ("derivation", "tests")
    for name in names:
        assert code_file(name).is_file(), name
    for number in expanded(equations):
        where = [file for file, found in CITATIONS.items() if number in found and BOOK not in file.parents]
        assert not where or {code_file(name) for name in names} & set(where), (number, where)


def test_keys_cited_in_the_theory_are_those_of_the_references():
    assert [key for key, count in KEYS.items() if count > 1] == []
    listed = set(re.findall(r"\[([A-Z]\w+(?:\d{4}|PAMM))\]", PAGES[THEORY / "README.md"]))
    assert listed == set(KEYS)
    for page, text in PAGES.items():
        assert set(re.findall(r"\[([A-Z]\w+(?:\d{4}|PAMM))\]", text)) - set(KEYS) == set(), page.name


@pytest.mark.parametrize("name", CATALOGUE)
def test_an_element_cites_what_the_catalogue_of_the_theory_cites(name):
    key = element(name).citation
    assert key in KEYS
    rows = re.findall(rf"^\| `{name}` \| .*\| (.*) \|$", PAGES[THEORY / "2-elements.md"], flags=re.M)
    assert len(rows) == 1
    assert rows[0].startswith(f"[{key}]")


def test_works_named_in_the_list_of_elements_are_among_the_references():
    """Names such as "Simo & Rifai 1990" stand for keys."""
    text = CODE[ROOT / "src" / "umform" / "elements" / "catalogue.py"].replace("ü", "ue")
    works = re.findall(r"\b([A-Z][a-z]+(?:(?:, | & )[A-Z][a-z]+)+) \(?(\d{4})\)?", text)
    assert len(works) >= 5
    assert {re.sub(", | & ", "", names) + year for names, year in works} - set(KEYS) == set()

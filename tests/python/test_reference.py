"""The reference: every public name stands on a page of the site, with a docstring whose example runs."""

from __future__ import annotations

import doctest
import inspect
import re
from pathlib import Path

import pytest

import umform as uf

API = Path(__file__).parents[2] / "docs" / "site" / "api"
COMPILED = {"set_threads", "threads"}  # docstrings of the bindings
NAMES = [name for name in uf.__all__ if not inspect.ismodule(getattr(uf, name))]


def on_the_pages() -> set[str]:
    """Full names that the tables of the pages list."""
    found = set()
    for page in API.glob("*.rst"):
        for module, table in re.findall(
            r"^\.\. currentmodule:: (\S+)\n\n\.\. autosummary::\n(.*?)(?=^\S|\Z)", page.read_text(), flags=re.M | re.S
        ):
            found |= {f"{module}.{name}" for name in re.findall(r"^   ([A-Za-z]\w*)$", table, flags=re.M)}
    return found


def test_every_public_name_is_on_a_page() -> None:
    assert {f"umform.{name}" for name in NAMES} <= on_the_pages()


@pytest.mark.parametrize("module", ["sheet_metals", "processes"])
def test_the_pages_list_what_a_module_exports(module: str) -> None:
    exported = {
        f"umform.{module}.{name}"
        for name in getattr(uf, module).__all__
        if callable(getattr(getattr(uf, module), name))  # constants stand in the text
    }
    assert exported <= on_the_pages()


def test_every_error_is_on_a_page() -> None:
    errors = (thing for thing in vars(uf.errors).values() if inspect.isclass(thing))
    known = {f"umform.errors.{error.__name__}" for error in errors if issubclass(error, uf.UmformError)}
    assert known - {"umform.errors.UmformError"} <= on_the_pages()


@pytest.mark.parametrize("name", sorted(set(NAMES) - COMPILED))
def test_every_public_name_has_an_example_that_runs(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    thing = getattr(uf, name)
    assert "\nExamples\n--------\n" in (inspect.getdoc(thing) or "")
    runner = doctest.DocTestRunner(verbose=False)
    for test in doctest.DocTestFinder(recurse=False).find(thing, name, globs={}):
        runner.run(test)
    assert runner.tries and not runner.failures

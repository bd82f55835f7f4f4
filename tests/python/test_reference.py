"""The reference: every public name stands on a page of the site, with a docstring whose example runs."""

from __future__ import annotations

import doctest
import importlib
import inspect
import logging
import pkgutil
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

import umform as uf

API = Path(__file__).parents[2] / "docs" / "site" / "api"
COMPILED = {"set_threads", "threads"}  # docstrings of the bindings
#: Modules whose exported classes and functions are on the pages, and their functions and parameters with examples.
MODULES = {
    "processes": (),
    "sheet_metals": (),
    "flat_pattern": (),
    "results.forming": (),
    "processes.air_bending": ("AirBending", "air_bending", "angle_table", "bending_table", "find_stroke"),
    "processes.bend_sequence": ("Bend", "BendSequence", "bend_sequence"),
    "processes.hemming": ("Hemming", "hemming"),
    "processes.draw": ("Cup", "UBend", "draw"),
    "processes.draw_bead": ("DrawBead", "drawn_through"),
    "studies.bend_table": ("bend", "bend_table", "setups"),
    "studies.calibration": (),
    "studies.derivatives": (),
    "studies.goals": (),
    "studies.identification": (),
    "studies.scatter": (),
}
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


@pytest.mark.parametrize("module", MODULES)
def test_the_pages_list_what_a_module_exports(module: str) -> None:
    here = importlib.import_module(f"umform.{module}")
    exported = {name for name in here.__all__ if callable(getattr(here, name))}  # constants stand in the text
    pages = on_the_pages()
    aliases = {f"umform.{name}" for name in uf.__all__} & pages  # a public name has one page
    missing = {name for name in exported if f"umform.{module}.{name}" not in pages and f"umform.{name}" not in aliases}
    assert missing - {"FormingLimit"} == set()  # a type for annotations


@pytest.mark.parametrize("name", [f"{module}.{name}" for module, names in MODULES.items() for name in names])
def test_processes_have_examples_that_run(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    module, _, last = name.rpartition(".")
    run_examples(getattr(importlib.import_module(f"umform.{module}"), last), name)


@pytest.mark.parametrize(
    "package", ["studies", "sheet_metals", "surfaces", "results", "materials", "spec", "io", "model", "mesh"]
)
def test_examples_of_other_docstrings_run(package: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    path = importlib.import_module(f"umform.{package}").__path__
    for module in pkgutil.walk_packages(path, f"umform.{package}."):
        assert not doctest.testmod(importlib.import_module(module.name)).failed, module.name


def test_methods_of_a_model_are_on_its_page() -> None:
    page = (API / "model.rst").read_text(encoding="utf-8")
    listed = set(re.findall(r"^   Model\.(\w+)$", page, flags=re.M))
    assert listed == {name for name in vars(uf.Model) if not name.startswith("_")} - {"carries_loose_sheet"}


def test_every_error_is_on_a_page() -> None:
    errors = (thing for thing in vars(uf.errors).values() if inspect.isclass(thing))
    known = {f"umform.errors.{error.__name__}" for error in errors if issubclass(error, uf.UmformError)}
    assert known - {"umform.errors.UmformError"} <= on_the_pages()


@pytest.mark.parametrize("name", sorted(set(NAMES) - COMPILED))
def test_every_public_name_has_an_example_that_runs(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    run_examples(getattr(uf, name), name)


@pytest.fixture(autouse=True)
def no_warnings(caplog: pytest.LogCaptureFixture) -> Iterator[None]:
    """Examples print none."""
    yield
    assert [one.message for one in caplog.get_records("call") if one.levelno >= logging.WARNING] == []


def run_examples(thing: object, name: str) -> None:
    """Run the examples of a docstring, of which there must be one."""
    assert "\nExamples\n--------\n" in (inspect.getdoc(thing) or "")
    runner = doctest.DocTestRunner(verbose=False)
    for test in doctest.DocTestFinder(recurse=False).find(thing, name, globs={}):
        runner.run(test)
    assert runner.tries and not runner.failures

"""The version stands in one place; what cites it agrees. What the two packages of the repository hold."""

import tomllib
from importlib import metadata
from pathlib import Path

import umform

ROOT = Path(__file__).parents[2]


def test_the_citation_and_the_installed_package_have_the_version_of_the_code():
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert f"\nversion: {umform.__version__}\n" in citation
    assert metadata.version("umform") == umform.__version__
    assert 'dynamic = ["version"]' in (ROOT / "pyproject.toml").read_text(encoding="utf-8")


def test_the_book_has_the_version_of_umform_and_needs_that_one():
    project = tomllib.loads((ROOT / "book" / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert project["version"] == metadata.version("umform-book") == umform.__version__
    assert f"umform=={umform.__version__}" in project["dependencies"]


def test_neither_wheel_holds_files_of_the_other():
    """The record of an installed package lists the names of its wheel."""
    for name, package in (("umform", "umform"), ("umform-book", "umform_book")):
        files = metadata.files(name)
        folders = {file.parts[0] for file in files if file.suffix == ".py"}
        assert folders == {package}
        assert len(files) > 100
    points = metadata.distribution("umform").entry_points
    assert not [point for point in points if point.group == "umform.commands"]

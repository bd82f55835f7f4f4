"""The version stands in one place; what cites it agrees. What the two packages of the repository hold."""

import re
import shutil
import tomllib
from importlib import metadata, util
from pathlib import Path

import pytest

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


FILES = ("CHANGELOG.md", "CITATION.cff", "pyproject.toml", "book/pyproject.toml", "src/umform/__init__.py")


def problems(root, tag=""):
    spec = util.spec_from_file_location("check_release", ROOT / "tools/check_release.py")
    module = util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return list(module.problems(root, tag))


@pytest.fixture
def sources(tmp_path):
    for name in FILES:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    return tmp_path


def change(folder, name, old, new):
    text = (folder / name).read_text(encoding="utf-8")
    assert old in text
    (folder / name).write_text(text.replace(old, new), encoding="utf-8")


def test_versions_and_date_of_the_sources_agree(sources):
    assert problems(ROOT) == problems(sources) == []


@pytest.mark.parametrize(
    ("name", "old", "new", "message"),
    [
        ("src/umform/__init__.py", '__version__ = "0.', '__version__ = "9.', "book/pyproject.toml: version 0."),
        ("CITATION.cff", "\nversion: 0.", "\nversion: 9.", "CITATION.cff: version 9."),
        ("CITATION.cff", "\ndate-released: 20", "\ndate-released: 19", "CITATION.cff: date-released is not 20"),
        (
            "CHANGELOG.md",
            f"## [{umform.__version__}] - 20",
            f"## [{umform.__version__}] 20",
            "CHANGELOG.md: no heading",
        ),
    ],
)
def test_what_does_not_agree_is_named(sources, name, old, new, message):
    change(sources, name, old, new)
    assert problems(sources)[0].startswith(message)


def test_a_tag_needs_its_name_an_empty_unreleased_and_an_address(sources):
    text = (sources / "CHANGELOG.md").read_text(encoding="utf-8")
    text = re.sub(r"(## \[Unreleased\]\n).*?(?=\n## \[)", r"\1", text, flags=re.DOTALL)
    (sources / "CHANGELOG.md").write_text(text, encoding="utf-8")
    change(sources, "CHANGELOG.md", "## [Unreleased]\n", "## [Unreleased]\n\n- More.\n")
    wrong = problems(sources, "v9.9.9")
    assert [text.partition(":")[0] for text in wrong] == [
        "the tag is v9.9.9, the version " + umform.__version__,
        "CHANGELOG.md",
        "pyproject.toml",
    ]
    change(sources, "CHANGELOG.md", "\n\n- More.", "")
    change(sources, "pyproject.toml", "https://forge.example/umform", "https://forge.invalid/umform")
    assert problems(sources, f"v{umform.__version__}") == []

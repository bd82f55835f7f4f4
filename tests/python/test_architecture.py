"""What docs/architecture.md says of folders, imports and dependencies is what is there."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
BOOK = tomllib.loads((ROOT / "book" / "pyproject.toml").read_text(encoding="utf-8"))
SOURCE = ROOT / "src" / "umform"
(LAYERS,) = (one["layers"] for one in PROJECT["tool"]["importlinter"]["contracts"] if one["type"] == "layers")


def section(title: str) -> str:
    return PAGE.split(f"\n## {title}\n")[1].split("\n## ")[0]


def test_the_layers_of_the_page_are_those_that_lint_checks():
    block = re.search(r"^```text\n(.*?)^```", section("Direction of imports"), flags=re.S | re.M)[1]
    assert block.splitlines() == LAYERS


def test_each_room_has_a_layer():
    layered = {name for layer in LAYERS for name in re.split(r" [|:] ", layer)}
    made = {path.stem for path in SOURCE.iterdir() if path.is_dir() or path.suffix == ".py"}
    rooms = {f"umform.{name}" for name in made if not name.startswith("_")} | {"umform_book"}
    assert layered == rooms


def test_each_folder_and_each_file_beside_the_folders_is_on_the_page():
    block = section("Folders")
    words = set(re.findall(r"[\w]+", block))
    folders = [path for parent in (SOURCE, ROOT / "cpp" / "include" / "umform") for path in parent.iterdir()]
    names = {path.stem for path in folders if (path.is_dir() or path.suffix == ".py") and not path.name.startswith("_")}
    assert names - words == set()
    named = re.findall(r"^  ((?:\w+/ ?)+)", block, flags=re.M)
    assert named
    for name in (name for group in named for name in group.split()):
        assert any((parent / name).is_dir() for parent in (SOURCE, ROOT / "cpp" / "include" / "umform")), name


@pytest.mark.parametrize("kind", ["dependencies", "build", "book", *PROJECT["project"]["optional-dependencies"]])
def test_each_dependency_has_a_reason_on_the_page(kind):
    project = PROJECT["project"]
    required = {
        "dependencies": project["dependencies"],
        "build": PROJECT["build-system"]["requires"],
        "book": BOOK["build-system"]["requires"] + BOOK["project"]["dependencies"][1:],  # the first is umform
        **project["optional-dependencies"],
    }[kind]
    table = section("Dependencies, and why")
    for requirement in required:
        name = re.match(r"[\w-]+", requirement)[0]
        assert re.search(rf"^\|[^|]*\b{re.escape(name)}\b[^|]*\|", table, flags=re.M), name


def test_processes_build_models_from_problems_only():
    """`Problem.build` is the one builder."""
    made = [path for path in (SOURCE / "processes").rglob("*.py") if re.search(r"\bModel\(", path.read_text("utf-8"))]
    assert made == []

"""The notebooks of the docs are stored without outputs; the site executes them and looks at these."""

from __future__ import annotations

import sys
from pathlib import Path

import nbformat
import pytest

ROOT = Path(__file__).parents[2]
NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))
sys.path.insert(0, str(ROOT / "tools"))

from check_site import PICTURES, notebooks  # noqa: E402


def test_the_site_looks_at_each() -> None:
    assert [path.stem for path in NOTEBOOKS] == sorted(PICTURES)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks_are_stored_without_outputs(path: Path) -> None:
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    assert not any(cell.get("outputs") for cell in notebook.cells), "store notebooks without outputs"


def test_missing_pictures_and_tables_and_warnings_are_wrong(tmp_path: Path) -> None:
    folder = tmp_path / "notebooks"
    folder.mkdir()
    for name, pictures in PICTURES.items():
        shown = '<div class="output text_html"></div>' + '<img alt="a" src="../_images/1.png" />' * pictures
        (folder / f"{name}.html").write_text(shown)
    assert not list(notebooks(tmp_path))
    (folder / "bend.html").write_text('<img src="../_images/1.png"><div class="output stderr highlight"></div>')
    assert len(list(notebooks(tmp_path))) == 3

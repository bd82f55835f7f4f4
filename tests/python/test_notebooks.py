"""The notebooks of the docs are stored without outputs; the site executes them and looks at these."""

from __future__ import annotations

import sys
from pathlib import Path

import nbformat
import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tools"))

from check_site import NOTEBOOKS, PICTURES, notebooks  # noqa: E402

STORED = sorted(NOTEBOOKS.glob("*.ipynb"))


def test_the_site_looks_at_each() -> None:
    assert [path.stem for path in STORED] == sorted(PICTURES)


@pytest.mark.parametrize("path", STORED, ids=lambda path: path.stem)
def test_notebooks_are_stored_without_outputs(path: Path) -> None:
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    assert not any(cell.get("outputs") for cell in notebook.cells), "store notebooks without outputs"


@pytest.mark.parametrize("path", STORED, ids=lambda path: path.stem)
def test_notebooks_run_without_warnings(path: Path, tmp_path: Path) -> None:
    nbclient = pytest.importorskip("nbclient")
    ran = nbclient.execute(nbformat.read(path, as_version=4), cwd=str(tmp_path))
    said = [out.text for cell in ran.cells for out in cell.get("outputs", ()) if out.get("name") == "stderr"]
    assert not said


def site(root: Path) -> Path:
    """Pages of the notebooks with all that they show."""
    folder = root / "notebooks"
    folder.mkdir()
    for name, pictures in PICTURES.items():
        shown = '<div class="output text_html"></div>' + '<img alt="a" src="../_images/1.png" />' * pictures
        (folder / f"{name}.html").write_text(shown)
    return folder


def test_missing_pictures_and_tables_and_warnings_are_wrong(tmp_path: Path) -> None:
    folder = site(tmp_path)
    assert not list(notebooks(tmp_path))
    (folder / "bend.html").write_text('<img src="../_images/1.png"><div class="output stderr highlight"></div>')
    assert len(list(notebooks(tmp_path))) == 3


def test_files_that_a_notebook_leaves_are_wrong(tmp_path: Path) -> None:
    site(tmp_path)
    source = tmp_path / "source"
    source.mkdir()
    for path in STORED:
        (source / path.name).touch()
    assert not list(notebooks(tmp_path, source))
    (source / "run.h5").touch()
    (wrong,) = notebooks(tmp_path, source)
    assert wrong.endswith("run.h5")

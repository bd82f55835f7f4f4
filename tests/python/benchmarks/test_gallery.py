"""The gallery: its page and its pictures are those of the script, and its commands exist."""

import shlex
from pathlib import Path

import pytest
from PIL import Image
from typer.testing import CliRunner

from umform import cli

ROOT = Path(__file__).parents[3]
PICTURES = ROOT / "docs/images/gallery"


@pytest.fixture
def gallery(script):
    pytest.importorskip("umform_book")
    return script("gallery")


def test_the_page_is_that_of_the_script(gallery):
    assert (ROOT / "docs/gallery.md").read_text() == gallery.page(), "run `make gallery`"


def test_each_picture_is_there_and_fit_for_a_page(gallery):
    names = {*gallery.ENTRIES, "formed"}
    assert {path.stem for path in PICTURES.iterdir()} == names
    for path in PICTURES.iterdir():
        with Image.open(path) as picture:
            width, height = picture.size
        assert width <= 1200, path
        assert height <= 0.8 * width, path
        assert path.stat().st_size <= 200_000, path


def test_commands_have_their_options(gallery, monkeypatch):
    """Each is taken with an option more that does not exist, and only that is refused."""
    for entry in gallery.ENTRIES.values():
        for command in () if entry.run is None or callable(entry.run) else entry.run:
            words = shlex.split(command)
            assert words[0] == "umform"
            run = CliRunner().invoke(cli.app, [*words[1:], "--no-such-option"])
            assert run.exit_code == 2, command
            assert "--no-such-option" in run.stderr, command
            for word in words[1:]:
                if word.startswith("--") and word != "--no-such-option":
                    assert f"No such option: {word}" not in run.stderr

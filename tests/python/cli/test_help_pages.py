"""Help pages are quick, and as typer and rich print them without that."""

import io
import subprocess
import sys

import pytest
import typer
from rich.console import Console
from rich.markdown import Markdown

from umform import cli
from umform.cli.commands import FILES
from umform.cli.help_pages import Paragraphs
from umform.cli.importing import text_of

TREE = typer.main.get_command(cli.app)


def shown(text):
    """A text in the terminal, without the spaces that fill its lines."""
    console = Console(file=io.StringIO(), width=70, force_terminal=True, color_system=None)
    console.print(text)
    return [line.rstrip() for line in console.file.getvalue().splitlines()]


def texts(command):
    for one in (command, *command.params):
        yield from filter(None, (one.help, getattr(one, "epilog", None)))
    for below in getattr(command, "commands", {}).values():
        yield from texts(below)


def test_texts_of_all_commands_are_shown_as_by_rich():
    found = set(texts(TREE))
    assert len(found) > 150
    assert [text for text in found if shown(Paragraphs(text)) != shown(Markdown(text))] == []


@pytest.mark.parametrize(
    "text", ["# Head\n\n* one\n* two", "a **word**, `code`\nand [x](y)", "a `b` c\n\n`d`\n\n\n  e"]
)
def test_other_texts_are_shown_as_by_rich(text):
    assert shown(Paragraphs(text)) == shown(Markdown(text))


@pytest.mark.parametrize("name", FILES)
def test_the_list_has_the_texts_of_the_commands(name):
    assert text_of(f"umform.cli.{FILES[name]}", name) == TREE.commands[name].help


@pytest.mark.parametrize("words", [["--help"], ["bend", "--help"], ["draw", "cup", "--help"], ["-v", "bend", "--help"]])
def test_help_loads_no_parser_and_other_commands(words):
    start = f"import sys; sys.argv = ['umform', *{words}]; from umform.cli import main"
    code = f"{start}\ntry:\n    main()\nexcept SystemExit:\n    pass"
    run = subprocess.run(
        [sys.executable, "-c", f"{code}\nprint(*sys.modules)"], capture_output=True, text=True, check=True
    )
    *page, last = run.stdout.splitlines()
    loaded = set(last.split())
    assert "rich.table" in loaded and any("--help" in line for line in page)
    assert not loaded & {"rich.markdown", "markdown_it", "pygments", "rich.traceback", "numpy", "pydantic"}
    assert "umform.cli.hem" not in loaded

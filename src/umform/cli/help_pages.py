"""Fast import of what prints the help of a command: its texts are paragraphs, and need no parser of Markdown."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from types import ModuleType
from typing import Any

from umform.cli.importing import Execute, around

#: What a text may have in Markdown besides paragraphs and code: lists, headers, links, tables, entities, emphasis.
_MORE = re.compile(r"[*_#\[\]<>|\\&~]|^\s*(?:[-+>=]|\d+[.)])|^ {4}|  $|://", re.MULTILINE)


def without_markdown() -> None:
    """Prevent typer from loading a parser of Markdown and the colours of tracebacks: half of the time of a help page.

    For processes of a command only; nothing is imported before a help page needs it.
    """
    around("typer.rich_utils", _without)


def _without(execute: Execute, module: ModuleType) -> None:
    """Execute the module of typer with stand-ins for what it imports."""
    instead: dict[str, Any] = {"rich.markdown": ModuleType("rich.markdown"), "rich.traceback": ModuleType("traceback")}
    instead["rich.markdown"].Markdown = Paragraphs
    instead["rich.traceback"].Traceback = object  # `pretty_exceptions_enable` is off
    instead["attr"] = None  # rich asks for it, to print objects that help pages have not
    instead = {name: one for name, one in instead.items() if name not in sys.modules}
    sys.modules.update(instead)
    try:
        execute(module)
    finally:
        for name in instead:
            del sys.modules[name]


class Paragraphs:
    """A text of Markdown as rich prints it; rich itself prints one with more than paragraphs and code.

    Parameters
    ----------
    markup : str
        The text.
    style : str
        Its style.
    """

    def __init__(self, markup: str, style: str = "none") -> None:
        self.markup, self.style = markup, style

    def __rich_console__(self, console: Any, options: Any) -> Iterator[Any]:
        """The parts that rich prints."""
        from rich.text import Text

        beside_code = "".join(self.markup.split("`")[::2])
        if "``" in self.markup or _MORE.search(beside_code):
            from rich.markdown import Markdown

            yield Markdown(self.markup, style=self.style)
            return
        for number, paragraph in enumerate(re.split(r"\n\s*\n", self.markup.strip())):
            if number:
                yield Text()
            text = Text(style=self.style, justify="left")
            for place, part in enumerate(" ".join(paragraph.split()).split("`")):
                text.append(part, "markdown.code" if place % 2 else None)
            yield text

"""Tables and folded parts in Markdown that a forge, the site and a terminal show."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

#: A table with more rows than this is folded.
LONG = 8


def markdown_table(columns: Sequence[str], rows: Sequence[Sequence[str]], *, numbers: bool = False) -> str:
    """A table in Markdown; with ``numbers``, all columns but the first are aligned to the right."""
    rule = ("---",) + (("---:",) if numbers else ("---",)) * (len(columns) - 1)
    return "\n".join(f"| {' | '.join(line)} |" for line in (tuple(columns), rule, *rows))


def folded(title: str, content: str, rows: int = LONG + 1) -> str:
    """Content under its title, folded if it has many rows."""
    if rows > LONG:
        return f"<details>\n<summary>{escape(title, quote=False) or 'Table'}</summary>\n\n{content}\n\n</details>"
    return f"**{title}**\n\n{content}" if title else content


def unfolded(markdown: str) -> str:
    """The same page for a terminal, which cannot fold."""
    for tag in ("<details>\n", "</details>\n\n", "</details>"):
        markdown = markdown.replace(tag, "")
    return markdown.replace("<summary>", "**").replace("</summary>", "**")

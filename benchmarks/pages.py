"""Tables and lists of the pages in docs, and the marks between which they stand."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path


def put(page: Path, name: str, text: str) -> None:
    """Put text between the marks of a name in a page: ``<!-- name -->`` and ``<!-- /name -->``."""
    first, last = f"<!-- {name} -->", f"<!-- /{name} -->"
    before, rest = page.read_text(encoding="utf-8").split(first)
    page.write_text(f"{before}{first}\n{text.strip()}\n{last}{rest.split(last)[1]}", encoding="utf-8")


def table(rows: Sequence[Mapping[str, str]], left: Sequence[int] = ()) -> str:
    """Rows of cells by their headings; columns are aligned to the right but for some, counted from 0."""
    columns = ["---" if n in left else "---:" for n in range(len(rows[0]))]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in (rows[0], columns, *(row.values() for row in rows)))


def item(text: str) -> str:
    """An item of a list, in lines of 120 characters."""
    return textwrap.fill(text, 120, initial_indent="* ", subsequent_indent="  ", break_on_hyphens=False)

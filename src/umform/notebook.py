"""What a notebook shows of an object: its title, tables, notes and warnings as HTML."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from html import escape

Rows = Sequence[Sequence[str]]

#: Rows of a table that are shown from its beginning, and from its end.
_FIRST, _LAST = 30, 5
_LEFT, _RIGHT = "text-align:left;padding:.15em .7em", "text-align:right;padding:.15em .7em"


@dataclass(frozen=True)
class Display:
    """Title, tables, notes and warnings of an object.

    Attributes
    ----------
    title : str
        What it is, in a few words.
    tables : mapping of str to rows
        Tables by their headings, which may be empty: a header, then rows of cells.
    warnings, notes : sequence of str
        What makes the numbers doubtful, and what belongs beside them.
    """

    title: str
    tables: Mapping[str, Rows] = field(default_factory=dict)
    warnings: Sequence[str] = ()
    notes: Sequence[str] = ()

    @property
    def html(self) -> str:
        """All of it as HTML, with styles in place and no script: a notebook that nobody trusts shows it too."""
        parts = [f"<b>{escape(self.title)}</b>"]
        for heading, rows in self.tables.items():
            if heading:
                parts.append(f'<div style="margin-top:.6em">{escape(heading)}</div>')
            parts.append(_table(rows))
        parts += [f'<div style="color:#b54708">&#9888; {escape(text)}</div>' for text in self.warnings]
        parts += [f'<div style="opacity:.75">{escape(text)}</div>' for text in self.notes]
        return f'<div class="umform">{"".join(parts)}</div>'


class InNotebook:
    """Base of objects that a notebook shows as tables."""

    __slots__ = ()

    @abstractmethod
    def _display(self) -> Display:
        """Title, tables, notes and warnings."""

    def _repr_html_(self) -> str:
        return self._display().html


def _table(rows: Rows) -> str:
    """An HTML table; columns whose cells begin like numbers are on the right."""
    header, *body = rows
    right = [any(row[n] for row in body) and all(_is_number(row[n]) for row in body) for n in range(len(header))]
    lines = [_line("th", header, right)]
    left_out = len(body) - _FIRST - _LAST
    if left_out > 0:
        lines += [_line("td", row, right) for row in body[:_FIRST]]
        lines.append(f'<tr><td colspan="{len(header)}" style="{_LEFT}">&#8230; {left_out} more rows</td></tr>')
        body = body[-_LAST:]
    lines += [_line("td", row, right) for row in body]
    return f"<table>{''.join(lines)}</table>"


def _line(tag: str, cells: Sequence[str], right: Sequence[bool]) -> str:
    marked = (
        f'<{tag} style="{_RIGHT if on_right else _LEFT}">{_cell(cell)}</{tag}>'
        for cell, on_right in zip(cells, right, strict=True)
    )
    return f"<tr>{''.join(marked)}</tr>"


def _cell(text: str) -> str:
    own = getattr(text, "_repr_html_", None)  # a number beyond its limit
    return escape(text) if own is None else str(own())


def _is_number(text: str) -> bool:
    word = text.split(" ")[0].replace("%", "")
    try:
        float(word)
    except ValueError:
        return word in ("", "–", "unknown")
    return True

"""The parts of a page: headings, paragraphs, tables, figures as HTML, and the page itself."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from datetime import datetime
from html import escape
from importlib.resources import files
from pathlib import Path
from string import Template

from matplotlib.figure import Figure

import umform
from umform.errors import InvalidValue
from umform.io.atomic import write_text
from umform.plotting import inline_svg
from umform.report.words import text_of
from umform.results.quantity import OF_MESH, Bad, Quantity

#: Letters of a warning on the first screen.
_SHORT = 110


def heading(text: str) -> str:
    """A heading."""
    return f"<h2>{escape(text)}</h2>"


def paragraph(text: str) -> str:
    """A paragraph of plain text."""
    return f"<p>{escape(text)}</p>"


def note(text: str, *, bad: bool = False) -> str:
    """A highlighted remark; lines of an error are kept."""
    if bad:
        return f'<pre class="note bad">{escape(text)}</pre>'
    return f'<p class="note">{escape(text)}</p>'


def table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table whose first column names the rows; cells that are `Bad` are marked."""
    head = "".join(f"<th>{escape(cell)}</th>" for cell in header)
    body = "\n".join("<tr>" + "".join(map(_cell, row)) + "</tr>" for row in rows)
    return f'<div class="wide"><table>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{body}\n</tbody></table></div>'


def _cell(text: str) -> str:
    mark = ' class="bad"' if isinstance(text, Bad) else ""
    return f"<td{mark}>{escape(text)}</td>"


def pairs(values: Mapping[str, object]) -> str:
    """Names and values, one a row."""
    rows = "\n".join(
        f"<tr><th>{escape(name)}</th><td>{escape(text_of(value))}</td></tr>" for name, value in values.items()
    )
    return f'<div class="wide"><table class="pairs">\n{rows}\n</table></div>'


def figure(picture: Figure, caption: str) -> str:
    """A picture with its caption."""
    return f"<figure><div>{inline_svg(picture)}</div><figcaption>{escape(caption)}</figcaption></figure>"


def side_by_side(figures: Iterable[str]) -> str:
    """Pictures in two columns where there is room."""
    return f'<div class="pictures">{"".join(figures)}</div>'


def first_screen(numbers: Sequence[Quantity], picture: str) -> str:
    """The numbers that are read first, beside the picture of the part."""
    return f'<section class="first">{cards(numbers)}<div>{picture}</div></section>'


def cards(numbers: Iterable[Quantity]) -> str:
    """Numbers in large letters, with their errors."""
    return '<dl class="cards">' + "".join(map(_card, numbers)) + "</dl>"


def _card(one: Quantity) -> str:
    error = "" if one.band is None else f" <small>{escape(replace(one, of_mesh=False).error_text)}</small>"
    unit = "°" if one.unit == "degrees" else f" <small>{escape(one.unit)}</small>" if one.unit else ""
    mark = ' class="bad"' if one.missed else ""
    mesh = f" <small>{OF_MESH}</small>" if one.of_mesh else ""
    hint = f"<dd><small>{escape(one.hint)}</small></dd>" if one.hint else ""
    return f"<div{mark}><dt>{escape(one.label)}</dt><dd>{escape(one.text)}{error}{unit}{mesh}</dd>{hint}</div>"


def section(title: str, content: Iterable[str], *, opened: bool = False) -> str:
    """A part with a heading that opens at a click; printing opens it."""
    state = " open" if opened else ""
    return f'<details class="part"{state}><summary><h2>{escape(title)}</h2></summary>{"".join(content)}</details>'


def warned(messages: Sequence[str]) -> str:
    """The beginning of the first warning on the first screen, with a link to all; empty without any."""
    if not messages:
        return ""
    first = messages[0].splitlines()[0]
    text = first if len(first) <= _SHORT else f"{first[:_SHORT].rsplit(' ', 1)[0]} …"
    count = "the warning" if len(messages) == 1 else f"all {len(messages)} warnings"
    return f'<p class="note bad warned"><b>Warning:</b> {escape(text)} <a href="#warnings">{count}</a></p>'


def warnings(messages: Sequence[str]) -> str:
    """All warnings, the target of the line of `warned`."""
    if not messages:
        return ""
    return f'<section id="warnings">{heading("Warnings")}{"".join(note(one, bad=True) for one in messages)}</section>'


def lines(text: str) -> str:
    """A text with its lines."""
    return f"<pre>{escape(text)}</pre>"


def folded(title: str, text: str) -> str:
    """A long text in a collapsed block, with its lines."""
    return folded_part(title, lines(text))


def folded_part(title: str, content: str) -> str:
    """Part of a page that opens at a click."""
    return f"<details><summary>{escape(title)}</summary>{content}</details>"


def items(texts: Iterable[str]) -> str:
    """A list."""
    return "<ul>" + "".join(f"<li>{escape(text)}</li>" for text in texts) + "</ul>"


def check_name(path: str | Path) -> None:
    """Reject a page whose name does not end in .html."""
    if Path(path).suffix != ".html":
        raise InvalidValue(
            "a report is a page of HTML",
            where="report",
            value=str(path),
            cause="a name without .html would open as something else",
            remedy="end it in .html",
        )


def write_html(
    path: str | Path, title: str, lead: str, parts: Iterable[str], *, style: str = "", scripts: str = ""
) -> Path:
    """Write a self-contained page, atomically.

    Parameters
    ----------
    path : str or Path
        The page, ending in .html.
    title, lead : str
        Plain text at its top.
    parts : iterable of str
        Its content, as HTML.
    style, scripts : str, optional
        More CSS, and <script> elements for the end of the page.
    """
    check_name(path)
    template = Template(files("umform.report").joinpath("page.html").read_text(encoding="utf-8"))
    text = template.substitute(
        title=escape(title),
        lead=escape(lead),
        body="\n".join(parts),
        style=style,
        scripts=scripts,
        version=escape(umform.__version__),
        date=f"{datetime.now():%Y-%m-%d}",
    )
    return write_text(path, text)

"""The parts of a page: headings, paragraphs, tables, figures as HTML, and the page itself."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from datetime import datetime
from html import escape
from importlib.resources import files
from pathlib import Path
from string import Template

from matplotlib.figure import Figure

import umform
from umform.errors import InvalidValue
from umform.io.atomic import PendingFile
from umform.plotting import inline_svg
from umform.results.quantity import Bad


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
    rows = "\n".join(f"<tr><th>{escape(name)}</th><td>{escape(str(value))}</td></tr>" for name, value in values.items())
    return f'<div class="wide"><table class="pairs">\n{rows}\n</table></div>'


def figure(picture: Figure, caption: str) -> str:
    """A picture with its caption."""
    return f"<figure><div>{inline_svg(picture)}</div><figcaption>{escape(caption)}</figcaption></figure>"


def folded(title: str, text: str) -> str:
    """A long text in a collapsed block, with its lines."""
    return f"<details><summary>{escape(title)}</summary><pre>{escape(text)}</pre></details>"


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
    with PendingFile(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
    return Path(path)

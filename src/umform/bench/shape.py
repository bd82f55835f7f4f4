"""The shape of a run in space as a page of its own: scene and curves of the report, without the rest of it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from umform.report import parts
from umform.report.live import Live, style

if TYPE_CHECKING:
    from umform.results.history import History

#: In a frame of another page there is no need for a title, margins or the table.
_STYLE = """
main { max-width: none; padding: 0 .2rem; }
header, footer, .history { display: none; }
.panel { margin: 0 0 1rem; }
.stage { height: clamp(15rem, 52vw, 26rem); }
"""


def write_shape(path: Path, result: History, title: str) -> Path:
    """Write the page.

    Parameters
    ----------
    path : Path
        Ending in .html.
    result : History
        A result, or what there is of it so far.
    title : str
        Of the page.
    """
    live = Live.of(result, stills=False)
    table = f'<div class="history">{live.table}</div>'
    content = [live.shape, *map(parts.note, live.notes), live.curves, table]
    return parts.write_html(path, title, "", content, style=style() + _STYLE, scripts=live.scripts)

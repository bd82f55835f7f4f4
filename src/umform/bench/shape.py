"""The 3D view of a run: a page with scene and curves of the report, which is updated during the run."""

from __future__ import annotations

import json
import math
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from umform.bench.folders import SCENE, SHAPE
from umform.report import parts
from umform.report.live import Live, style
from umform.report.scene import scene_of

if TYPE_CHECKING:
    from umform.results.history import History

#: In a frame of another page: without title, margins and table.
_STYLE = """
main { max-width: none; padding: 0 .2rem; }
header, footer, .history { display: none; }
.panel { margin: 0 0 1rem; }
.stage { height: clamp(15rem, 52vw, 26rem); }
"""


def write_shape(folder: Path, result: History, title: str) -> None:
    """Write the page if there is none, and the scene that updates it.

    Parameters
    ----------
    folder : Path
        Folder of the job.
    result : History
        The result so far.
    title : str
        Of the page.
    """
    path = folder / SHAPE
    if not path.exists():
        live = Live.of(result, stills=False)
        table = f'<div class="history">{live.table}</div>'
        content = [live.shape, *map(parts.note, live.notes), live.curves, table]
        listen = files("umform.bench").joinpath("page", "scene_updates.js").read_text(encoding="utf-8")
        scripts = f'{live.scripts}\n<script type="module">{listen}</script>'
        parts.write_html(path, title, "", content, style=style() + _STYLE, scripts=scripts)
    waiting = folder / f".{SCENE}"
    waiting.write_text(json.dumps({"scene": scene_of(result).data, "table": _table(result)}), encoding="utf-8")
    waiting.replace(folder / SCENE)


def _table(result: History) -> dict[str, object]:
    """The history by columns; None for what is no number."""
    columns = {
        name: [float(x) if math.isfinite(x) else None for x in column] for name, column in result.table().items()
    }
    return {"names": list(columns), "columns": columns, "length": len(result)}

"""The 3D view of a run: a page with scene and curves of the report, which is updated during the run."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from umform.bench.folders import SCENE, SHAPE
from umform.report import parts
from umform.report.live import Live, style
from umform.report.looks import UNKNOWN, Units
from umform.report.scene import scene_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from umform.results.history import History

#: In a frame of another page: without title, margins and table.
_STYLE = """
main { max-width: none; padding: 0 .2rem; }
header, footer, .history { display: none; }
.panel { margin: 0 0 1rem; }
.stage { height: clamp(15rem, 52vw, 26rem); }
"""


def write_shape(
    folder: Path,
    result: History,
    title: str,
    *,
    units: Units = UNKNOWN,
    more: Mapping[str, NDArray[np.float64]] | None = None,
) -> None:
    """Write the page if there is none, and the scene that updates it.

    Parameters
    ----------
    folder : Path
        Folder of the job.
    result : History
        The result so far.
    title : str
        Of the page.
    units : Units
        Names of the units.
    more : mapping of str to ndarray, optional
        Further columns of the history, the first of which is shown over the stroke at first.
    """
    path = folder / SHAPE
    if not path.exists():
        first = ("stroke", next(iter(more))) if more else None
        live = Live.of(result, stills=False, units=units, more=more, first=first)
        table = f'<div class="history">{live.table}</div>'
        content = [live.shape, *map(parts.note, live.notes), live.curves, table]
        listen = files("umform.bench").joinpath("page", "scene_updates.js").read_text(encoding="utf-8")
        scripts = f'{live.scripts}\n<script type="module">{listen}</script>'
        parts.write_html(path, title, "", content, style=style() + _STYLE, scripts=scripts)
    waiting = folder / f".{SCENE}"
    waiting.write_text(
        json.dumps({"scene": scene_of(result, units).data, "table": _table(result, more or {})}), encoding="utf-8"
    )
    waiting.replace(folder / SCENE)


def _table(result: History, more: Mapping[str, NDArray[np.float64]]) -> dict[str, object]:
    """The history by columns; None for what is no number."""
    columns = {
        name: [float(x) if math.isfinite(x) else None for x in column]
        for name, column in {**result.table(), **more}.items()
    }
    return {"names": list(columns), "columns": columns, "length": len(result)}

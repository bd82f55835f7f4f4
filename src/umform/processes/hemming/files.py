"""The files of a hem: numbers, curve, profile, fields, picture, report."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from umform.io.staging import staging
from umform.io.tables import write_csv, write_json
from umform.processes.air_bending.files import parameters
from umform.processes.air_bending.remarks import coarse_mesh
from umform.processes.hemming.measures import Hem
from umform.processes.hemming.spec import acute
from umform.report.versions import versions
from umform.results.outcome import QUANTITIES
from umform.results.quantity import FORCE_PER_LENGTH, quantities_of, values

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_DATA = ("hem.json", QUANTITIES, "curve.csv", "profile.csv", "gaps.csv", "hem.vtkhdf")
_PICTURES = ("hem.png", "hem.svg")
_PAGE = "report.html"
_DECKS = ("bend1.toml", "hem.toml")
#: Columns of the gap of flange and base.
_GAPS = ("from the tip mm", "gap under load mm", "gap released mm")
#: Files of a hem.
FILES = (*_DATA, *_DECKS, *_PICTURES, _PAGE)
#: Those, and what a run that ends early leaves.
RESULTS = (*FILES, "history.csv", "bend1.csv")


def write_files(out: str | Path, hem: Hem, note: str = "") -> list[Path]:
    """Write all files of a hem.

    Parameters
    ----------
    out : str or Path
        Folder for hem.json, quantities.csv, curve.csv, profile.csv, gaps.csv, hem.vtkhdf, hem.png, hem.svg,
        report.html, and for bend1.toml and hem.toml, the decks of its operations.
    hem : Hem
        The hem.
    note : str
        Source of the material data; may be empty.
    """
    from umform.plotting import save
    from umform.processes.hemming.page import write_page

    with staging(out, FILES) as stage:
        here = stage.waiting
        write_json(here / "hem.json", record(hem) | {"note": note})
        write_csv(here / "curve.csv", {"stroke mm": hem.stroke, f"force {FORCE_PER_LENGTH}": hem.force})
        hem.write(here)
        write_csv(here / "profile.csv", {"x": hem.profile[:, 0], "z": hem.profile[:, 1]})
        write_csv(here / "gaps.csv", dict(zip(_GAPS, np.array(hem.gaps).T, strict=True)))
        hem.result.write(here / "hem.vtkhdf")
        for name, text in hem.decks().items():
            (here / name).write_text(text, encoding="utf-8")
        files = stage.commit([*_DATA, *_DECKS])
        figure = picture(hem)
        for name in _PICTURES:
            save(figure, here / name)
        write_page(here / _PAGE, hem, figure, note)
        return [*files, *stage.commit([*_PICTURES, _PAGE])]


def record(hem: Hem) -> dict[str, Any]:
    """Parameters and results as JSON data; ``profile`` is a list of [x, z], the base on z = 0, ``gaps`` of rows."""
    case, first = hem.case, hem.first.bends[0]
    return {
        "parameters": {**hem.given, "increments": case.increments, "sheet": parameters(case.sheet)},
        "first": values(quantities_of(first.measures)),
        "measures": hem.values,
        "curve": {"stroke": hem.stroke.tolist(), "force": hem.force.tolist()},
        "closed": hem.is_closed if case.is_closed else None,
        "gaps": hem.gaps,
        "profile": np.round(hem.profile, 4).tolist(),
        **hem.record(),
        "coarse_mesh": coarse_mesh(case.sheet, acute()),
        "versions": versions(),
    }


def picture(hem: Hem) -> Figure:
    """Force over the travel of the plate, the hem after unloading, and the gap along the flange."""
    from umform.plotting import COLOURS, INK, Picture, house_style

    with house_style():
        figure = Picture(figsize=(12.6, 3.6))
        left, right, last = figure.subplots(1, 3)
        left.plot(hem.stroke, hem.force, color=COLOURS[0])
        left.set(xlabel="way of the plate in mm", ylabel=f"force in {FORCE_PER_LENGTH}", title="Force")
        right.fill(*hem.profile.T, facecolor="#d9dde2", edgecolor=INK, linewidth=0.8)
        for outline in hem.beside:
            right.fill(*outline.T, facecolor="#eef0f2", edgecolor=INK, linewidth=0.8)
        right.set_title(f"released: height {hem['height'].full_text}")
        right.set_aspect("equal")
        right.axis("off")
        s, pressed, free = np.array(hem.gaps).T
        last.plot(s, pressed, color=COLOURS[0], label="under load")
        last.plot(s, free, color=COLOURS[1], label="released")
        last.set(xlabel="distance from the tip in the flat sheet, mm", ylabel="gap in mm", title="Flange and base")
        last.legend()
    return figure

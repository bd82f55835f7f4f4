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
from umform.report.versions import versions
from umform.results.outcome import QUANTITIES
from umform.results.quantity import quantities_of, values

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_DATA = ("hem.json", QUANTITIES, "curve.csv", "profile.csv", "hem.vtkhdf")
_PICTURES = ("hem.png", "hem.svg")
_PAGE = "report.html"
_DECKS = ("bend1.toml", "hem.toml")
#: Files of a hem.
FILES = (*_DATA, *_DECKS, *_PICTURES, _PAGE)
RESULTS = FILES


def write_files(out: str | Path, hem: Hem, note: str = "") -> list[Path]:
    """Write all files of a hem.

    Parameters
    ----------
    out : str or Path
        Folder for hem.json, quantities.csv, curve.csv, profile.csv, hem.vtkhdf, hem.png, hem.svg, report.html, and for
        bend1.toml and hem.toml, the decks of its operations.
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
        write_csv(here / "curve.csv", {"stroke mm": hem.stroke, "force N/mm": hem.force})
        hem.write(here)
        write_csv(here / "profile.csv", {"x": hem.profile[:, 0], "z": hem.profile[:, 1]})
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
    """Parameters and results as JSON data; ``profile`` is a list of [x, z], the base on z = 0."""
    case, first = hem.case, hem.first.bends[0]
    given = {name: getattr(case, name) for name in ("gap", "flange", "base", "insert", "insert_edge", "angle")}
    return {
        "parameters": {**given, "increments": case.increments, "sheet": parameters(case.sheet)},
        "first": values(quantities_of(first.measures)),
        "measures": hem.values,
        "curve": {"stroke": hem.stroke.tolist(), "force": hem.force.tolist()},
        "profile": np.round(hem.profile, 4).tolist(),
        **hem.record(),
        "coarse_mesh": coarse_mesh(case.sheet),
        "versions": versions(),
    }


def picture(hem: Hem) -> Figure:
    """Force over the travel of the plate, and the hem after unloading."""
    from umform.plotting import COLOURS, INK, Picture, house_style

    with house_style():
        figure = Picture(figsize=(9.0, 3.6))
        left, right = figure.subplots(1, 2)
        left.plot(hem.stroke, hem.force, color=COLOURS[0])
        left.set(xlabel="way of the plate in mm", ylabel="force in N for each mm of the hem", title="Force")
        right.fill(*hem.profile.T, facecolor="#d9dde2", edgecolor=INK, linewidth=0.8)
        right.set_title(f"released: height {hem['height'].full_text}")
        right.set_aspect("equal")
        right.axis("off")
    return figure

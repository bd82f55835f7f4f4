"""The interactive parts of a page: shape in 3D, curves with a cursor, history as a file and a table."""

from __future__ import annotations

import json
from base64 import b64encode
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from html import escape
from importlib.resources import files
from pathlib import Path
from string import Template
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import numpy as np

from umform.io.tables import write_csv
from umform.plotting import COLOURS, history_picture, shape_picture
from umform.report import parts
from umform.report.looks import UNKNOWN, Units
from umform.report.scene import Scene, scene_of
from umform.report.symmetry import modelled_part, whole
from umform.report.words import column_text
from umform.results.leading_controls import leading_controls
from umform.results.shape import Shape

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy import float64
    from numpy.typing import NDArray

    from umform.results.history import History

_SCRIPTS = ("unpack.js", "surfaces.js", "space.js", "shape.js", "curves.js", "start.js")


@dataclass(frozen=True)
class Live:
    """The parts for one result, as text: a page may be written by another process than the result.

    Attributes
    ----------
    shape, curves, table : str
        The parts, which need all of the scripts.
    notes : tuple of str
        What could not be drawn in 3D.
    scripts : str
        Data and programs for the end of the page.
    """

    shape: str
    curves: str
    table: str
    notes: tuple[str, ...]
    scripts: str

    @classmethod
    def of(
        cls,
        result: History,
        *,
        stills: bool = True,
        more: Mapping[str, NDArray[float64]] | None = None,
        first: tuple[str, str] | None = None,
        drawn: Mapping[str, Figure] | None = None,
        units: Units = UNKNOWN,
    ) -> Live:
        """The parts for a result with a history; without kept frames, only its last state is drawn in 3D.

        Parameters
        ----------
        result : History
            The result.
        stills : bool
            Pictures of shape and curves for printing; a page that shows both may omit them.
        more : mapping of str to ndarray, optional
            Columns in addition to those of the history.
        first : tuple of str, optional
            Abscissa and ordinate of the curve that is shown at first, for a page that says itself what forces refer
            to; default: the control with the largest work, below a note on the modelled part.
        drawn : mapping of str to Figure, optional
            Pictures that have been drawn already: the whole ``shape``, and the ``curve`` of the control with the
            largest work.
        units : Units
            Names of the units, for the fields.
        """
        scene, columns = scene_of(result, units), {**result.table(), **(more or {})}
        known = drawn or {}
        shape = _shape(result, scene, stills, known.get("shape"))
        curves = _curves(result, columns, stills, first, known.get("curve"))
        return cls(shape, curves, _table(columns), tuple(scene.notes), shape_scripts(scene))


def style() -> str:
    """Style of the parts, in addition to that of all pages."""
    return _asset("run.css")


def shape_part(scene: Scene, still: str = "") -> str:
    """The 3D view of a scene, with a picture for browsers that cannot draw it."""
    options = "".join(f"<option>{escape(name)}</option>" for name in scene.fields)
    hidden = {
        "without_tools": "" if scene.tools else " hidden",
        "without_mirrors": "" if scene.mirrors else " hidden",
        "without_rolling": "" if scene.rolling else " hidden",
    }
    return _filled("shape.html", still=still, fields=options, last=str(scene.frames - 1), **hidden)


def shape_scripts(scene: Scene, names: Iterable[str] = _SCRIPTS) -> str:
    """Data and programs of a page with a scene."""
    library = b64encode(_packed_asset("three/three.min.js.gz")).decode("ascii")
    program = "\n".join(_asset(name) for name in names)
    return (
        f'<script type="application/octet-stream" id="scene">{scene.data}</script>\n'
        f'<script type="application/octet-stream" id="three">{library}</script>\n'
        f'<script type="module">\n{program}</script>'
    )


def _shape(result: History, scene: Scene, stills: bool, drawn: Figure | None) -> str:
    """The 3D view, or a still of the last state if it cannot be drawn."""
    caption = "The sheet in its last state, in true proportion" + ("; one part is modelled." if scene.mirrors else ".")
    still = ""
    if stills:
        still = parts.figure(drawn or shape_picture(whole(Shape.of(result), scene.mirrors)), caption)
    return shape_part(scene, still)


def _curves(
    result: History, columns: Iterable[str], stills: bool, first: tuple[str, str] | None, drawn: Figure | None
) -> str:
    """Curves of the history, or a still for each control; above them what their forces refer to."""
    pairs = [(control.name, f"{control.name}_force") for control in leading_controls(result)]
    known = [drawn] if pairs and drawn is not None else []
    if not pairs and result.model.controls:
        name = result.model.controls[0].name
        loaded = bool(np.ptp(result[name]))  # a load over itself says nothing; at the start nothing has moved yet
        pairs = [(name, "external_work" if loaded else f"{name}_force")]
    shown = pairs if stills else []
    figures = [*known, *(history_picture(result, x, [y]) for x, y in shown[len(known) :])]
    text = "\n".join(
        parts.figure(figure, f"{column_text(y)} over {column_text(x)}, all converged increments.")
        for figure, (x, y) in zip(figures, shown, strict=False)
    )
    x, y = first or (pairs[0] if pairs else ("time", result.columns()[-1]))
    colours = escape(json.dumps(COLOURS))
    labels = escape(json.dumps({name: column_text(name) for name in columns}))
    part = "" if first else modelled_part(result.model)
    said = parts.note(f"{part[0].upper()}{part[1:]}.") if part else ""
    return said + _filled("curves.html", still=text, x=escape(x), y=escape(y), colours=colours, labels=labels)


def _table(columns: Mapping[str, NDArray[float64]]) -> str:
    """The history as a file to download, and as a table."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "history.csv"
        write_csv(path, columns)
        csv = path.read_bytes()
    names = "".join(f"<th>{escape(name)}</th>" for name in columns)
    size = {"rows": str(len(columns["step"])), "count": str(len(columns))}
    return _filled("history.html", csv=b64encode(csv).decode("ascii"), names=names, **size)


def _asset(name: str) -> str:
    return files("umform.report").joinpath("assets", name).read_text(encoding="utf-8")


def _packed_asset(name: str) -> bytes:
    return files("umform.report").joinpath("assets", name).read_bytes()


def _filled(name: str, **values: str) -> str:
    return Template(_asset(name)).substitute(values)

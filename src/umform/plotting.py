"""Plots with matplotlib: histories and deformed shapes, as PNG, SVG or PDF; no global state is changed."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from difflib import get_close_matches
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from cycler import cycler
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.io.atomic import PendingFile
from umform.results.shape import Shape

if TYPE_CHECKING:
    from umform.results.history import History

Floats = NDArray[np.float64]

#: Colours that colour-blind readers can tell apart (Okabe & Ito).
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
INK = "#222222"
#: The colour map of fields, in all pictures of sheets.
COLOUR_MAP = mpl.colors.LinearSegmentedColormap.from_list(
    "umform", ("#e3e8ed", "#f6dfb0", "#f5b466", "#ea7b3f", "#cf3a3a", "#8e1245")
)
_LINES = ("-", "--", ":", "-.")

_STYLE: Any = {
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.titley": 1.0,  # matplotlib would reserve space above ticks, which are all below
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": "#777777",
    "axes.labelcolor": INK,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.prop_cycle": cycler(color=COLOURS),
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.7,
    "xtick.color": "#555555",
    "ytick.color": "#555555",
    "lines.linewidth": 1.4,
    "legend.frameon": False,
    "svg.hashsalt": "umform",
    "figure.autolayout": False,  # each figure defines its layout
    "figure.constrained_layout.use": False,
}

#: With more faces than this, no edges are drawn, and faces are pixels in SVG and PDF too.
_MANY = 4000
#: Dots per inch of pictures, and of pixels in SVG and PDF.
_DPI = 200
#: Formats, and how they are written: without a date; lines compress as well at a low level, in two thirds of the time.
_FILES: Any = {
    "png": {"pil_kwargs": {"compress_level": 3}},
    "svg": {"metadata": {"Date": None}},
    "pdf": {"metadata": {"CreationDate": None}},
}
#: Default fields of a shape: the first available one is shown.
_FAVOURITES = ("plastic_strain_max", "thickness_change", "displacement")
#: From where shapes are seen: azimuth and elevation in degrees.
_VIEW = (-115.0, 28.0)


@contextmanager
def house_style() -> Iterator[None]:
    """Style of umform for figures made in this block."""
    with mpl.rc_context(_STYLE):
        yield


class Plot(Figure):
    """A figure that a notebook shows, also without pyplot."""

    def _repr_png_(self) -> tuple[bytes, dict[str, int]]:
        """The picture, and its width on the screen in pixels."""
        return _drawn(self, "png", _DPI), {"width": round(100.0 * self.get_figwidth())}


class Picture(Plot):
    """A figure for several files: laid out once, and drawn once in each format and resolution.

    matplotlib would repeat the layout for each file, which doubles the time.
    """

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.drawn: dict[tuple[str, int], bytes] = {}  # by format and dots per inch

    def savefig(self, *args: Any, **kwargs: Any) -> None:
        """Write the picture as `Figure` does, with the first layout."""
        engine = self.get_layout_engine()
        if engine is not None:
            engine.execute(self)
            self.set_layout_engine(None)
        super().savefig(*args, **kwargs)


def frame(figure: Figure, *, left: float = 0.8, right: float = 0.15, bottom: float = 0.5, top: float = 0.35) -> None:
    """Place axes by margins in inches: to find room for their labels takes matplotlib as long as to draw them."""
    width, height = figure.get_size_inches()
    figure.subplots_adjust(left / width, bottom / height, 1.0 - right / width, 1.0 - top / height)


def save(figure: Figure, path: str | Path, dpi: int = _DPI) -> Path:
    """Write a figure as PNG (with a resolution in dots per inch), SVG or PDF, atomically."""
    path = Path(path)
    if path.suffix[1:] not in _FILES:
        raise InvalidValue(
            "a picture is saved as PNG, SVG or PDF",
            where="picture",
            value=str(path),
            cause="the end of the name says which",
            remedy="end it in .png or .svg",
        )
    with PendingFile(path) as temporary:
        temporary.write_bytes(_drawn(figure, path.suffix[1:], dpi))
    return path


def _saved(figure: Figure, path: str | Path | None) -> Figure:
    if path is not None:
        save(figure, path)
    return figure


def _drawn(figure: Figure, kind: str, dpi: int) -> bytes:
    """The figure as a file without a date; a picture is drawn once."""
    known = figure.drawn if isinstance(figure, Picture) else {}
    if (kind, dpi) not in known:
        file = io.BytesIO()
        with house_style():
            figure.savefig(file, format=kind, dpi=dpi, **_FILES[kind])
        known[kind, dpi] = file.getvalue()
    return known[kind, dpi]


def inline_svg(figure: Figure) -> str:
    """The figure as an <svg> element for an HTML page: no prologue, no metadata, no links."""
    svg = _drawn(figure, "svg", _DPI).decode("utf-8")
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r"<metadata>.*?</metadata>\s*", "", svg, flags=re.DOTALL)
    return re.sub(r' xmlns(:\w+)?="[^"]*"', "", svg)


def plot_history(result: History, x: str, ys: Sequence[str], path: str | Path | None = None) -> Figure:
    """Draw columns of a history against each other.

    Parameters
    ----------
    result : History
        A result.
    x : str
        Column of the abscissa.
    ys : sequence of str
        Columns of the ordinate.
    path : str or Path, optional
        Where to save the picture: .png, .svg or .pdf.
    """
    return _saved(_history(Plot, result, x, ys), path)


def history_picture(result: History, x: str, ys: Sequence[str]) -> Figure:
    """The figure of :func:`plot_history` for several files."""
    return _history(Picture, result, x, ys)


def _history(kind: type[Figure], result: History, x: str, ys: Sequence[str]) -> Figure:
    with house_style():
        figure = kind(figsize=(6.2, 3.8), layout="constrained")
        axes = figure.add_subplot()
        for name in _columns(ys):
            axes.plot(result[x], result[name], label=name)
        axes.set_xlabel(x)
        if len(ys) == 1:
            axes.set_ylabel(ys[0])
        else:
            axes.legend()
    return figure


def compare_histories(
    histories: Mapping[str, Mapping[str, Floats]], x: str, ys: Sequence[str], path: str | Path | None = None
) -> Figure:
    """Draw columns of the histories of several runs into one picture.

    Parameters
    ----------
    histories : mapping of str to mapping
        Name of each run, and its columns: ``result.table()``, or what :func:`umform.io.histories.read_history` reads.
    x : str
        Column of the abscissa.
    ys : sequence of str
        Columns of the ordinate; colours show runs, line styles show columns.
    path : str or Path, optional
        Where to save the picture: .png, .svg or .pdf.

    Raises
    ------
    InvalidValue
        If there is no run or no column, or a run has no such column.
    """
    if not histories:
        raise InvalidValue("there are no histories to compare", where="histories", remedy="read_histories([...])")
    ys = _columns(ys)
    for run, columns in histories.items():
        for name in (x, *ys):
            _check_column(name, columns, run)
    with house_style():
        figure = Plot(figsize=(6.6, 4.2), layout="constrained")
        axes = figure.add_subplot()
        for (run, columns), colour in zip(histories.items(), cycle(COLOURS)):
            for name, line in zip(ys, cycle(_LINES)):
                label = run if len(ys) == 1 else f"{run}: {name}"
                axes.plot(columns[x], columns[name], line, color=colour, label=label)
        axes.set_xlabel(x)
        axes.set_ylabel(ys[0] if len(ys) == 1 else "")
        axes.legend()
    return _saved(figure, path)


def _columns(ys: Sequence[str]) -> Sequence[str]:
    """Columns of the ordinate, if they are a list with an entry."""
    if isinstance(ys, str) or not ys:
        raise InvalidValue(
            "the columns of the ordinate are a list of names",
            where="ys",
            value=ys,
            cause="a name without a list, or an empty list",
            remedy='["punch_force"]',
        )
    return ys


def _check_column(name: str, columns: Mapping[str, Floats], run: str) -> None:
    """Reject a column that a history does not have, and name the most similar one."""
    if name in columns:
        return
    near = get_close_matches(name, columns, n=1, cutoff=0.4)
    raise InvalidValue(
        "the history has no such column",
        where=f"run {run}",
        value=name,
        cause=f"perhaps {near[0]} is meant" if near else "",
        remedy="one of " + ", ".join(columns),
    )


def plot_shape(
    shape: Shape | History,
    values: str | None = None,
    path: str | Path | None = None,
    *,
    view: tuple[float, float] = _VIEW,
) -> Figure:
    """Picture of the deformed sheet, coloured by a field.

    Parameters
    ----------
    shape : Shape or History
        What to draw; for a result, the last frame.
    values : str, optional
        Scalar field, such as plastic_strain_max or thickness_change; default: the first available of these.
    path : str or Path, optional
        Where to save the picture: .png, .svg or .pdf.
    view : tuple of float
        Azimuth and elevation of the observer in degrees; (-90, 0) looks along y and shows x and z.
    """
    return _saved(_shape(Plot, shape if isinstance(shape, Shape) else Shape.of(shape), values, view), path)


def shape_picture(shape: Shape) -> Figure:
    """The figure of :func:`plot_shape` for several files."""
    return _shape(Picture, shape, None, _VIEW)


def _shape(kind: type[Figure], shape: Shape, values: str | None, view: tuple[float, float]) -> Figure:
    values = values or next((name for name in _FAVOURITES if name in shape.values), None)
    with house_style():
        figure = kind(figsize=(7.2, 3.2), layout="compressed")
        drawn = draw_shape(figure.add_subplot(), shape, values, view)
        if values is not None:
            bar = figure.colorbar(drawn, ax=figure.axes, shrink=0.7, aspect=25, pad=0.02)
            bar.set_label(values.replace("_", " "))
            bar.outline.set_visible(False)
    return figure


def draw_shape(
    axes: Axes,
    shape: Shape,
    values: str | None,
    view: tuple[float, float],
    limits: tuple[float, float] | None = None,
) -> PolyCollection:
    """Draw the visible faces into axes, the near ones last; returns the data of a colour bar."""
    if values is not None and values not in shape.values:
        raise InvalidValue("the shape has no such field", value=values, remedy=f"one of {', '.join(shape.values)}")
    towards, across, up = camera(*view)
    corners = shape.points[shape.quads]
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    seen = np.flatnonzero(normals @ towards > 0.0)
    depth = corners[seen].mean(axis=1) @ towards
    seen = seen[np.argsort(depth, kind="stable")]
    flat: Any = corners[seen] @ np.stack([across, up], axis=1)
    many = len(flat) > _MANY
    edges = "face" if many else "#33333388"
    faces = PolyCollection(flat, edgecolors=edges, linewidths=0.25, rasterized=many)
    if values is None:
        faces.set_facecolor("#b8c4d0")
    else:
        faces.set_array(shape.values[values][seen])
        faces.set_cmap(COLOUR_MAP)
        if limits is not None:
            faces.set_clim(*limits)
    axes.add_collection(faces)
    axes.autoscale_view()
    axes.set_aspect("equal")
    axes.axis("off")
    return faces


def camera(azimuth: float, elevation: float) -> tuple[Floats, Floats, Floats]:
    """Unit vectors towards the observer, to the right and upwards in the picture."""
    a, e = np.radians(azimuth), np.radians(elevation)
    towards = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    across = np.array([-np.sin(a), np.cos(a), 0.0])
    return towards, across, np.cross(towards, across)

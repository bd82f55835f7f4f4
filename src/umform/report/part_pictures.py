"""Pictures of what is measured of a part: sections, outline, ears, forces, colour maps, part in its gauge."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from umform.plotting import COLOURS, INK, Picture, draw_shape, frame, house_style
from umform.results.forming import EarProfile, Laid, Outline, Section
from umform.results.shape import Shape

Floats = NDArray[np.float64]

_SIZE = (6.6, 4.2)
#: Of a legend.
_COLUMNS = 4
_VIEW = (-70.0, -25.0)
#: Least range of the heights of a cup in a picture, relative to the mean: waves of the mesh are no ears.
_LEAST = 0.05


def section_picture(
    cuts: Mapping[str, Section],
    along: Floats,
    unit: str = "mm",
    *,
    points: Floats | None = None,
    measured: str = "points of the wall",
    title: str = "",
) -> Figure:
    """One section in several states: both skins, the last state as full lines.

    Parameters
    ----------
    cuts : mapping of str to Section
        The states by their names.
    along : ndarray, shape (3,)
        Horizontal direction in the plane of the section.
    unit : str
        Of length.
    points : ndarray, shape (n, 2), optional
        Measured points, drawn as dots.
    measured : str
        What they are.
    title : str
        Numbers, above the picture.
    """
    skins = np.concatenate([skin for cut in cuts.values() for skin in (cut.lower, cut.upper)])
    flat = float(np.ptp(skins[:, 2]) / np.ptp(skins @ along))
    with house_style():
        figure, axes = _axes(of_unit(_name(along), unit), of_unit("z", unit), min(max(5.6 * flat + 1.3, 2.4), _SIZE[1]))
        for number, ((name, cut), colour) in enumerate(zip(cuts.items(), COLOURS, strict=False), 1):
            for label, skin in ((name, cut.lower), ("", cut.upper)):
                line = "-" if number == len(cuts) else "--"
                shown = np.insert(skin, np.flatnonzero(cut.gaps) + 1, np.nan, axis=0)  # nothing over a hole
                axes.plot(shown @ along, shown[:, 2], line, color=colour, label=label or None)
        if points is not None:
            axes.plot(*points.T, "o", color=INK, markersize=4, label=measured)
        axes.set_title(title)
        axes.set_aspect("equal")
        _legend_below(figure)
    return figure


def outline_picture(edge: Outline, unit: str = "mm", *, equal: bool = True, error: float = 0.0) -> Figure:
    """An edge of the blank before, and in the part with the band of its draw-in.

    The scales are equal unless the edge is nearly straight.
    """
    way = edge.before - edge.after
    band = error * way / np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-12)
    with house_style():
        figure, axes = _axes(of_unit("x", unit), of_unit("y", unit))
        for label, points, line, colour in (
            ("blank", edge.before, "--", "C0"),
            ("end of the stroke", edge.after, "-", "C1"),
        ):
            for k, piece in enumerate(edge.pieces):
                around = points[np.append(piece, piece[0]) if edge.closed[k] else piece]
                named = None if k else label
                axes.plot(*around.T, line, marker=".", markersize=3, color=colour, label=named)
        for piece in edge.pieces if error > 0.0 else ():
            ring = np.concatenate([(edge.after + band)[piece], (edge.after - band)[piece[::-1]]])
            axes.fill(*ring.T, color="C1", alpha=0.2, linewidth=0)
        if equal:
            axes.set_aspect("equal")
        _legend_below(figure)
    return figure


def ears_picture(ears: EarProfile, unit: str = "mm", *, zero: str = "the x-axis", error: float = 0.0) -> Figure:
    """Height of a cup over the angle to a direction with its band, its mean, and how many ears it has."""
    whole = ears.whole()
    with house_style():
        figure, axes = _axes(f"angle to {zero} in degrees", of_unit("height of the cup", unit))
        around, height = np.append(whole.angle, whole.angle[0] + 360.0), np.append(whole.height, whole.height[0])
        (line,) = axes.plot(around, height, label="rim")
        shade(axes, around, height, np.full(len(height), error), line.get_color())
        axes.axhline(ears.mean, color=INK, linewidth=0.8, linestyle=":", label=f"mean {ears.mean:.4g}")
        axes.set_title(ears.words(unit))
        axes.set_xticks(np.arange(0, 361, 45))
        least = 0.5 * _LEAST * abs(ears.mean)
        low, high = axes.get_ylim()
        axes.set_ylim(min(low, ears.mean - least), max(high, ears.mean + least))
        _legend_below(figure)
    return figure


def forces_picture(
    way: Floats, forces: Mapping[str, Floats], x: str, y: str, errors: Mapping[str, float] | None = None
) -> Figure:
    """Forces of the tools, by their names, over a travel; relative errors, by the same names, are shaded."""
    with house_style():
        figure, axes = _axes(x, y)
        for name, force in forces.items():
            (line,) = axes.plot(way, force, label=name)
            shade(axes, way, force, (errors or {}).get(name, 0.0) * np.abs(force), line.get_color())
        axes.set_ylim(0.0, None)
        _legend_below(figure)
    return figure


def shade(axes: Axes, x: Floats, y: Floats, error: Floats, colour: Any) -> None:
    """Shade the band of a curve; without an error, nothing."""
    if np.isfinite(error).all() and error.max(initial=0.0) > 0.0:
        axes.fill_between(x, y - error, y + error, color=colour, alpha=0.2, linewidth=0)


def thinning_picture(cut: Section, thickness: float, error: float = 0.0, unit: str = "mm") -> Figure:
    """Thinning along a section, over the way along the undeformed one, with its band.

    Parameters
    ----------
    cut : Section
        The section in the part.
    thickness : float
        Thickness of the undeformed sheet.
    error : float
        Error of the thinning in per cent.
    unit : str
        Of length.
    """
    with house_style():
        figure, axes = _axes(of_unit("way along the blank", unit), "thinning in %")
        thinning = 100.0 * (1.0 - np.linalg.norm(cut.upper - cut.lower, axis=1) / thickness)
        (line,) = axes.plot(cut.s, thinning)
        shade(axes, cut.s, thinning, np.full(len(thinning), error), line.get_color())
        axes.axhline(0.0, color=INK, linewidth=0.8)
        frame(figure)
    return figure


def coloured(shape: Shape, name: str, label: str, limits: tuple[float, float] | None = None) -> Figure:
    """The part, coloured by a field."""
    with house_style():
        figure = Picture(figsize=_SIZE)
        drawn = draw_shape(figure.add_subplot(), shape, name, _VIEW, limits)
        _bar(figure, drawn, label)
    return figure


def gauge_picture(laid: Mapping[str, Laid], shape: Shape, unit: str = "mm") -> Figure:
    """A part in its gauge, coloured by the distance from it, for each way of laying it.

    Parameters
    ----------
    laid : mapping of str to Laid
        The part laid in several ways, by their names; its points are those of the shape.
    shape : Shape
        Faces of the part.
    unit : str
        Of length.
    """
    with house_style():
        figure = Picture(figsize=(4.3 * len(laid) + (2.3 if len(laid) == 1 else 0.0), 3.8))
        limits = (0.0, max(one.largest for one in laid.values()))
        for axes, (name, one) in zip(figure.subplots(1, len(laid), squeeze=False)[0], laid.items(), strict=True):
            values = {"distance": one.distance[shape.quads].mean(axis=1)}
            shown = draw_shape(axes, Shape(one.points, shape.quads, values), "distance", _VIEW, limits)
            axes.set_title(f"{name}: up to {one.largest:.3g}{unit and ' ' + unit}")
        _bar(figure, shown, of_unit("distance from the gauge", unit))
    return figure


def of_unit(name: str, unit: str) -> str:
    """A label with its unit; a unit that is not known is left out."""
    return f"{name} in {unit}" if unit else name


def _name(along: Floats) -> str:
    """Name of a horizontal direction."""
    axis = int(np.argmax(np.abs(along)))
    return "xyz"[axis] if abs(along[axis]) > 1.0 - 1e-9 else "way along the section"


def _axes(x: str, y: str, height: float = _SIZE[1]) -> tuple[Figure, Axes]:
    figure = Picture(figsize=(_SIZE[0], height))
    axes = figure.add_subplot()
    axes.set(xlabel=x, ylabel=y)
    return figure, axes


def _legend_below(figure: Figure) -> None:
    """A legend below the axes: it covers no curve."""
    legend = figure.legend(loc="lower center", ncols=_COLUMNS)
    frame(figure, bottom=0.55 + 0.2 * -(-len(legend.get_texts()) // _COLUMNS))


def _bar(figure: Figure, drawn: object, label: str) -> None:
    """A bar of colours to the right of all axes, which have no labels."""
    frame(figure, left=0.1, right=1.2, bottom=0.1)
    width = figure.get_size_inches()[0]
    place = figure.add_axes((1.0 - 1.05 / width, 0.14, 0.12 / width, 0.66))
    bar = figure.colorbar(drawn, cax=place)  # type: ignore[arg-type]
    bar.set_label(label)
    bar.outline.set_visible(False)

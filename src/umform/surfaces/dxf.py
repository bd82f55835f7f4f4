"""Lines and arcs of a DXF drawing: read and written."""

from __future__ import annotations

import importlib
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from umform.errors import FileProblem, InvalidValue, OpenSection
from umform.io.atomic import PendingFile
from umform.surfaces.biarcs import Curve, as_arcs
from umform.surfaces.directions import Point2, pair
from umform.surfaces.segments import Arc, Floats, Line, Segment

#: Entities that may accompany the section and are ignored.
_IGNORED = {"TEXT", "MTEXT", "DIMENSION", "LEADER", "MULTILEADER", "MLEADER", "POINT", "HATCH", "ATTDEF", "VIEWPORT"}
#: Numbers in the header of a drawing by the names of its units, and a millimetre in each of them.
UNITS = {"in": 1, "ft": 2, "mm": 4, "cm": 5, "m": 6, "um": 13}
MILLIMETRE = {"in": 1.0 / 25.4, "ft": 1.0 / 304.8, "mm": 1.0, "cm": 0.1, "m": 1e-3, "um": 1e3}
#: Largest distance in mm of arcs from the curves in their place, and of ends that are one point, where none is given.
_TOLERANCE = 1e-3
#: A direction normal to the drawing plane.
_UPRIGHT = 1e-9
#: Parts of the span of a spline: from a knot at which its derivative is taken, for differences where that vanishes.
_INSIDE, _STEP = 1e-9, 1e-4


def read_dxf(
    path: str | Path, layer: str | None, unit: str, tolerance: float | None = None
) -> tuple[list[Segment], float]:
    """Lines and arcs of the model space of a drawing, and the tolerance.

    Parameters
    ----------
    path : str or Path
        The drawing.
    layer : str, optional
        The only layer that is read, case-insensitive.
    unit : str
        Unit of the result: mm, cm, m, um, in or ft; a drawing without a unit is taken as it is.
    tolerance : float, optional
        Largest distance of the arcs from ellipses and splines, in this unit; by default 0.001 mm.

    Raises
    ------
    FileProblem
        If the file cannot be read.
    InvalidValue
        If there is no such layer, or no such unit.
    OpenSection
        If it contains an entity that is not a plane curve.
    """
    ezdxf = dxf_library("reading", "from_dxf")
    path = Path(path)
    check_unit(unit, "from_dxf")
    entities, number = _drawn(path)
    factor = ezdxf.units.conversion_factor(number, UNITS[unit]) if number else 1.0
    chosen = [entity for entity, own in entities if layer is None or own.lower() == layer.lower()]
    if not chosen and layer is not None:
        raise InvalidValue(
            "there is nothing on this layer",
            where=str(path),
            value=layer,
            cause="another name, or the section in a paper space",
            remedy="layers with something on them: " + ", ".join(sorted({own for _, own in entities})),
        )
    if tolerance is None:
        tolerance = _TOLERANCE * MILLIMETRE[unit]
    segments = [s for entity in chosen for s in _segments(entity, tolerance / factor, str(path))]
    return [_scaled(segment, factor) for segment in segments], tolerance


def check_unit(unit: str, where: str) -> None:
    """Refuse a unit of length that drawings do not know."""
    if unit not in UNITS:
        raise InvalidValue(
            "a unit is one of " + ", ".join(UNITS),
            where=where,
            value=unit,
            cause="another name of the unit",
            remedy="the unit of the model: unit='mm'",
        )


def layers_and_unit(path: str | Path) -> tuple[list[str], str]:
    """Layers of the model space of a drawing, and its unit: one of mm, cm, m, um, in, ft, "" if it does not say it.

    Raises
    ------
    FileProblem
        If the file cannot be read.
    """
    entities, number = _drawn(Path(path))
    units = {value: name for name, value in UNITS.items()}
    unit = units.get(number, f"number {number}") if number else ""
    return sorted({layer for _, layer in entities}), unit


def write_dxf(path: str | Path, layers: Mapping[str, Sequence[Segment]], unit: str = "mm") -> Path:
    """Write lines and arcs as they are.

    Parameters
    ----------
    path : str or Path
        The drawing.
    layers : mapping of str to sequence of Line or Arc
        What lies on each layer.
    unit : str
        Their unit, which the drawing names.

    Raises
    ------
    FileProblem
        If ezdxf is not installed, or the file cannot be written.
    """
    drawing = dxf_library("writing", "write_tool").new()
    drawing.units = UNITS[unit]
    space = drawing.modelspace()
    for layer, segments in layers.items():
        drawing.layers.add(layer)
        for segment in segments:
            _draw(space, segment, {"layer": layer})
    with PendingFile(path) as temporary:
        drawing.saveas(temporary)
    return Path(path)


def _draw(space: Any, segment: Segment, attributes: dict[str, str]) -> None:
    if isinstance(segment, Line):
        space.add_line(segment.start, segment.end, dxfattribs=attributes)
    elif segment.start == segment.end:
        space.add_circle(segment.centre, segment.radius, dxfattribs=attributes)
    else:
        centre = np.array(segment.centre)
        first, last = (
            math.degrees(math.atan2(*reversed(np.subtract(end, centre)))) for end in (segment.start, segment.end)
        )
        ways = {"is_counter_clockwise": not segment.clockwise, "dxfattribs": attributes}
        space.add_arc(segment.centre, segment.radius, first, last, **ways)


def _drawn(path: Path) -> tuple[list[tuple[Any, str]], int]:
    """Entities of the model space with their layers, and the number of the unit."""
    ezdxf = dxf_library("reading", "from_dxf")
    try:
        drawing = ezdxf.readfile(str(path))
        return list(_flat(drawing.modelspace())), drawing.units
    except Exception as error:  # ezdxf lets many kinds through on a broken file
        missing, why = not path.exists(), getattr(error, "strerror", None) or str(error)
        raise FileProblem(
            "there is no such file" if missing else "this is no DXF drawing that can be read",
            where=str(path),
            cause="another name or folder" if missing else " ".join(why.split()),
            remedy="give the path of a DXF file" if missing else "save it as DXF (text or binary) again, not as DWG",
        ) from error


def dxf_library(what: str, where: str) -> Any:
    """The module ezdxf, for reading or writing.

    Raises
    ------
    FileProblem
        If it is not installed.
    """
    try:
        importlib.import_module("ezdxf.units")
        return importlib.import_module("ezdxf")
    except ImportError as error:
        raise FileProblem(
            f"{what} DXF drawings needs ezdxf",
            where=where,
            cause=str(error),
            remedy='pip install "umform[cad]"',
        ) from error


def _flat(entities: Iterable[Any], outer: str | None = None) -> Iterator[tuple[Any, str]]:
    """Entities with their layers, those of blocks and polylines among them.

    What lies on the layer 0 of a block is on the layer of its reference.
    """
    for entity in entities:
        kind, layer = entity.dxftype(), str(entity.dxf.layer)
        layer = outer if layer == "0" and outer is not None else layer
        if kind == "INSERT":
            for one in entity.multi_insert():
                yield from _flat(one.virtual_entities(), layer)
        elif kind == "LWPOLYLINE" or (kind == "POLYLINE" and (entity.is_2d_polyline or entity.is_3d_polyline)):
            if kind == "POLYLINE":
                entity.vertices[:] = [
                    one for one in entity.vertices if not one.dxf.flags & one.SPLINE_FRAME_CONTROL_POINT
                ]
            yield from ((piece, layer) for piece in entity.virtual_entities())
        else:
            yield entity, layer


def _segments(entity: Any, curve_error: float, where: str) -> list[Segment]:
    """Lines and arcs of one entity."""
    try:
        return [] if entity.dxftype() in _IGNORED else _converted(entity, curve_error, where)
    except ValueError as error:  # of ezdxf, such as a spline with too few knots
        raise FileProblem(
            f"this {entity.dxftype().lower()} of the drawing is broken",
            where=where,
            value=f"on the layer {entity.dxf.layer}",
            cause=" ".join(str(error).split()),
            remedy="draw it again, or put the section on a layer of its own and name it",
        ) from error


def _converted(entity: Any, curve_error: float, where: str) -> list[Segment]:
    """Lines and arcs of an entity that a section may have."""
    kind = entity.dxftype()
    if kind == "LINE":
        start, end = pair(entity.dxf.start), pair(entity.dxf.end)
        _check_level([entity.dxf.start, entity.dxf.end], curve_error, kind, where)
        return [Line(start, end)] if start != end else []
    if kind in ("ARC", "CIRCLE", "ELLIPSE") and abs(abs(entity.dxf.extrusion[2]) - 1.0) > _UPRIGHT:
        _refuse_space(kind, f"its normal is {tuple(entity.dxf.extrusion)}", where)
    if kind == "CIRCLE" or (kind == "ARC" and (entity.dxf.end_angle - entity.dxf.start_angle) % 360.0 == 0.0):
        centre = pair(entity.ocs().to_wcs(entity.dxf.center))
        start = (centre[0] + entity.dxf.radius, centre[1])
        return [Arc(start, start, centre)]
    if kind == "ARC":
        centre = pair(entity.ocs().to_wcs(entity.dxf.center))
        return [_arc(pair(entity.start_point), pair(entity.end_point), centre, entity.dxf.extrusion[2] < 0.0)]
    if kind == "SPLINE":
        spline = entity.construction_tool()
        _check_level(spline.control_points, curve_error, kind, where)
        return _of_spline(spline, curve_error)
    if kind == "ELLIPSE":
        return _of_ellipse(entity, curve_error)
    raise OpenSection(
        "only lines, arcs, circles, polylines, ellipses and splines can be a section",
        where=where,
        value=f"{kind} on the layer {entity.dxf.layer}",
        cause="a solid, a mesh or a picture in the drawing",
        remedy="put the section on a layer of its own and name it",
    )


def _check_level(points: Iterable[Any], most: float, kind: str, where: str) -> None:
    """Refuse points of one entity at other heights over the drawing plane."""
    heights = [float(point[2]) for point in points]
    if max(heights) - min(heights) > most:
        _refuse_space(kind, f"from z = {min(heights):.6g} to z = {max(heights):.6g}", where)


def _refuse_space(kind: str, value: str, where: str) -> None:
    raise OpenSection(
        f"this {kind.lower()} does not lie in the plane of the drawing",
        where=where,
        value=value,
        cause="a drawing in space",
        remedy="draw the section in the xy-plane",
    )


def _arc(start: Point2, end: Point2, centre: Point2, clockwise: bool) -> Arc:
    """Move its centre so that both ends have exactly the same distance."""
    p, q, c = np.array(start), np.array(end), np.array(centre)
    d = q - p
    c = c - ((c - 0.5 * (p + q)) @ d) / (d @ d) * d if d.any() else c
    return Arc(start, end, pair(c), clockwise)


def _of_spline(spline: Any, curve_error: float) -> list[Segment]:
    """Split at the knots, where the curvature of a cubic spline has a kink, or the spline itself."""
    low, high = spline.knots()[spline.order - 1], spline.knots()[spline.count]
    knots = sorted({float(t) for t in spline.knots() if low <= t <= high})
    spans = [as_arcs(_span(spline, a, b), [a, b], curve_error) for a, b in pairwise(knots)]
    return [segment for span in spans for segment in span]


def _span(spline: Any, a: float, b: float) -> Curve:
    """A spline between two knots, where it is smooth; its derivatives at them are those inside."""

    def place(t: float) -> Floats:
        return np.array(pair(spline.point(t)))

    size = math.dist(place(a), place(b)) or math.dist(place(a), place(0.5 * (a + b)))

    def at(t: float) -> tuple[Floats, Floats]:
        inside = min(max(t, a + _INSIDE * (b - a)), b - _INSIDE * (b - a))
        d = np.array(pair(spline.derivative(inside, 1)[1]))
        if float(np.hypot(*d)) * (b - a) < 1e-6 * size:  # control points that coincide
            h = _STEP * (b - a)
            d = place(min(t + h, b)) - place(max(t - h, a))
        return place(t), d

    return at


def _of_ellipse(entity: Any, curve_error: float) -> list[Segment]:
    centre, major, minor = (np.array(pair(v)) for v in (entity.dxf.center, entity.dxf.major_axis, entity.minor_axis))
    first, last = float(entity.dxf.start_param), float(entity.dxf.end_param)
    last += 2.0 * math.pi if last <= first else 0.0

    def at(t: float) -> tuple[Floats, Floats]:
        return centre + math.cos(t) * major + math.sin(t) * minor, math.cos(t) * minor - math.sin(t) * major

    curve: Curve = at
    return as_arcs(curve, [float(t) for t in np.linspace(first, last, 5)], curve_error)


def _scaled(segment: Segment, factor: float) -> Segment:
    def scaled(p: Point2) -> Point2:
        return factor * p[0], factor * p[1]

    if isinstance(segment, Line):
        return Line(scaled(segment.start), scaled(segment.end))
    return Arc(scaled(segment.start), scaled(segment.end), scaled(segment.centre), segment.clockwise)

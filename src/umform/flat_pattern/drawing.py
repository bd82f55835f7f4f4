"""The flat pattern as DXF, each kind of thing on a layer of its own, and as SVG to look at."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import NDArray

from umform.flat_pattern.contour import Contour
from umform.flat_pattern.pattern import FlatBend, FlatPattern
from umform.surfaces.dxf import dxf_library
from umform.surfaces.segments import Arc, Line

Floats = NDArray[np.float64]

#: Layers of the DXF file with their colours by the AutoCAD index.
LAYERS = {"CONTOUR": 7, "HOLES": 5, "BEND_UP": 1, "BEND_DOWN": 3, "BEND_TEXT": 2}


def write_dxf(path: Path, pattern: FlatPattern) -> None:
    """Write the drawing in mm, AutoCAD 2010.

    Raises
    ------
    FileProblem
        If ezdxf is not installed.
    """
    ezdxf = dxf_library("writing", str(path))
    drawing = ezdxf.new("R2010", setup=["linetypes"])
    drawing.units = 4  # mm
    for name, colour in LAYERS.items():
        drawing.layers.add(name, color=colour, linetype="DASHED" if name in ("BEND_UP", "BEND_DOWN") else "CONTINUOUS")
    space = drawing.modelspace()
    for contour, layer in ((pattern.outer, "CONTOUR"), *((hole, "HOLES") for hole in pattern.holes)):
        _add(space, contour, layer)
    for bend in pattern.bends:
        for a, b in bend.lines:
            space.add_line(a, b, dxfattribs={"layer": f"BEND_{bend.direction.upper()}"})
        text = space.add_text(
            bend_text(pattern, bend),
            height=text_height(pattern),
            rotation=_upright(bend),
            dxfattribs={"layer": "BEND_TEXT"},
        )
        text.set_placement(_label(pattern, bend), align=ezdxf.enums.TextEntityAlignment.BOTTOM_CENTER)
    drawing.saveas(path)


def _add(space: Any, contour: Contour, layer: str) -> None:
    attributes = {"layer": layer}
    if contour.circle is not None:
        space.add_circle(contour.circle.centre, contour.circle.radius, dxfattribs=attributes)
        return
    corners = []
    for segment in contour.segments:
        bulge = 0.0
        if isinstance(segment, Arc):
            bulge = segment.turn * math.tan(0.25 * segment.angle)
        corners.append((*segment.start, bulge))
    space.add_lwpolyline(corners, format="xyb", close=True, dxfattribs=attributes)


def bend_text(pattern: FlatPattern, bend: FlatBend) -> str:
    """Order number, direction, angle by which the sheet is bent, and inside radius."""
    place = pattern.order.index(bend.number) + 1 if bend.number in pattern.order else None
    order = f"{place}: " if place is not None else ""
    return f"{order}{bend.direction} {bend.angle:.4g}%%d R{bend.allowance.radius:.3g}"


def text_height(pattern: FlatPattern) -> float:
    """Height of the texts in mm."""
    return float(np.clip(0.02 * pattern.size.max(), 1.0, 5.0))


def _upright(bend: FlatBend) -> float:
    angle = math.degrees(math.atan2(bend.along[1], bend.along[0])) % 180.0
    return angle - 180.0 if angle > 90.0 + 1e-6 else angle


def _label(pattern: FlatPattern, bend: FlatBend) -> tuple[float, float]:
    """Middle of the longest part of the line, a little above it."""
    a, b = max(bend.lines, key=lambda line: float(np.linalg.norm(line[1] - line[0])))
    turn = math.radians(_upright(bend))
    x = 0.5 * (a + b) + 0.3 * text_height(pattern) * np.array([-math.sin(turn), math.cos(turn)])
    return float(x[0]), float(x[1])


def svg(pattern: FlatPattern) -> str:
    """The pattern as SVG with its length and width; bends up are drawn in red, bends down in green."""
    x = pattern.outer.points()
    low, high = x.min(axis=0), x.max(axis=0)
    size = text_height(pattern)
    edge = 0.05 * float((high - low).max()) + 3.0 * size
    width, height = (high - low + 2.0 * edge).tolist()
    rows = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{low[0] - edge:.3f} {-high[1] - edge:.3f} {width:.3f} '
        f'{height:.3f}" role="img"><title>Flat pattern of {escape(pattern.path.name)}</title>',
        f'<path d="{" ".join(_path(one) for one in (pattern.outer, *pattern.holes))}" fill="#d9dde2" '
        f'fill-rule="evenodd" stroke="#222222" stroke-width="{0.1 * size:.3f}"/>',
    ]
    for bend in pattern.bends:
        colour = "#b3261e" if bend.direction == "up" else "#1b6e3c"
        for a, b in bend.lines:
            rows.append(
                f'<line x1="{a[0]:.4f}" y1="{-a[1]:.4f}" x2="{b[0]:.4f}" y2="{-b[1]:.4f}" stroke="{colour}" '
                f'stroke-width="{0.12 * size:.3f}" stroke-dasharray="{size:.3f} {0.5 * size:.3f}"/>'
            )
        at = _label(pattern, bend)
        text = escape(bend_text(pattern, bend).replace("%%d", "°"))
        rows.append(
            f'<text x="{at[0]:.3f}" y="{-at[1]:.3f}" font-size="{size:.3f}" font-family="sans-serif" '
            f'text-anchor="middle" fill="{colour}" transform="rotate({-_upright(bend):.3f} {at[0]:.3f} {-at[1]:.3f})">'
            f"{text}</text>"
        )
    return "\n".join([*rows, *_dimensions(low, high, size), "</svg>", ""])


def _dimensions(low: Floats, high: Floats, size: float) -> list[str]:
    """Length below and width to the left of the pattern, with their lines."""
    (x0, y0), (x1, y1), away = low.tolist(), high.tolist(), 2.0 * size
    pen = f'stroke="#56616c" stroke-width="{0.06 * size:.3f}"'
    rows = []
    for length, ax, ay, bx, by in ((x1 - x0, x0, y0 - away, x1, y0 - away), (y1 - y0, x0 - away, y0, x0 - away, y1)):
        upright = ax == bx
        dx, dy = (0.4 * size, 0.0) if upright else (0.0, 0.4 * size)
        for px, py in ((ax, ay), (bx, by)):
            rows.append(f'<line x1="{px - dx:.4f}" y1="{-py - dy:.4f}" x2="{px + dx:.4f}" y2="{-py + dy:.4f}" {pen}/>')
        x, y = 0.5 * (ax + bx), -0.5 * (ay + by)
        turn = f' transform="rotate(-90 {x:.3f} {y:.3f})"' if upright else ""
        shift = -0.35 * size if upright else 1.15 * size
        rows += [
            f'<line x1="{ax:.4f}" y1="{-ay:.4f}" x2="{bx:.4f}" y2="{-by:.4f}" {pen}/>',
            f'<text class="dimension" x="{x:.3f}" y="{y + shift:.3f}" font-size="{size:.3f}" font-family="sans-serif" '
            f'text-anchor="middle" fill="#56616c"{turn}>{length:.2f}</text>',
        ]
    return rows


def _path(contour: Contour) -> str:
    words = [f"M {contour.segments[0].start[0]:.4f} {-contour.segments[0].start[1]:.4f}"]
    for segment in contour.segments:
        for part in [segment] if isinstance(segment, Line) else _halves(segment):
            end = f"{part.end[0]:.4f} {-part.end[1]:.4f}"
            if isinstance(part, Arc):
                words.append(f"A {part.radius:.4f} {part.radius:.4f} 0 0 {int(part.clockwise)} {end}")
            else:
                words.append(f"L {end}")
    return " ".join([*words, "Z"])


def _halves(arc: Arc) -> tuple[Arc, Arc]:
    x = np.asarray(arc.centre) + arc.radius * arc.middle
    middle = (float(x[0]), float(x[1]))
    return Arc(arc.start, middle, arc.centre, arc.clockwise), Arc(middle, arc.end, arc.centre, arc.clockwise)

"""STEP files of tools: extruded and revolved profiles and boxes as solids of OpenCASCADE."""

from __future__ import annotations

import importlib
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from umform.errors import FileProblem, InvalidValue
from umform.io.atomic import PendingFile
from umform.surfaces.cad.opencascade import quiet, scaled, static
from umform.surfaces.directions import right_angle, unit_vector
from umform.surfaces.dxf import MILLIMETRE
from umform.surfaces.profile import Profile
from umform.surfaces.segments import Arc, Floats, Line, Segment
from umform.surfaces.solids import Box
from umform.surfaces.swept import ENDLESS, ON_AXIS, Extruded, Revolved
from umform.surfaces.tool import Placed, Tool
from umform.surfaces.triangles import Box3, across


def write_step(path: str | Path, tools: Mapping[str, Tool], box: Box3, unit: str = "mm") -> Path:
    """Write the parts of tools in a box as solids, in mm.

    Parameters
    ----------
    path : str or Path
        The file.
    tools : mapping of str to Tool
        The tools by their names, which are those of the parts.
    box : tuple of two points
        Lowest and highest corner.
    unit : str
        Unit of tools and box, from which they are converted.

    Raises
    ------
    FileProblem
        If OpenCASCADE is not installed, or the file cannot be written.
    InvalidValue
        If a tool is neither a box nor extruded or revolved, or does not enter the box.
    """
    try:
        control = importlib.import_module("OCP.STEPControl")
    except ImportError as error:
        raise FileProblem(
            "writing STEP files needs OpenCASCADE",
            where=str(path),
            cause=str(error),
            remedy='pip install "umform[cad]"',
        ) from error
    quiet()
    writer = control.STEPControl_Writer()
    for name, tool in tools.items():
        static("Interface", "Interface_Static", "SetCVal")("write.step.product.name", name)
        part = scaled(_inside(_solid(tool, box, name), box, name), 1.0 / MILLIMETRE[unit])
        writer.Transfer(part, control.STEPControl_StepModelType.STEPControl_AsIs)
    done = importlib.import_module("OCP.IFSelect").IFSelect_ReturnStatus.IFSelect_RetDone
    with PendingFile(path) as temporary:
        if writer.Write(str(temporary)) != done:
            raise FileProblem(
                "the STEP file cannot be written",
                where=str(path),
                cause="OpenCASCADE refuses it",
                remedy="another folder or name; a profile without edges of zero length",
            )
    return Path(path)


def _solid(tool: Tool, box: Box3, name: str) -> Any:
    """The solid of a tool, that reaches beyond the box."""
    build = importlib.import_module("OCP.BRepBuilderAPI")
    if isinstance(tool, Placed) and isinstance(tool.tool, Tool):
        Q, c = np.array(tool.matrix), np.array(tool.shift)
        gp = importlib.import_module("OCP.gp")
        move = gp.gp_Trsf()
        move.SetValues(*(value for row, shift in zip(Q, c, strict=True) for value in (*row, shift)))
        corners = np.array(box)
        middle, reach = 0.5 * corners.sum(axis=0), float(np.linalg.norm(corners[1] - corners[0]))
        own = (middle - c) @ Q
        inner = _solid(tool.tool, (own - reach, own + reach), name)
        return build.BRepBuilderAPI_Transform(inner, move, True).Shape()
    if isinstance(tool, Box):
        return _box(tool)
    section = tool.section()
    if not isinstance(section, Extruded | Revolved):
        raise InvalidValue(
            "this tool is no solid that a STEP file has",
            where=name,
            value=type(tool).__name__,
            cause="it is neither a box nor extruded or revolved",
            remedy="write its triangles, as .stl",
        )
    return _extruded(section, box) if isinstance(section, Extruded) else _revolved(section, box)


def _inside(shape: Any, box: Box3, name: str) -> Any:
    """The part in the box."""
    low, high = (_point(corner) for corner in box)
    prism = importlib.import_module("OCP.BRepPrimAPI").BRepPrimAPI_MakeBox(low, high).Shape()
    common = importlib.import_module("OCP.BRepAlgoAPI").BRepAlgoAPI_Common(shape, prism).Shape()
    kinds = importlib.import_module("OCP.TopAbs").TopAbs_ShapeEnum
    if not importlib.import_module("OCP.TopExp").TopExp_Explorer(common, kinds.TopAbs_SOLID).More():
        raise InvalidValue(
            "nothing of the tool lies in the box",
            where=name,
            value=box,
            cause="a box beside the tool",
            remedy="a box around the part of the tool that is wanted",
        )
    return common


def _box(tool: Box) -> Any:
    gp, primitives = importlib.import_module("OCP.gp"), importlib.import_module("OCP.BRepPrimAPI")
    x, y = (np.array(v) for v in right_angle(tool.x, tool.y))
    half = 0.5 * np.array(tool.size)
    corner = np.array(tool.centre) - half @ np.array([x, y, np.cross(x, y)])
    frame = gp.gp_Ax2(_point(corner), _direction(np.cross(x, y)), _direction(x))
    made = primitives.BRepPrimAPI_MakeBox(frame, *(float(length) for length in tool.size)).Shape()
    if not tool.radius:
        return made
    fillet = importlib.import_module("OCP.BRepFilletAPI").BRepFilletAPI_MakeFillet(made)
    kinds = importlib.import_module("OCP.TopAbs").TopAbs_ShapeEnum
    at = importlib.import_module("OCP.TopExp").TopExp_Explorer(made, kinds.TopAbs_EDGE)
    while at.More():
        fillet.Add(float(tool.radius), static("TopoDS", "TopoDS", "Edge")(at.Current()))
        at.Next()
    return fillet.Shape()


def _reach(profile: Profile, origin: Floats, box: Box3) -> float:
    """Radius around an origin beyond both a profile and a box."""
    corners = np.abs(np.array(box) - origin).max(axis=0)
    return 2.0 * (2.0 * profile.size + float(np.linalg.norm(corners)))


def _extruded(tool: Extruded, box: Box3) -> Any:
    x, y = (np.array(v) for v in right_angle(tool.x, tool.y))
    origin, along = np.array(tool.origin), np.cross(x, y)
    far = _reach(tool.profile, origin, box)
    segments = tool.profile.segments
    around: list[Segment] = [Arc((far, 0.0), (far, 0.0), (0.0, 0.0))]
    if tool.profile.closed:
        loops = [list(segments)] if tool.profile.area > 0.0 else [around, list(segments)]
    else:
        curve = _to_circle(segments, far, True, True)
        loops = [[*curve, Arc(curve[-1].end, curve[0].start, (0.0, 0.0))]]
    face = _face(loops, origin - far * along, x, y)
    return importlib.import_module("OCP.BRepPrimAPI").BRepPrimAPI_MakePrism(face, _vector(2.0 * far * along)).Shape()


def _revolved(tool: Revolved, box: Box3) -> Any:
    gp = importlib.import_module("OCP.gp")
    axis, origin = np.array(unit_vector(tool.axis)), np.array(tool.origin)
    far = _reach(tool.profile, origin, box)
    meridian, start, end = tool.meridian()
    segments = list(meridian.segments)
    if meridian.closed:
        edge: list[Segment] = [Arc((0.0, -far), (0.0, far), (0.0, 0.0)), Line((0.0, far), (0.0, -far))]
        loops = [segments] if meridian.area > 0.0 else [edge, segments]
    else:
        curve = _to_circle(segments, far, start == ENDLESS, end == ENDLESS)
        loops = [[*curve, *_around(curve[-1].end, curve[0].start, far, end == ON_AXIS, start == ON_AXIS)]]
    face = _face(loops, origin, np.array(across(unit_vector(tool.axis))[0]), axis)
    about = gp.gp_Ax1(_point(origin), _direction(axis))
    return importlib.import_module("OCP.BRepPrimAPI").BRepPrimAPI_MakeRevol(face, about).Shape()


def _to_circle(segments: Sequence[Segment], far: float, first: bool, last: bool) -> list[Segment]:
    """An open curve with its endless lines extended to a circle about the origin."""
    found = list(segments)
    if first:
        found[0] = Line(_on_circle(found[0].start, -found[0].tangents()[0], far), found[0].end)
    if last:
        found[-1] = Line(found[-1].start, _on_circle(found[-1].end, found[-1].tangents()[1], far))
    return found


def _on_circle(at: tuple[float, float], way: Floats, far: float) -> tuple[float, float]:
    p = np.array(at)
    along = float(p @ way)
    x, y = p + (math.sqrt(along**2 + far**2 - float(p @ p)) - along) * way
    return float(x), float(y)


def _around(
    last: tuple[float, float], first: tuple[float, float], far: float, from_axis: bool, to_axis: bool
) -> list[Segment]:
    """The way back along the axis, downwards, and a half circle, upwards, with the solid on the left."""
    low, high, centre = (0.0, -far), (0.0, far), (0.0, 0.0)
    if from_axis and to_axis and last[1] > first[1]:
        return [Line(last, first)]
    found: list[Segment] = [Line(last, low)] if from_axis else []
    at = low if from_axis else last
    if not from_axis and not to_axis and math.atan2(last[1], last[0]) > math.atan2(first[1], first[0]):
        found, at = [Arc(last, high, centre), Line(high, low)], low
    found.append(Arc(at, high if to_axis else first, centre))
    return [*found, Line(high, first)] if to_axis else found


def _face(loops: Sequence[Sequence[Segment]], origin: Floats, x: Floats, y: Floats) -> Any:
    """Plane face between an outer loop and holes."""
    build, gp = importlib.import_module("OCP.BRepBuilderAPI"), importlib.import_module("OCP.gp")
    plane = gp.gp_Pln(gp.gp_Ax3(_point(origin), _direction(np.cross(x, y)), _direction(x)))
    outer, *holes = [_wire(loop, origin, x, y) for loop in loops]
    made = build.BRepBuilderAPI_MakeFace(plane, outer, True)
    for hole in holes:
        made.Add(hole)
    return made.Face()


def _wire(loop: Sequence[Segment], origin: Floats, x: Floats, y: Floats) -> Any:
    """Edges between common corners."""
    build, gp = importlib.import_module("OCP.BRepBuilderAPI"), importlib.import_module("OCP.gp")

    def at(p: tuple[float, float] | Floats) -> Any:
        return _point(origin + p[0] * x + p[1] * y)

    wire = build.BRepBuilderAPI_MakeWire()
    corners = [build.BRepBuilderAPI_MakeVertex(at(segment.start)).Vertex() for segment in loop]
    for segment, start, end in zip(loop, corners, [*corners[1:], corners[0]], strict=True):
        if isinstance(segment, Line):
            edge = build.BRepBuilderAPI_MakeEdge(start, end)
        else:
            normal = np.cross(x, y) * segment.turn
            towards = (segment.start[0] - segment.centre[0]) * x + (segment.start[1] - segment.centre[1]) * y
            frame = gp.gp_Ax2(at(segment.centre), _direction(normal), _direction(towards))
            circle = gp.gp_Circ(frame, segment.radius)
            whole = segment.start == segment.end
            edge = build.BRepBuilderAPI_MakeEdge(circle, *([] if whole else [start, end]))
        wire.Add(edge.Edge())
    return wire.Wire()


def _point(v: Any) -> Any:
    return importlib.import_module("OCP.gp").gp_Pnt(*(float(c) for c in v))


def _direction(v: Any) -> Any:
    return importlib.import_module("OCP.gp").gp_Dir(*(float(c) for c in v))


def _vector(v: Any) -> Any:
    return importlib.import_module("OCP.gp").gp_Vec(*(float(c) for c in v))

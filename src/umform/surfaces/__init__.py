"""Rigid tools as signed distance functions: distance, unit normal and Hessian of the distance."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from umform.first_use import at_first_use

if TYPE_CHECKING:
    from umform.surfaces.cad import CadTool
    from umform.surfaces.check import SurfaceCheck, check_surface
    from umform.surfaces.directions import Direction, unit_vector
    from umform.surfaces.drawing import Drawing, read_tool
    from umform.surfaces.files import write_tool
    from umform.surfaces.led_around import LedAround
    from umform.surfaces.offset_field import OffsetField
    from umform.surfaces.press_brake import Punch, UDie, VDie, WipingDie
    from umform.surfaces.profile import Profile
    from umform.surfaces.segments import Arc, Line
    from umform.surfaces.simple import Cylinder, Plane, Sphere
    from umform.surfaces.size_map import ToolSizes
    from umform.surfaces.sizes import tool_sizes
    from umform.surfaces.solids import Box, Torus
    from umform.surfaces.swept import Extruded, Revolved
    from umform.surfaces.tool import Offset, OffsetByField, Placed, Surface, Tool, ToolSpec
    from umform.surfaces.triangles import Triangles
    from umform.surfaces.triangulated import Triangulated
    from umform.surfaces.user import GapFunction, UserSurface

__all__ = [
    "Arc",
    "Box",
    "CadTool",
    "Cylinder",
    "Direction",
    "Drawing",
    "Extruded",
    "GapFunction",
    "LedAround",
    "Line",
    "Offset",
    "OffsetByField",
    "OffsetField",
    "Placed",
    "Plane",
    "Profile",
    "Punch",
    "Revolved",
    "Sphere",
    "Surface",
    "SurfaceCheck",
    "Tool",
    "ToolSizes",
    "ToolSpec",
    "Torus",
    "Triangles",
    "Triangulated",
    "UDie",
    "UserSurface",
    "VDie",
    "WipingDie",
    "check_surface",
    "read_tool",
    "tool_sizes",
    "unit_vector",
    "write_tool",
]

_HOME = {
    "Arc": "segments",
    "Box": "solids",
    "CadTool": "cad",
    "Cylinder": "simple",
    "Direction": "directions",
    "Drawing": "drawing",
    "Extruded": "swept",
    "GapFunction": "user",
    "LedAround": "led_around",
    "Line": "segments",
    "Offset": "tool",
    "OffsetByField": "tool",
    "OffsetField": "offset_field",
    "Placed": "tool",
    "Plane": "simple",
    "Profile": "profile",
    "Punch": "press_brake",
    "Revolved": "swept",
    "Sphere": "simple",
    "Surface": "tool",
    "SurfaceCheck": "check",
    "Tool": "tool",
    "ToolSizes": "size_map",
    "ToolSpec": "tool",
    "Torus": "solids",
    "Triangles": "triangles",
    "Triangulated": "triangulated",
    "UDie": "press_brake",
    "UserSurface": "user",
    "VDie": "press_brake",
    "WipingDie": "press_brake",
    "check_surface": "check",
    "read_tool": "drawing",
    "tool_sizes": "sizes",
    "unit_vector": "directions",
    "write_tool": "files",
}


def _others() -> Mapping[str, type]:
    """Tools in the files of this package, those too that have no line above."""
    from umform.spec.known import known
    from umform.surfaces.tool import ToolSpec

    return known(__name__, ToolSpec)


__getattr__ = at_first_use(__name__, _HOME, _others)

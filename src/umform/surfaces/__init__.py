"""Rigid tools as signed distance functions: distance, unit normal and Hessian of the distance."""

from umform.surfaces.cad import CadTool
from umform.surfaces.check import SurfaceCheck, check_surface
from umform.surfaces.directions import Direction, unit_vector
from umform.surfaces.drawing import read_tool
from umform.surfaces.files import write_tool
from umform.surfaces.led_around import LedAround
from umform.surfaces.press_brake import Punch, UDie, VDie, WipingDie
from umform.surfaces.profile import Profile
from umform.surfaces.segments import Arc, Line
from umform.surfaces.simple import Cylinder, Plane, Sphere
from umform.surfaces.size_map import ToolSizes
from umform.surfaces.solids import Box, Torus
from umform.surfaces.swept import Extruded, Revolved
from umform.surfaces.tool import Offset, Placed, Surface, Tool
from umform.surfaces.tool_sizes import tool_sizes
from umform.surfaces.triangles import Triangles
from umform.surfaces.triangulated import Triangulated
from umform.surfaces.user import GapFunction, UserSurface

__all__ = [
    "Arc",
    "Box",
    "CadTool",
    "Cylinder",
    "Direction",
    "Extruded",
    "GapFunction",
    "LedAround",
    "Line",
    "Offset",
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

"""Planes, cylinders, cones, spheres and tori of a drawing as exact tools."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from umform.surfaces.cad.opencascade import Face
from umform.surfaces.directions import Point
from umform.surfaces.profile import Profile
from umform.surfaces.segments import Line
from umform.surfaces.simple import Cylinder, Plane, Sphere
from umform.surfaces.solids import Torus
from umform.surfaces.swept import Revolved
from umform.surfaces.tool import Tool


def elementary(face: Face) -> Tool | None:
    """The infinite surface of a face, oriented like the face; None for a free form."""
    if face.kind not in _MAKERS:
        return None
    tool = _MAKERS[face.kind](getattr(face.formula, face.kind)(), face)
    if tool is None:
        return None
    same = float(np.einsum("ni,ni->", face.normals(), tool.gap(face.points)[1]))
    return tool if same > 0.0 else tool.counterpart(0.0)


def _plane(plane: Any, face: Face) -> Tool:
    del face
    return Plane(_xyz(plane.Location()), _xyz(plane.Axis().Direction()))


def _cylinder(cylinder: Any, face: Face) -> Tool:
    del face
    return Cylinder(_xyz(cylinder.Location()), _xyz(cylinder.Axis().Direction()), cylinder.Radius())


def _sphere(sphere: Any, face: Face) -> Tool:
    del face
    return Sphere(_xyz(sphere.Location()), sphere.Radius())


def _torus(torus: Any, face: Face) -> Tool | None:
    """None where the tube crosses the axis."""
    del face
    major, minor = torus.MajorRadius(), torus.MinorRadius()
    return Torus(_xyz(torus.Location()), _xyz(torus.Axis().Direction()), major, minor) if minor < major else None


def _cone(cone: Any, face: Face) -> Tool:
    """The half that contains the face."""
    apex, axis = np.array(_xyz(cone.Apex())), np.array(_xyz(cone.Axis().Direction()))
    side = math.copysign(1.0, float(((face.points - apex) @ axis).sum()))
    angle = abs(cone.SemiAngle())
    line = Line((0.0, 0.0), (math.sin(angle), side * math.cos(angle)))
    return Revolved(Profile([line], closed=False), _xyz(cone.Apex()), _xyz(cone.Axis().Direction()))


def _xyz(v: Any) -> Point:
    return float(v.X()), float(v.Y()), float(v.Z())


_MAKERS = {"Plane": _plane, "Cylinder": _cylinder, "Cone": _cone, "Sphere": _sphere, "Torus": _torus}

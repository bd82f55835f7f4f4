"""Bent parts made with the CAD kernel, with what their flat patterns must have."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakeWire,
    BRepBuilderAPI_Transform,
)
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder, BRepPrimAPI_MakePrism
from OCP.GC import GC_MakeArcOfCircle
from OCP.gp import gp_Ax1, gp_Ax2, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
from OCP.Interface import Interface_Static
from OCP.ShapeUpgrade import ShapeUpgrade_UnifySameDomain
from OCP.STEPControl import STEPControl_StepModelType, STEPControl_Writer

from umform.surfaces.cad.opencascade import quiet


def section(legs, turns, width, thickness=2.0, radius=2.0, base=0):
    """Straight legs and bends, up for positive degrees, in x and z; the middle of one leg is the origin, on x."""
    pieces, heading, at = [], 0.0, np.zeros(2)  # a piece: start, heading, turn or None, length or mean radius
    poses = []
    for leg, turn in zip(legs, [*turns, None], strict=True):
        poses.append((at + 0.5 * leg * towards(heading), heading))
        pieces.append((at, heading, None, leg))
        at = at + leg * towards(heading)
        if turn is not None:
            mean, sign = radius + 0.5 * thickness, math.copysign(1.0, turn)
            pieces.append((at, heading, turn, mean))
            centre = at + sign * mean * beside(heading)
            heading += math.radians(turn)
            at = centre - sign * mean * beside(heading)
    origin, tilt = poses[base]
    wire = BRepBuilderAPI_MakeWire()
    back = np.array([[math.cos(tilt), math.sin(tilt)], [-math.sin(tilt), math.cos(tilt)]])

    def point(x):
        x = back @ (x - origin)
        return gp_Pnt(float(x[0]), -0.5 * width, float(x[1]))

    def add(piece, level, reverse):
        start, angle, turn, size = piece
        if turn is None:
            path = [start, start + size * towards(angle)]
            path = [x + level * beside(angle) for x in path]
        else:
            sign = math.copysign(1.0, turn)
            centre = start + sign * size * beside(angle)
            way = size - sign * level
            path = [centre - sign * way * beside(angle + math.radians(share * turn)) for share in (0.0, 0.5, 1.0)]
        path = [point(x) for x in (path[::-1] if reverse else path)]
        if len(path) == 2:
            wire.Add(BRepBuilderAPI_MakeEdge(*path).Edge())
        else:
            wire.Add(BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(*path).Value()).Edge())

    def end(x, angle, up):
        levels = [-0.5 * thickness, 0.5 * thickness]
        ends = [point(x + level * beside(angle)) for level in (levels if up else levels[::-1])]
        wire.Add(BRepBuilderAPI_MakeEdge(*ends).Edge())

    for piece in pieces:
        add(piece, -0.5 * thickness, False)
    end(at, heading, True)
    for piece in reversed(pieces):
        add(piece, 0.5 * thickness, True)
    end(np.zeros(2), 0.0, False)
    face = BRepBuilderAPI_MakeFace(wire.Wire()).Face()
    return BRepPrimAPI_MakePrism(face, gp_Vec(0.0, float(width), 0.0)).Shape()


def towards(angle):
    return np.array([math.cos(angle), math.sin(angle)])


def beside(angle):
    return np.array([-math.sin(angle), math.cos(angle)])


def write(shape, path, unit="MM"):
    writer = STEPControl_Writer()
    quiet()
    Interface_Static.SetCVal_s("write.step.unit", unit)
    writer.Transfer(shape, STEPControl_StepModelType.STEPControl_AsIs)
    writer.Write(str(path))
    Interface_Static.SetCVal_s("write.step.unit", "MM")
    return path


def placed(shape, shift=(0.0, 0.0, 0.0), turn=0.0):
    """The shape turned about z by degrees, then shifted."""
    rotation, translation = gp_Trsf(), gp_Trsf()
    rotation.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), math.radians(turn))
    translation.SetTranslation(gp_Vec(*map(float, shift)))
    return BRepBuilderAPI_Transform(shape, translation.Multiplied(rotation), True).Shape()


def fused(*shapes, joined=True):
    made = shapes[0]
    for shape in shapes[1:]:
        made = BRepAlgoAPI_Fuse(made, shape).Shape()
    if joined:
        joining = ShapeUpgrade_UnifySameDomain(made, True, True, False)
        joining.Build()
        made = joining.Shape()
    return made


def cut(shape, *others):
    for other in others:
        shape = BRepAlgoAPI_Cut(shape, other).Shape()
    return shape


def drill(point, direction, radius, depth=400.0):
    """A cylinder through a point, along a direction both ways."""
    unit = np.array(direction, dtype=float) / np.linalg.norm(direction)
    start = np.array(point, dtype=float) - 0.5 * depth * unit
    return BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(*start.tolist()), gp_Dir(*unit.tolist())), radius, depth).Shape()


def block(corner, sizes):
    return BRepPrimAPI_MakeBox(gp_Pnt(*map(float, corner)), *map(float, sizes)).Shape()


@dataclass(frozen=True)
class Bracket:
    """A part: its shape, the bends of its flat pattern, its flat length for a K-factor, or why it is refused."""

    shape: Callable[[], object]
    bends: int = 0
    legs: tuple[float, ...] = ()
    turns: tuple[float, ...] = ()
    thickness: float = 2.0
    radius: float = 2.0
    holes: int = 0
    refused: str = ""
    unit: str = "MM"
    warned: str = ""

    def flat_length(self, k):
        """Closed form of one section."""
        arcs = sum(math.radians(abs(turn)) * (self.radius + k * self.thickness) for turn in self.turns)
        return sum(self.legs) + arcs

    def file(self, path):
        return write(self.shape(), path, self.unit)


def strip(legs, turns, width=50.0, thickness=2.0, radius=2.0, base=0, **more):
    """A bracket of one section."""
    made = lambda: section(legs, turns, width, thickness, radius, base)  # noqa: E731
    return Bracket(made, len(turns), tuple(legs), tuple(turns), thickness, radius, **more)


def like(of, change, **more):
    return Bracket(**{**of.__dict__, "shape": lambda: change(of.shape()), **more})


def box(joined=True):
    """A base with four flanges and a notch at each corner."""
    one = section([30, 60, 30], [90, 90], 36.0, base=1)
    two = section([20, 40, 20], [90, 90], 56.0, base=1)
    return fused(one, placed(two, turn=90.0), joined=joined)


def plate_with_tabs():
    """A plate with three tabs at angles to its sides, on corners that are cut off."""
    plate = block((-40, -40, -1), (80, 80, 2))
    tabs = [
        placed(section([40, 25], [turn], 20.0), (38 * math.cos(a), 38 * math.sin(a), 0), math.degrees(a))
        for turn, a in ((90, math.radians(45)), (60, math.radians(135)), (-90, math.radians(290)))
    ]
    return fused(plate, *tabs)


def rounded_corners(shape):
    """Both corners of the first leg cut round."""
    for y in (-1.0, 1.0):
        corner = block((-30, min(13 * y, 33 * y), -9), (22, 20, 20))
        shape = cut(shape, cut(corner, drill((-8, 13 * y, 0), (0, 0, 1), 12)))
    return shape


def window_in_bend():
    """A slot over the whole bend, which cuts its line in two."""
    return cut(section([40, 30], [90], 50.0), block((12, -8, -10), (20, 16, 24)))


def tube():
    """A square tube."""
    legs, turns = [20, 40, 40, 40, 20], [90, 90, 90, 90]
    return fused(section(legs, turns, 50.0))


L = strip([40, 30], [90])
BRACKETS = {
    "l": L,
    "u": strip([30, 60, 30], [90, 90], base=1),
    "z": strip([30, 60, 30], [90, -90], base=1),
    "hat": strip([20, 30, 50, 30, 20], [-90, 90, 90, -90], base=2),
    "blunt": strip([40, 30], [30], thickness=3.0, radius=4.0),
    "acute": strip([40, 30], [130], thickness=1.0, radius=1.5),
    "joggle": strip([40, 6, 40], [45, -45], thickness=1.5),
    "lipped": strip([10, 30, 60, 30, 10], [90, 90, 90, 90], base=2),
    "five": strip([25, 20, 30, 20, 25, 30], [90, -90, 60, -120, 45], thickness=1.0, radius=1.0),
    "holes": like(L, lambda x: cut(x, drill((-8, 10, 0), (0, 0, 1), 3), drill((-8, -10, 0), (0, 0, 1), 4.5)), holes=2),
    "hole across the bend": like(L, lambda x: cut(x, drill((21, 0, 1), (1, 0, -1), 5)), holes=1, warned="lies across"),
    "window in the bend": like(L, lambda _: window_in_bend(), holes=1, warned="lies across"),
    "hole near the bend": like(
        L, lambda x: cut(x, drill((16, 0, 0), (0, 0, 1), 3)), holes=1, warned="is 3.26 mm from the line of bend 1"
    ),
    "inches": strip([38.1, 50.8], [90], 25.4, 3.175, 3.175, unit="INCH"),
    "rounded corners": like(strip([40, 60], [90]), rounded_corners),
    "box": Bracket(box, 4, (30, 60, 30), (90, 90)),
    "box of faces that are not joined": Bracket(lambda: box(joined=False), 4, (30, 60, 30), (90, 90)),
    "tabs": Bracket(plate_with_tabs, 3),
    "hem": strip([40, 20], [180], thickness=1.0, radius=0.5, refused="face 6"),
    "tube": Bracket(tube, refused="closed"),
}

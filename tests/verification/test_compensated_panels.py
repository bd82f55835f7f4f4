"""Panels whose tools follow their springback by offset fields: largest deviation a tenth of that of the first run."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.mesh import Bent, bending_sizes, grid
from umform.surfaces import Sphere
from umform_book.drawing.s_rail import LENGTH, THICKNESS, middle, swept

#: Matched tools leave so much more than the thickness.
CLEARANCE = 1.05


def touching(tool, x, sign):
    """Way along z at which a tool is 0.01 mm from some points."""
    near, far = 0.0, 60.0
    for _ in range(40):
        way = 0.5 * (near + far)
        if tool.gap(x - np.array([0.0, 0.0, sign * way]))[0].min() > 0.01:
            far = way
        else:
            near = way
    return far


def pressed(model, die, punch, friction, steps):
    """Press a sheet between two matched tools, which begin where they just do not touch it, and take it out."""
    low, high = (model.mesh.points[model.mesh.nodes(face)] for face in ("lower", "upper"))
    down, up = touching(die, low, -1.0), touching(punch, high, 1.0)
    touch = {"penalty": 1e3, "points": 2, "friction": friction}
    model.contact("lower", die.moved((0, 0, -down)), name="die", **touch)
    way = model.drive(model.contact("upper", punch.moved((0, 0, up)), name="punch", **touch), "-z", name="stroke")
    return uf.Move(way, up + down, steps=steps)


def panel(die, punch, size=(60.0, 40.0), cells=(14, 10), steps=40):
    """A quarter of a shallow doubly curved panel."""
    mesh = grid(*(np.linspace(0.0, length, n + 1) for length, n in zip(size, cells, strict=True)), [0.0, 1.0])
    steel = uf.J2(E=206e3, nu=0.3, hardening=uf.Swift(strength=565.0, offset=0.0071, exponent=0.259))
    model = uf.Model(mesh, "ANS3DEAS", material=steel)
    model.symmetry("x0", normal="x")
    model.symmetry("y0", normal="y")
    tools = Sphere((0, 0, 200), 200, inside=True).offset(die), Sphere((0, 0, 200), 199).offset(punch)
    move = pressed(model, *tools, friction=0.1, steps=steps)
    gauge = model.hold_rigid(lambda x, y, z: (x < 1e-9) & (y < 1e-9), name="gauge")
    return model, [move, uf.Free(model.tools, steps=5, on=gauge)]


DEPTH, BOTTOM, WALL, RADIUS, HALF_BLANK = 15.0, 30.0, np.radians(30.0), 8.0, 60.0
TOP = BOTTOM + DEPTH * np.tan(WALL)
STRONG = uf.J2(E=206e3, nu=0.3, hardening=uf.Swift(strength=1000.0, offset=0.002, exponent=0.15))


def s_rail():
    """A shallow S-rail with inclined walls, pressed between a die of triangles and its counterpart."""
    corners = [(TOP + 30, 0), (TOP, 0), (BOTTOM, -DEPTH), (-BOTTOM, -DEPTH), (-TOP, 0), (-TOP - 30, 0)]
    form = swept(uf.Profile.from_corners(corners, [0, RADIUS, RADIUS, RADIUS, RADIUS, 0], closed=False), "die")
    other = form.counterpart(CLEARANCE * THICKNESS)
    over = Bent(BOTTOM - 2.0, TOP + 5.0, RADIUS + 0.5 * THICKNESS)
    ends = bending_sizes(0.0, HALF_BLANK, [over], turn=30.0, largest=10.0).ends
    flat = grid(np.linspace(0.0, LENGTH, 15), np.r_[-ends[:0:-1], ends], [0.0, THICKNESS])
    blank = flat.transformed(lambda x: x + np.outer(middle(x[:, 0]), [0.0, 1.0, 0.0]))

    def build(die, punch):
        model = uf.Model(blank, "ANS3DEAS", material=STRONG, thickness_points=5)
        move = pressed(model, form.offset(die), other.offset(punch), friction=0.1, steps=40)
        gauge = model.hold_rigid(lambda x, y, z: z < 1e-9, name="gauge")
        return model, [move, uf.Free(model.tools, steps=6, on=gauge)]

    return build


@pytest.mark.long
def test_a_panel_of_140_elements_has_its_shape_in_four_runs():
    field = uf.OffsetField(["x", "y"], [(0, 60), (0, 40)], [6, 5])
    found = uf.compensate_shape(panel, "upper", {"die": field, "punch": field}, progress=False)
    assert found.trials[0].largest > 0.3
    assert found.reached, found.table


@pytest.mark.long
def test_an_s_rail_has_its_shape_in_four_runs():
    field = uf.OffsetField(["x", "y", "z"], [(0, LENGTH), (-75, 75), (-DEPTH, 0)], [7, 7, 3])
    found = uf.compensate_shape(s_rail(), "upper", {"die": field, "punch": field}, progress=False)
    assert found.trials[0].largest > 1.0
    assert found.reached, found.table

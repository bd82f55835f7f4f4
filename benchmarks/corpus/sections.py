"""Sections of sheets between tools, in plane strain: U, L, Z, joggle, wiping, stretching; pads, holders, blocks."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

import umform as uf
from corpus.answers import LEFT_RIGHT, Answer, carried, solve, unlike
from corpus.laws import law
from umform.analysis.steps import Step
from umform.model.supports.support import Support
from umform.surfaces import Surface


@dataclass(frozen=True)
class Sheet:
    """A strip on z = 0 and how it is computed, in mm and MPa before the units.

    Attributes
    ----------
    law, element : str
        Names.
    thickness : float
        Of the sheet.
    size : float
        Length of an element.
    friction : float, optional
        On all tools.
    rule : dict
        More arguments of all contacts.
    layers : int
        Elements through the thickness.
    steps : int or Pace, optional
        Of the strokes; None: the pace that umform chooses.
    mirrored : bool
        Sheet and tools are reflected at x = 0.
    length, stress : float
        Units in a millimetre and in a megapascal.
    """

    law: str = "swift"
    element: str = "BEND8"
    thickness: float = 1.0
    size: float = 1.0
    friction: float | None = 0.1
    rule: dict[str, Any] = field(default_factory=lambda: {"points": 3})
    layers: int = 1
    steps: int | uf.Pace | None = None
    mirrored: bool = False
    length: float = 1.0
    stress: float = 1.0

    def model(self, left: float, right: float) -> uf.Model:
        """Strip from one place to another."""
        s, cell = self.length, uf.elements.element(self.element).cell
        count = round((right - left) / self.size / (1 if cell == "hex8" else 2))
        mesh = uf.mesh.strip(s * (right - left), s, s * self.thickness, (count, 1), cell=cell, layers=self.layers)
        mesh = mesh.moved(s * np.array([left, 0.0, 0.5 * self.thickness]))
        if self.mirrored:
            mesh = mesh.moved(s * np.array([-left - right, 0.0, 0.0]))
        model = uf.Model(mesh, self.element, **law(self.law, self.stress))
        model.fix(np.arange(len(mesh.points)), "y")
        return model

    def at(self, x: float, tolerance: float = 1e-6) -> Any:
        """Nodes at a place along the strip."""
        place = self.length * (-x if self.mirrored else x)
        return lambda X, Y, Z: abs(X - place) < tolerance * self.length

    def tool(self, model: uf.Model, faces: str, surface: Surface, name: str, **more: Any) -> uf.model.tool.Tool:
        """A tool that touches faces, with the friction and rule of all."""
        if self.mirrored:
            surface = surface.mirrored("x")
        tool = model.tool(name, surface)
        given = self.rule | more
        if "penetration" in given:
            given["penetration"] *= self.length
        model.contact(faces, tool, friction=self.friction, name=f"on_{name}", **given)
        return tool

    def box(self, left: float, right: float, bottom: float, top: float, radius: float) -> uf.Box:
        """Box by its sides."""
        s = self.length
        centre = (0.5 * s * (left + right), 0.0, 0.5 * s * (bottom + top))
        return uf.Box(centre, (s * (right - left), 100.0 * s, s * (top - bottom)), s * radius)

    def plane(self, z: float) -> uf.Plane:
        """Plane that looks down."""
        return uf.Plane((0.0, 0.0, self.length * z), (0.0, 0.0, -1.0))

    def force(self, newton: float) -> float:
        """A force on a strip of width 1 mm, in its units."""
        return newton * self.stress * self.length**2


def _ended(
    model: uf.Model, steps: list[Step], end: str, stroke: Any, gauge: Support | None = None
) -> tuple[uf.Result, int]:
    """Solve, and open as the job says; also the number of rows of the history before the opening."""
    opening: list[Step] = []
    if end == "free":
        opening = [uf.Free(model.tools, steps=4, **({} if gauge is None else {"on": gauge}))]
    elif end == "release":
        opening = [uf.Release(stroke)]
    result = solve(model, [*steps, *opening])
    return result, int((result["step"] <= len(steps)).sum())


def u_bend(
    sheet: Sheet,
    *,
    stroke: float = 12.0,
    half: float = 15.0,
    nose: float = 4.0,
    edge: float = 4.0,
    clearance: float = 1.2,
    reach: float = 36.0,
    whole: bool = False,
    holder: float | None = None,
    gap: float | None = None,
    pad: float | None = None,
    end: str = "",
) -> Answer:
    """A U: half of it or the whole; a holder by force or at a gap, a pad on a spring below the punch."""
    t, s = sheet.thickness, sheet.length
    model = sheet.model(-reach if whole else 0.0, reach)
    if whole:
        model.fix(sheet.at(0.0), "x")
    else:
        model.symmetry("x1" if sheet.mirrored else "x0", "x")
    gauge = model.hold_rigid(sheet.at(0.0), name="gauge") if end == "free" else None
    die = uf.UDie(2.0 * s * (half + clearance * t), 60.0 * s, edge * s, edge * s)
    sheet.tool(model, "lower", die, "die")
    names, steps = ["die", "punch"], list[Step]()
    punch = sheet.tool(model, "upper", sheet.box(-half, half, t, t + 80.0, nose), "punch")
    if holder is not None or gap is not None:
        names.append("holder")
        tool = sheet.tool(model, "upper", sheet.plane(t if gap is None else t + gap), "holder")
        if holder is not None:
            hold = model.press(tool, "z", name="hold")
            steps.append(uf.Move(hold, -sheet.force(holder), steps=2))
    if pad is not None:
        names.append("pad")
        width = half - nose
        cushion = sheet.tool(model, "lower", sheet.box(-width, width, -30.0, 0.0, 0.5), "pad")
        stiffness, preload = sheet.force(1.0) / s, sheet.force(pad)
        model.spring(cushion, "z", stiffness=stiffness, preload=preload, name="cushion")
    ram = model.drive(punch, "-z", name="stroke")
    steps.append(uf.Move(ram, stroke * s, steps=sheet.steps))
    result, _ = _ended(model, steps, end, ram, gauge)
    symmetry = [unlike(model, model, LEFT_RIGHT)] if whole else []
    return Answer([result], symmetry, [carried(result, names)] if end != "free" else [])


def l_bend(
    sheet: Sheet,
    *,
    stroke: float = 14.0,
    edge: float = 3.0,
    nose: float = 3.0,
    clearance: float = 1.1,
    flange: float = 16.0,
    pad: float = 60.0,
    held: str = "force",
    clamped: bool = False,
    end: str = "",
) -> Answer:
    """An L: a pad holds the sheet on a block, a punch bends the flange down beside it."""
    t, s = sheet.thickness, sheet.length
    model = sheet.model(-22.0, flange)
    if clamped or not sheet.friction:
        model.fix(sheet.at(-22.0), "x")
    gauge = model.hold_rigid(sheet.at(-22.0), name="gauge") if end == "free" else None
    sheet.tool(model, "lower", uf.WipingDie(edge * s, origin=(0.0, 0.0, 0.0)), "block")
    above = 0.0 if held != "gap" else 0.02 * t
    holder = sheet.tool(model, "upper", sheet.box(-60.0, -edge + 1.0, t + above, t + 30.0, 1.0), "pad")
    punch = sheet.tool(model, "upper", sheet.box(clearance * t, 41.0, t, t + 40.0, nose), "punch")
    steps = list[Step]()
    if held == "force":
        hold = model.press(holder, "z", name="hold")
        steps.append(uf.Move(hold, -sheet.force(pad), steps=2))
    elif held == "spring":
        model.spring(holder, "z", stiffness=sheet.force(0.1 * pad) / s, preload=-sheet.force(pad), name="hold")
    ram = model.drive(punch, "-z", name="stroke")
    steps.append(uf.Move(ram, stroke * s, steps=sheet.steps))
    result, _ = _ended(model, steps, end, ram, gauge)
    names = [tool.name for tool in model.tools]
    return Answer([result], tools=[carried(result, names)] if end != "free" else [])


def wiping(
    sheet: Sheet,
    *,
    stroke: float = 14.0,
    edge: float = 3.0,
    nose: float = 4.0,
    clearance: float = 1.1,
    flange: float = 16.0,
    end: str = "",
) -> Answer:
    """A flange is wiped over an edge; the sheet is clamped at its end and lies on the block without a pad."""
    t, s = sheet.thickness, sheet.length
    model = sheet.model(-12.0, flange)
    model.fix(sheet.at(-12.0), "xz")
    sheet.tool(model, "lower", uf.WipingDie(edge * s, origin=(0.0, 0.0, 0.0)), "block")
    punch = sheet.tool(model, "upper", sheet.box(clearance * t, 51.0, t, t + 80.0, nose), "punch")
    ram = model.drive(punch, "-z", name="stroke")
    result, _ = _ended(model, [uf.Move(ram, stroke * s, steps=sheet.steps)], end, ram)
    return Answer([result])


def z_bend(
    sheet: Sheet, *, offset: float = 6.0, width: float = 5.0, edge: float = 2.0, pad: float = 80.0, end: str = ""
) -> Answer:
    """A Z, or a joggle with a small offset: the left is held by a pad, the right goes down between two edges."""
    t, s = sheet.thickness, sheet.length
    model = sheet.model(-18.0, 22.0)
    if not sheet.friction:
        model.fix(sheet.at(-18.0), "x")
    sheet.tool(model, "lower", uf.WipingDie(edge * s, origin=(0.0, 0.0, 0.0)), "block")
    holder = sheet.tool(model, "upper", sheet.box(-60.0, -edge, t, t + 30.0, 1.0), "pad")
    punch = sheet.tool(model, "upper", sheet.box(width, 60.0, t, t + 40.0, edge), "punch")
    hold = model.press(holder, "z", name="hold")
    ram = model.drive(punch, "-z", name="stroke")
    steps = [uf.Move(hold, -sheet.force(pad), steps=2), uf.Move(ram, offset * s, steps=sheet.steps)]
    result, _ = _ended(model, steps, end, ram)
    return Answer([result], tools=[carried(result, ["block", "pad", "punch"])])


def stretch_bend(
    sheet: Sheet, *, tension: float = 0.0, stroke: float = 8.0, radius: float = 12.0, end: str = ""
) -> Answer:
    """A strip is pulled, then a cylinder is pressed into it; both ends are clamped."""
    s, half = sheet.length, 30.0
    model = sheet.model(-half, half)
    pulls = [model.prescribe(sheet.at(x), "x", name) for x, name in ((-half, "left"), (half, "right"))]
    model.fix(sheet.at(-half), "z")
    model.fix(sheet.at(half), "z")
    punch = sheet.tool(model, "lower", uf.Cylinder((0.0, 0.0, -radius * s), "y", radius * s), "punch")
    ram = model.drive(punch, "z", name="stroke")
    steps = list[Step]()
    if tension:
        steps.append(uf.Move(pulls, [-tension * s, tension * s]))
    result, _ = _ended(model, [*steps, uf.Move(ram, stroke * s, steps=sheet.steps)], end, ram)
    return Answer([result], symmetry=[unlike(model, model, LEFT_RIGHT)])


def rolled(sheet: Sheet, *, turn: float = 0.5) -> Answer:
    """A clamped strip is bent around a cylinder that turns and sinks: friction along a turning tool."""
    s, R = sheet.length, 10.0
    model = sheet.model(0.0, 30.0)
    model.fix(sheet.at(0.0), "xz")
    model.fix(sheet.at(30.0), "xz")
    middle = (15.0 * s, 0.0, s * (sheet.thickness + R))
    punch = sheet.tool(model, "upper", uf.Cylinder(middle, "y", R * s), "punch")
    ram, spin = model.drive(punch, "-z", name="stroke"), model.turn(punch, "y", about=middle, name="spin")
    steps = [uf.Move(ram, 2.0 * s, steps=sheet.steps), uf.Move(spin, turn, steps=sheet.steps)]
    result, _ = _ended(model, steps, "", ram)
    return Answer([result])

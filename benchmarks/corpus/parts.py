"""Parts in three dimensions: cups, boxes, domes, bulges, plates, flanges that are trimmed; a bead."""

from __future__ import annotations

from typing import Any

import numpy as np

import umform as uf
from corpus.answers import DIAGONAL, FRONT_BACK, Answer, carried, unlike
from corpus.laws import law
from jobs import plates
from umform.analysis.steps import Step

#: How all contacts of a part are computed, if a job does not say otherwise.
_RULE = {"points": 2}


def _model(mesh: uf.Mesh, element: str, name: str, planes: dict[str, str]) -> uf.Model:
    model = uf.Model(mesh, element, **law(name))
    for nodes, normal in planes.items():
        model.symmetry(nodes, normal)
    return model


def _hold(model: uf.Model, tool: uf.model.tool.Tool, held: str, force: float) -> list[Step]:
    """Hold a blank holder by a force, a spring, or where it is."""
    if held == "force":
        return [uf.Move(model.press(tool, "z", name="hold"), -force, steps=2)]
    if held == "spring":
        model.spring(tool, "z", stiffness=0.2 * force, preload=-force, name="hold")
    return []


def _opened(model: uf.Model, steps: list[Step], end: str, stroke: Any) -> uf.Result:
    if end == "free":
        gauge = model.hold_rigid(name="gauge")
        steps = [*steps, uf.Free(model.tools, steps=4, on=gauge)]
    elif end == "release":
        steps = [*steps, uf.Release(stroke)]
    return uf.solve(model, steps, frames=0, progress=False)


def cup(
    *,
    part: str = "quarter",
    law: str = "swift",
    element: str = "ANS3DEAS",
    cells: tuple[int, int] = (3, 7),
    friction: float | None = 0.1,
    held: str = "gap",
    force: float = 2000.0,
    stroke: float = 8.0,
    steps: int | None = None,
    rule: dict[str, Any] | None = None,
    end: str = "",
) -> Answer:
    """A round cup of a sheet of 1 mm, punch of 20 mm."""
    t, radius = 1.0, 18.0
    cell = uf.elements.element(element).cell
    mesh = uf.mesh.disc(radius, t, cells, part=part, cell=cell)
    planes = {"x0": "x"} | ({"y0": "y"} if part == "quarter" else {})
    model = _model(mesh, element, law, planes)
    if part == "half":
        model.fix(lambda x, y, z: (abs(y) < 1e-9) & (x < 1e-9), "y")
    corners = [(60.0, -0.5), (11.3, -0.5), (11.3, -60.0)]
    die = uf.Revolved(uf.Profile.from_corners(corners, [0.0, 4.0, 0.0], closed=False))
    corners = [(0.0, 0.5), (10.0, 0.5), (10.0, 60.0)]
    punch = uf.Revolved(uf.Profile.from_corners(corners, [0.0, 3.0, 0.0], closed=False))
    holder = uf.Plane((0.0, 0.0, 0.5 if held != "gap" else 0.54), (0.0, 0.0, -1.0))
    tools = {}
    for faces, surface, name in (("lower", die, "die"), ("upper", punch, "punch"), ("upper", holder, "holder")):
        tools[name] = model.tool(name, surface)
        model.contact(faces, tools[name], friction=friction, name=f"on_{name}", **(rule or _RULE))
    closing = _hold(model, tools["holder"], held, force * (0.25 if part == "quarter" else 0.5))
    ram = model.drive(tools["punch"], "-z", name="stroke")
    result = _opened(model, [*closing, uf.Move(ram, stroke, steps=steps)], end, ram)
    image = DIAGONAL if part == "quarter" else FRONT_BACK
    symmetric = not getattr(model.bodies.only.material, "directional", False) or part == "half"
    symmetry = [unlike(model, model, image)] if symmetric else []
    return Answer([result], symmetry, [carried(result, list(tools))] if end != "free" else [])


def box(
    *,
    law: str = "voce",
    element: str = "ANS3DEAS",
    cells: int = 10,
    friction: float | None = 0.1,
    held: str = "gap",
    force: float = 3000.0,
    stroke: float = 5.0,
    steps: int | None = None,
    rule: dict[str, Any] | None = None,
) -> Answer:
    """A quarter of a square box of a sheet of 1 mm, punch of 24 mm."""
    lines = np.linspace(0.0, 22.0, cells + 1)
    model = _model(uf.mesh.grid(lines, lines, (-0.5, 0.5)), element, law, {"x0": "x", "y0": "y"})
    below = uf.Profile.from_corners([(60.0, -0.5), (0.0, -0.5), (0.0, -60.0)], [0.0, 4.0, 0.0], closed=False)
    above = uf.Profile.from_corners([(-6.0, 0.5), (0.0, 0.5), (0.0, 60.0)], [0.0, 3.0, 0.0], closed=False)
    surfaces = {
        "die": ("lower", uf.LedAround(below, size=(26.6, 26.6), corner=7.3)),
        "punch": ("upper", uf.LedAround(above, size=(24.0, 24.0), corner=6.0)),
        "holder": ("upper", uf.Plane((0.0, 0.0, 0.5 if held != "gap" else 0.54), (0.0, 0.0, -1.0))),
    }
    tools = {}
    for name, (faces, surface) in surfaces.items():
        tools[name] = model.tool(name, surface)
        model.contact(faces, tools[name], friction=friction, name=f"on_{name}", **(rule or _RULE))
    closing = _hold(model, tools["holder"], held, 0.25 * force)
    ram = model.drive(tools["punch"], "-z", name="stroke")
    result = _opened(model, [*closing, uf.Move(ram, stroke, steps=steps)], "", ram)
    return Answer([result], [unlike(model, model, DIAGONAL)], [carried(result, list(surfaces))])


def dome(
    *,
    law: str = "swift",
    element: str = "ANS3DEAS",
    cells: tuple[int, int] = (3, 7),
    friction: float | None = 0.1,
    stroke: float = 6.0,
    steps: int | None = None,
    rule: dict[str, Any] | None = None,
    end: str = "",
) -> Answer:
    """A clamped disc is stretched over a sphere."""
    cell = uf.elements.element(element).cell
    mesh = uf.mesh.disc(20.0, 1.0, cells, part="quarter", cell=cell)
    model = _model(mesh, element, law, {"x0": "x", "y0": "y"})
    model.fix("rim")
    punch = model.tool("punch", uf.Sphere((0.0, 0.0, 12.5), 12.0))
    model.contact("upper", punch, friction=friction, name="on_punch", **(rule or _RULE))
    ram = model.drive(punch, "-z", name="stroke")
    result = _opened(model, [uf.Move(ram, stroke, steps=steps)], end, ram)
    return Answer([result], [unlike(model, model, DIAGONAL)])


def bulge(
    *,
    law: str = "swift",
    element: str = "ANS3DEAS",
    cells: tuple[int, int] = (3, 6),
    pressure: float = 30.0,
    die: bool = False,
    arc: bool = False,
    steps: int | None = None,
    unload: bool = False,
) -> Answer:
    """A clamped disc under a pressure that follows it, over the edge of a die or along the arc of its path."""
    cell = uf.elements.element(element).cell
    mesh = uf.mesh.disc(20.0, 1.0, cells, part="quarter", cell=cell)
    model = _model(mesh, element, law, {"x0": "x", "y0": "y"})
    model.fix("rim")
    if die:
        corners = [(60.0, 0.5), (16.0, 0.5), (16.0, 60.0)]
        edge = uf.Revolved(uf.Profile.from_corners(corners[::-1], [0.0, 4.0, 0.0], closed=False))
        model.contact("upper", model.tool("die", edge), name="on_die", friction=0.1, **_RULE)
    load = model.pressure("lower", name="pressure")
    step: Step = uf.Arc(load, pressure, increment=0.05) if arc else uf.Move(load, pressure, steps=steps)
    back = [uf.Move(load, 0.0, steps=4)] if unload else []
    result = uf.solve(model, [step, *back], frames=0, progress=False)
    return Answer([result], [unlike(model, model, DIAGONAL)])


def plate(**keys: Any) -> Answer:
    """A plate of the random jobs, with given numbers; square ones are symmetric about the diagonal."""
    contact = keys.pop("contact", {"points": 2})
    given: dict[str, Any] = {
        "metal": "DC04",
        "thickness": 1.0,
        "element": "ANS3DEAS",
        "half": 20.0,
        "aspect": 1.0,
        "cells": (8, 8),
        "edges": "clamped",
        "tool": "ball",
        "radius": 8.0,
        "edge_radius": 2.0,
        "die_radius": 4.0,
        "stroke": 4.0,
        "steps": 10,
        "contacts": [contact, contact],
        "line_search": False,
        "unload": True,
    }
    results, _ = plates.run(given | keys)
    model = results[0].model
    tools = [tool.name for tool in model.tools]
    ring = keys.get("edges") == "ring"
    return Answer(results, [unlike(model, model, DIAGONAL)], [carried(results[0], tools)] if ring else [])


def flange(
    *, edge: str = "line", line: float = 8.3, law: str = "linear", size: float = 1.0, radius: float = 6.0
) -> Answer:
    """A strip is bent over a cylinder, trimmed across the bend, and springs back."""

    def bend(before: uf.Result | None) -> tuple[uf.Model, list[Step]]:
        mesh = uf.mesh.strip(20.0, 4.0, 1.0, (round(20.0 / size), 2))
        model = _model(mesh, "ANS3DEAS", law, {})
        model.fix("x0")
        tool = model.tool("post", uf.Cylinder((6.0, 0.0, -0.5 - radius), "y", radius))
        model.contact("lower", tool, name="on_post", points=2)
        return model, [uf.Move(model.prescribe("x1_lower", "z", "tip"), -6.0, steps=40)]

    def trim(before: uf.Result | None) -> tuple[uf.Model, uf.Move]:
        assert before is not None
        part = uf.Trim([(line, -9.0), (line, 9.0)], edge=edge).of(before)
        model = part.model
        model.put_back(model.hold_rigid(name="gauge"))
        return model, uf.Move(model.unbalanced("cut"), 0.0, steps=4)

    stages = uf.solve_stages([uf.Stage("bend", bend), uf.Stage("trim", trim)], frames=0, progress=False)
    bent, cut = stages["bend"], stages["trim"]
    before, after = bent["elastic_energy"][-1], cut["elastic_energy"][0]
    return Answer([bent, cut], trim=max(0.0, after / before - 1.0))


def beaded(
    *, law: str = "swift", restraint: float = 60.0, uplift: float = 20.0, friction: float | None = None
) -> Answer:
    """A strip is pulled through an equivalent bead."""
    mesh = uf.mesh.strip(60.0, 10.0, 0.8, (30, 2)).moved((0.0, 0.0, 0.4))
    model = _model(mesh, "ANS3DEAS", law, {"y0": "y"})
    die = model.contact("lower", uf.Plane(), name="die", friction=friction)
    model.contact("upper", uf.Plane((0.0, 0.0, 0.84), (0.0, 0.0, -1.0)), name="holder", friction=friction)
    model.bead(
        "lower", die, curve=[(20.0, -20.0, 0.0), (20.0, 20.0, 0.0)], restraint=restraint, uplift=20.0, width=16.0
    )
    pull = model.prescribe("x1", "x", "pull")
    return Answer([uf.solve(model, uf.Move(pull, 5.0), frames=0, progress=False)])


def wide(*, element: str = "ANS3DEAS", cells: tuple[int, int] = (12, 4), end: str = "") -> Answer:
    """A wide strip with free edges on two blocks under a cylinder: both halves of its width."""
    mesh = uf.mesh.strip(24.0, 12.0, 1.0, cells).transformed(lambda X: X - [0.0, 6.0, 0.0])
    model = _model(mesh, element, "linear", {"x0": "x"})
    model.fix(lambda x, y, z: (abs(y) < 1e-9) & (x < 1e-9), "y")
    block = uf.WipingDie(3.0, origin=(-14.0, 0.0, -0.5)).mirrored("x")
    model.contact("lower", model.tool("block", block), name="on_block", **_RULE)
    punch = model.tool("punch", uf.Cylinder((0.0, 0.0, 5.5), "y", 5.0))
    model.contact("upper", punch, name="on_punch", **_RULE)
    ram = model.drive(punch, "-z", name="stroke")
    result = _opened(model, [uf.Move(ram, 5.0)], end, ram)
    return Answer([result], [unlike(model, model, FRONT_BACK)], [carried(result, ["block", "punch"])])

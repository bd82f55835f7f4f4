"""Parts in three dimensions, quarters on coarse meshes: boxes, flanged holes, bulges, domes, stretched sheets."""

from __future__ import annotations

from typing import Any

import numpy as np

import umform as uf
from corpus.answers import DIAGONAL, Answer, carried, solve, unlike
from corpus.laws import law
from forming.sheets import FRICTIONS, THICKNESSES, UNITS, draw_increments, draw_law, draw_rule, increments, judged
from jobs.drawing import Drawing
from jobs.lot import Done
from umform.analysis.steps import Step

_ELEMENTS = ("ANS3DEAS", "ANS3DEAS", "ANS3DEAS", "BEND8", "EAS3DEAS")


def _draw(drawing: Drawing) -> dict[str, Any]:
    """What all parts have; lengths of tools are in thicknesses."""
    return {
        **draw_law(drawing),
        **draw_increments(drawing),
        "thickness": drawing.one_of(THICKNESSES),
        "element": drawing.one_of(_ELEMENTS),
        "friction": drawing.one_of(FRICTIONS),
        "rule": {name: value for name, value in draw_rule(drawing).items() if name != "penetration"},
        "end": drawing.one_of(("", "", "release")),
    }


def _model(keys: dict[str, Any], mesh: uf.Mesh) -> tuple[uf.Model, float]:
    """Quarter of a sheet that is one thick before it is scaled; and the length of a thickness."""
    length, stress = UNITS[keys["units"]]
    s = length * keys["thickness"]
    model = uf.Model(mesh.transformed(lambda X: s * X), keys["element"], **law(keys["law"], stress))
    model.symmetry("x0", "x")
    model.symmetry("y0", "y")
    return model, s


def _tool(model: uf.Model, keys: dict[str, Any], faces: str, surface: uf.surfaces.Surface, name: str) -> Any:
    tool = model.tool(name, surface)
    model.contact(faces, tool, friction=keys["friction"], name=f"on_{name}", **keys["rule"])
    return tool


def _profile(s: float, corners: list[tuple[float, float]], radius: float) -> uf.Profile:
    return uf.Profile.from_corners([(s * x, s * z) for x, z in corners], [0.0, s * radius, 0.0], closed=False)


def _held(model: uf.Model, keys: dict[str, Any], s: float, area: float) -> list[Step]:
    """A holder by force, on a spring, or at a gap."""
    gap = 0.0 if keys["held"] != "gap" else keys["gap"]
    holder = _tool(model, keys, "upper", uf.Plane((0.0, 0.0, s * (0.5 + gap)), (0.0, 0.0, -1.0)), "holder")
    force = keys["pressure"] * UNITS[keys["units"]][1] * area * s**2
    if keys["held"] == "spring":
        model.spring(holder, "z", stiffness=force / s, preload=-force, name="hold")
    return [uf.Move(model.press(holder, "z", name="hold"), -force, steps=2)] if keys["held"] == "force" else []


def _ended(model: uf.Model, steps: list[Step], keys: dict[str, Any], ram: Any) -> uf.Result:
    return solve(model, [*steps, *([uf.Release(ram)] if keys["end"] == "release" else [])])


def _symmetry(model: uf.Model) -> list[float]:
    """How far the answer is from its image in the diagonal, unless the law has directions."""
    return [] if getattr(model.bodies.only.material, "directional", False) else [unlike(model, model, DIAGONAL)]


def draw_box(drawing: Drawing) -> dict[str, Any]:
    """A box, square or not."""
    corner, edge, nose = drawing.ratio(4.0, 12.0), drawing.ratio(3.0, 6.0), drawing.ratio(3.0, 6.0)
    half = corner + drawing.between(4.0, 20.0)
    stroke = drawing.between(0.5, 1.5) * (edge + nose)
    return _draw(drawing) | {
        "half": half,
        "aspect": drawing.one_of((1.0, 1.0, drawing.between(1.0, 1.5))),
        "corner": max(corner, nose + 1.0),
        "edge": edge,
        "nose": nose,
        "clearance": drawing.between(1.1, 1.4),
        "flange": edge + drawing.between(3.0, 8.0) + 0.5 * stroke,
        "held": drawing.one_of(("force", "spring", "gap")),
        "gap": drawing.between(0.02, 0.15),
        "pressure": drawing.ratio(0.5, 4.0),
        "stroke": stroke,
        "cells": drawing.whole(8, 10),
    }


def run_box(keys: dict[str, Any]) -> Done:
    """A box under a holder."""
    sides = [keys["half"], keys["aspect"] * keys["half"]]
    ends = [side + keys["clearance"] + keys["flange"] for side in sides]
    lines = [np.linspace(0.0, end, keys["cells"] + 1) for end in ends]
    model, s = _model(keys, uf.mesh.grid(*lines, (-0.5, 0.5)))
    far, c = 9.0 * max(ends), keys["clearance"]
    below = _profile(s, [(far, -0.5), (0.0, -0.5), (0.0, -far)], keys["edge"])
    above = _profile(s, [(-2.0 * keys["corner"], 0.5), (0.0, 0.5), (0.0, far)], keys["nose"])
    outer = tuple(2.0 * s * (side + c) for side in sides)
    _tool(model, keys, "lower", uf.LedAround(below, size=outer, corner=s * (keys["corner"] + c)), "die")
    inner = tuple(2.0 * s * side for side in sides)
    punch = _tool(model, keys, "upper", uf.LedAround(above, size=inner, corner=s * keys["corner"]), "punch")
    steps = _held(model, keys, s, ends[0] * ends[1] - sides[0] * sides[1])
    ram = model.drive(punch, "-z", name="stroke")
    steps.append(uf.Move(ram, s * keys["stroke"], steps=increments(keys)))
    result = _ended(model, steps, keys, ram)
    square = _symmetry(model) if keys["aspect"] == 1.0 else []
    return judged(Answer([result], square, [carried(result, ["die", "punch", "holder"])]))


def draw_flanging(drawing: Drawing) -> dict[str, Any]:
    """A hole that a ball or a flat punch widens to a collar; the outside is clamped, or under a holder."""
    edge = drawing.ratio(2.0, 5.0)
    radius = drawing.ratio(6.0, 20.0)
    return _draw(drawing) | {
        "radius": radius,
        "hole": radius * drawing.between(0.4, 0.8),
        "edge": edge,
        "nose": min(drawing.ratio(2.0, 6.0), 0.6 * radius),
        "clearance": drawing.between(1.0, 1.5),
        "flange": drawing.between(4.0, 10.0),
        "punch": drawing.one_of(("ball", "flat")),
        "held": drawing.one_of(("clamp", "force", "gap")),
        "gap": drawing.between(0.02, 0.1),
        "pressure": drawing.ratio(1.0, 10.0),
        "part": drawing.between(0.3, 1.0),
        "cells": (drawing.one_of((4, 6)), drawing.whole(8, 12)),
    }


def run_flanging(keys: dict[str, Any]) -> Done:
    """A flanged hole."""
    R, opening = keys["radius"], keys["radius"] + keys["clearance"]
    outer = opening + keys["edge"] + keys["flange"]
    model, s = _model(keys, uf.mesh.ring(keys["hole"], outer, 1.0, keys["cells"], part="quarter"))
    far = 9.0 * outer
    die = _profile(s, [(far, -0.5), (opening, -0.5), (opening, -far)], keys["edge"])
    _tool(model, keys, "lower", uf.Revolved(die), "die")
    if keys["punch"] == "ball":
        # The ball touches the edge of the hole first.
        height = 0.5 + (R**2 - keys["hole"] ** 2) ** 0.5
        punch = _tool(model, keys, "upper", uf.Sphere((0.0, 0.0, s * height), s * R), "punch")
        way = height + R
    else:
        flat = _profile(s, [(0.0, 0.5), (R, 0.5), (R, far)], keys["nose"])
        punch = _tool(model, keys, "upper", uf.Revolved(flat), "punch")
        way = opening - keys["hole"] + keys["edge"]
    names, steps = ["die", "punch"], list[Step]()
    if keys["held"] == "clamp":
        model.fix("rim")
    else:
        steps, names = _held(model, keys, s, 0.8 * (outer**2 - opening**2)), [*names, "holder"]
    ram = model.drive(punch, "-z", name="stroke")
    steps.append(uf.Move(ram, s * keys["part"] * way, steps=increments(keys)))
    result = _ended(model, steps, keys, ram)
    return judged(Answer([result], _symmetry(model), [] if keys["held"] == "clamp" else [carried(result, names)]))


def draw_bulge(drawing: Drawing) -> dict[str, Any]:
    """A clamped disc under pressure, along its path past the largest pressure, to a height or before it bursts."""
    return (
        _draw(drawing)
        | {
            "law": drawing.one_of(("linear", "swift", "voce", "perfect", "DC04", "DP600")),
            "radius": drawing.ratio(15.0, 60.0),
            "height": drawing.between(0.5, 1.0),
            "die": drawing.chance(0.4),
            "edge": drawing.ratio(2.0, 8.0),
            "increment": drawing.one_of((0.02, 0.05, 0.1)),
            "cells": (drawing.whole(2, 4), drawing.whole(5, 8)),
        }
        | {"units": "mm"}
    )


def run_bulge(keys: dict[str, Any]) -> Done:
    """A bulge along its path."""
    R = keys["radius"]
    model, s = _model(keys, uf.mesh.disc(R, 1.0, keys["cells"], part="quarter"))
    model.fix("rim")
    if keys["die"]:
        corners = [(0.8 * R, 9.0 * R), (0.8 * R, 0.5), (9.0 * R, 0.5)]
        _tool(model, keys, "upper", uf.Revolved(_profile(s, corners, keys["edge"])), "die")
    load = model.pressure("lower", name="pressure")
    half = model.mesh.connectivity.shape[1] // 2
    lower, upper = model.mesh.connectivity[:, :half], model.mesh.connectivity[:, half:]
    high = s * keys["height"] * (0.8 if keys["die"] else 1.0) * R

    def reached(now: uf.Model) -> bool:
        x = now.positions
        return bool(x[:, 2].max() >= high or np.linalg.norm(x[upper] - x[lower], axis=-1).min() < 0.6 * s)

    # The pressure of a thin sphere of the radius of the disc, far above what the sheet bears.
    far = 20.0 * 600.0 / R
    arc = uf.Arc(load, far, increment=0.1 * keys["increment"], until=reached, most=300)
    return judged(Answer([solve(model, arc)], _symmetry(model)))


def draw_nakajima(drawing: Drawing) -> dict[str, Any]:
    """A clamped specimen of some width over a ball."""
    radius = drawing.ratio(15.0, 60.0)
    return _draw(drawing) | {
        "radius": radius,
        "half": radius * drawing.between(1.1, 1.4),
        "width": drawing.one_of((0.2, 0.4, 0.6, 1.0)),
        "stroke": radius * drawing.between(0.2, 0.7),
        "cells": drawing.whole(9, 13),
        "apart": drawing.one_of((0.0, 0.0, 0.5)),
    }


def run_nakajima(keys: dict[str, Any]) -> Done:
    """A ball, from touch or from a distance."""
    R, half, n = keys["radius"], keys["half"], keys["cells"]
    wide = keys["width"] == 1.0
    lines = np.linspace(0.0, half, n + 1), np.linspace(0.0, half * keys["width"], max(3, round(n * keys["width"])) + 1)
    model, s = _model(keys, uf.mesh.grid(*lines, (-0.5, 0.5)))
    model.fix(np.union1d(model.mesh.nodes("x1"), model.mesh.nodes("y1")) if wide else "x1")
    punch = _tool(model, keys, "lower", uf.Sphere((0.0, 0.0, -s * (0.5 + R + keys["apart"])), s * R), "punch")
    ram = model.drive(punch, "z", name="stroke")
    steps: list[Step] = [uf.Move(ram, s * (keys["stroke"] + keys["apart"]), steps=increments(keys))]
    result = _ended(model, steps, keys, ram)
    return judged(Answer([result], _symmetry(model) if wide else []))


def draw_stretch(drawing: Drawing) -> dict[str, Any]:
    """A sheet in grips is pulled, and wrapped over a form."""
    half = drawing.ratio(30.0, 120.0)
    return _draw(drawing) | {
        "half": half,
        "width": drawing.between(0.2, 0.8),
        "form": drawing.one_of(("cylinder", "ball", "barrel")),
        "radius": drawing.between(0.8, 2.0),
        "before": drawing.one_of((0.0, 0.002, 0.01, 0.03)),
        "height": drawing.between(0.1, 0.35),
        "after": drawing.one_of((0.0, 0.005, 0.02)),
        "cells": (drawing.whole(10, 16), drawing.whole(3, 6)),
    }


def run_stretch(keys: dict[str, Any]) -> Done:
    """Pull, wrap by the rise of the form, pull again."""
    half, R = keys["half"], keys["radius"] * keys["half"]
    model, s = _model(keys, uf.mesh.strip(half, keys["width"] * half, 1.0, tuple(keys["cells"])))
    model.fix("x1", "z")
    grip = model.prescribe("x1", "x", "grip")
    low = -s * (0.5 + R)
    form: uf.surfaces.Surface = uf.Cylinder((0.0, 0.0, low), "y", s * R)
    if keys["form"] == "ball":
        form = uf.Sphere((0.0, 0.0, low), s * R)
    elif keys["form"] == "barrel":
        form = uf.Torus((0.0, 0.0, low), "y", 0.6 * s * R, 0.4 * s * R)
    block = _tool(model, keys, "lower", form, "form")
    ram, pace = model.drive(block, "z", name="stroke"), increments(keys)
    pulls = [keys["before"] * half * s, (keys["before"] + keys["after"]) * half * s]
    steps: list[Step] = [uf.Move(grip, pulls[0], steps=5)] if keys["before"] else []
    steps.append(uf.Move(ram, s * keys["height"] * half, steps=pace))
    steps += [uf.Move(grip, pulls[1], steps=10)] if keys["after"] else []
    return judged(Answer([_ended(model, steps, keys, ram)]))

"""The cups and U-bends of the processes: their parameters in the range of a press shop."""

from __future__ import annotations

from typing import Any

import umform as uf
from corpus.laws import law
from corpus.ready import draw
from forming.sheets import THICKNESSES, draw_increments, draw_law, increments, judged
from jobs.drawing import Drawing
from jobs.lot import Done
from umform.processes.draw.cup import Cup
from umform.processes.draw.u_bend import UBend


def draw_cup(drawing: Drawing) -> dict[str, Any]:
    """A cup on a coarse mesh, of any metal, to a part of its depth or through the die."""
    t = drawing.one_of([thickness for thickness in THICKNESSES if thickness <= 4.0])
    radius = t * drawing.ratio(8.0, 30.0)
    edges = [t * drawing.ratio(3.0, 8.0) for _ in range(2)]
    opening = radius + t * drawing.between(1.1, 1.4)
    blank = radius * drawing.between(1.4, 2.0)
    return (
        draw_law(drawing)
        | draw_increments(drawing)
        | {
            "units": "mm",
            "thickness": t,
            "blank_radius": max(blank, opening + edges[1] + 2.0 * t),
            "punch_radius": radius,
            "punch_edge": min(edges[0], 0.6 * radius),
            "die_radius": opening,
            "die_edge": edges[1],
            "held": drawing.one_of(("force", "force", "gap")),
            "pressure": drawing.ratio(0.5, 4.0),
            "holder_gap": t * drawing.between(1.02, 1.15),
            "friction": drawing.one_of((0.0, 0.05, 0.1, 0.15, 0.2)),
            "stroke": drawing.between(0.3, 1.2) * radius,
            "turn": drawing.between(22.0, 32.0),
            "around": 6,
        }
    )


def draw_u_bend(drawing: Drawing) -> dict[str, Any]:
    """A U-bend on a coarse mesh."""
    t = drawing.one_of(THICKNESSES)
    edges = [t * drawing.ratio(2.0, 8.0) for _ in range(2)]
    width = 2.0 * edges[0] + t * drawing.between(10.0, 50.0)
    stroke = t * drawing.between(8.0, 40.0)
    opening = width + 2.0 * t * drawing.between(1.1, 1.4)
    return (
        draw_law(drawing)
        | draw_increments(drawing)
        | {
            "units": "mm",
            "thickness": t,
            "length": opening + 2.0 * (edges[1] + stroke + t * drawing.between(5.0, 20.0)),
            "width": 20.0 * t,
            "punch_width": width,
            "punch_edge": edges[0],
            "opening": opening,
            "die_edge": edges[1],
            "pressure": drawing.ratio(0.3, 3.0),
            "friction": drawing.one_of((0.0, 0.02, 0.05, 0.1, 0.15, 0.2)),
            "stroke": stroke,
            "element": drawing.one_of(("BEND8", "BEND8", "BEND18")),
            "turn": drawing.between(22.0, 32.0),
        }
    )


def case(keys: dict[str, Any]) -> Cup | UBend:
    """The parameters of the process."""
    own = {name: value for name, value in keys.items() if name not in _OURS}
    own |= {"material": law(keys["law"])["material"]}
    steps = increments(keys)
    own |= {"pace": steps} if isinstance(steps, uf.Pace) else {}
    if "opening" in keys:
        flange = keys["width"] * (keys["length"] - keys["opening"] - 2.0 * keys["die_edge"])
        return UBend(**own, holder_force=keys["pressure"] * flange, contact_points=3)
    flange = 3.14 * (keys["blank_radius"] ** 2 - (keys["die_radius"] + keys["die_edge"]) ** 2)
    held = {"holder_force": keys["pressure"] * flange} if keys["held"] == "force" else {}
    return Cup(**own, **held)


_OURS = ("law", "units", "steps", "pace", "held", "pressure")


def run(keys: dict[str, Any]) -> Done:
    """Close, draw and open."""
    given = case(keys)
    return judged(draw(given, given.newton), given.newton.residual)

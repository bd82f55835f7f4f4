"""(a) A strip of J2 bent over a cylinder in plane strain: the problem of the page bend-over-cylinder, H = 500 MPa."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np
from entries import Entry
from meshes import grid, held
from problem import Problem, Tool
from ratios import Comparison, Found

from umform.verification.references import table as stored
from umform.verification.sharp_bends.candidates import KAPPA, MU, YIELD_STRESS
from umform.verification.sharp_bends.over_cylinder import MARKS, PAPER
from umform.verification.sharp_bends.strips import THICKNESS, WIDTH

TITLE = "(a) Strip of J2 bent over a cylinder"
GOAL = 20.0
#: Facets of the tool in CalculiX: 400 give the same forces to 0.1 % and take 1.6 times as long.
FACETS = 100
CELLS = {"BEND8": "hex8", "BEND18": "hex18", "EAS3DEAS": "hex8", "C3D8I": "hex8", "C3D20R": "hex20"}
STACK = {"model": {"thickness_order": 2, "tie_E33": True, "thickness_points": 4, "thickness_rule": "gauss"}}
#: Code, element, cells along, layers.
MESHES = (
    *(("umform", "BEND8", n, 1) for n in (24, 48, 96)),
    *(("umform", "BEND18", n, 1) for n in (12, 24, 48)),
    *(("CalculiX", "C3D8I", n, k) for n, k in ((24, 1), (48, 1), (96, 1), (48, 2), (96, 4))),
    *(("CalculiX", "C3D20R", n, k) for n, k in ((12, 1), (24, 1), (48, 1), (96, 1), (48, 2), (96, 4))),
)
FINEST = ("umform", "EAS3DEAS", 192, 4)
#: The finest mesh of CalculiX with contact whose forces the book stores: 6 layers, 400 facets.
STORED = "calculix_cylinder_H500_6_layers.csv"


def build(
    cells: int, layers: int, cell: str, across: int = 0, levels: int = PAPER.steps, stroke: float = PAPER.stroke
) -> Problem:
    """Half of the strip, one cell wide, every node held across."""
    z = np.linspace(-0.5 * THICKNESS, 0.5 * THICKNESS, layers + 1)
    y = np.linspace(0.0, 0.5 * WIDTH, across + 1) if across else [0.0, 1.0]
    points, ids = grid(np.linspace(0.0, PAPER.length, cells + 1), y, z, cell)
    x0, lower, y0 = points[:, 0] == 0.0, points[:, 2] == z[0], points[:, 1] == 0.0
    young, nu = 9 * KAPPA * MU / (3 * KAPPA + MU), (3 * KAPPA - 2 * MU) / (2 * (3 * KAPPA + MU))
    return Problem(
        points=points,
        cells=ids,
        young=young,
        poisson=nu,
        fixed=held((x0, "x"), (y0 if across else points[:, 1] >= 0.0, "y")),
        probes={"top": np.flatnonzero(x0 & (points[:, 2] == z[-1]))},
        levels=levels,
        flow=(YIELD_STRESS, PAPER.hardening),
        pushed=np.flatnonzero(x0 & lower),
        stroke=-stroke,
        tool=Tool(25.0, -0.5 * THICKNESS - PAPER.radius, PAPER.radius, 100.0, FACETS),
        touching=np.flatnonzero(lower[ids[:, :4]].all(axis=1)),
        thickness=THICKNESS,
    )


def _entry(peer: str, element: str, cells: int, layers: int) -> Entry:
    options: Mapping[str, Any] = STACK if element == "EAS3DEAS" else {}
    return Entry(peer, element, f"{cells} x 1 x {layers}", partial(build, cells, layers, CELLS[element]), options)


def entries(short: bool) -> list[Entry]:
    """Runs of the comparison; short: a coarse mesh and a small stroke."""
    if short:
        small = {"levels": 4, "stroke": 1.0}
        return [
            Entry("umform", "BEND8", "12 x 1 x 1", partial(build, 12, 1, "hex8", **small)),
            Entry("CalculiX", "C3D8I", "12 x 1 x 1", partial(build, 12, 1, "hex8", **small)),
        ]
    return [_entry(*mesh) for mesh in (*MESHES, FINEST)]


def measures(found: Found) -> dict[str, dict[str, float]]:
    """Forces on a width of 10, thickness of the hinge, and the largest deviation of the forces from two references.

    The references are the finest stack of umform and the finest mesh of CalculiX that is stored; they part by up to
    3 % (see the page), so the error of a run is that from the finest mesh of its own code.
    """
    stroke = PAPER.stroke
    reachable = {key: outcome for key, (_, outcome) in found.items() if outcome.level[-1] * stroke >= MARKS[-1] - 1e-6}
    forces = {
        key: np.interp(MARKS, o.level * stroke, -WIDTH * o.force) for key, o in reachable.items() if len(found) > 2
    }
    fine = stored(STORED)
    references = {"CalculiX": np.interp(MARKS, fine["u"], fine["force"])}
    finest = _entry(*FINEST).key
    if finest in forces:
        references["umform"] = forces[finest]
    made: dict[str, dict[str, float]] = {}
    for key, force in forces.items():
        made[key] = {f"F({u:g})": f for u, f in zip(MARKS, force, strict=True)}
        made[key] |= {f"off {name}, %": 100 * np.abs(force / fine - 1).max() for name, fine in references.items()}
        made[key]["thickness"] = THICKNESS + found[key][1].probes["top"][2] + stroke
    return made


def comparisons(found: Found) -> list[Comparison]:
    """On the same mesh; and, for each run of CalculiX, the cheapest run of umform that is not further off."""
    made = []
    for key, (entry, _) in found.items():
        same = [k for k, (e, _) in found.items() if e.element == "BEND8" and e.mesh == entry.mesh]
        if entry.peer == "CalculiX" and same:
            made.append(Comparison("same mesh", same[0], key))
    error = {key: row[f"off {found[key][0].peer}, %"] for key, row in measures(found).items()}
    finest = _entry(*FINEST).key
    for key, off in error.items():
        as_good = [k for k, e in error.items() if found[k][0].peer == "umform" and e <= off and k != finest]
        if found[key][0].peer == "CalculiX" and as_good:
            cheapest = min(as_good, key=lambda k: found[k][1].cost.cpu)
            made.append(Comparison(f"{off:.2g} % against {error[cheapest]:.2g} %", cheapest, key, GOAL))
    return made

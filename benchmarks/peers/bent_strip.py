"""(a) A strip of J2 bent over a cylinder in plane strain: the problem of the page bend-over-cylinder, H = 500 MPa."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np
from entries import Entry
from meshes import grid, held
from ratios import Comparison, Found, as_good

from problem import Problem, Tool
from umform_book.references import table as stored
from umform_book.sharp_bends.candidates import KAPPA, MU, YIELD_STRESS
from umform_book.sharp_bends.over_cylinder import MARKS, PAPER
from umform_book.sharp_bends.strips import THICKNESS, WIDTH

TITLE = "(a) Strip of J2 bent over a cylinder, plane strain"
GOALS = {"C3D8I": 25.0, "C3D20R": 15.0}
#: Facets of the tool in CalculiX: 400 give the same forces to 0.1 % and take 1.6 times as long.
FACETS = 100
CELLS = {"BEND8": "hex8", "BEND18": "hex18", "EAS3DEAS": "hex8", "C3D8I": "hex8", "C3D20R": "hex20"}
#: BEND8 and BEND18 with what a force needs: order 4, these points or the number given. The default is for springback.
FORCES: dict[str, Any] = {"thickness_order": 4, "thickness_points": 12, "thickness_rule": "split"}
#: All nodes are held across: the same forces without the modes and the numerical integration across.
HELD: dict[str, Any] = {"plane_strain": True}
STACK = {"model": {"thickness_order": 2, "tie_E33": True, "thickness_points": 4, "thickness_rule": "gauss"}}
#: Code, element, cells along, layers.
MESHES = (
    *(("umform", "BEND8", n, 1) for n in (16, 24, 32, 40, 48, 96)),
    *(("umform", "BEND18", n, 1) for n in (12, 24, 48)),
    *(("CalculiX", "C3D8I", n, k) for n, k in ((24, 1), (48, 1), (96, 1), (48, 2))),
    *(("CalculiX", "C3D20R", n, k) for n, k in ((24, 1), (48, 1), (96, 1), (48, 2), (96, 4))),
)
FINEST = ("umform", "EAS3DEAS", 192, 4)
#: The finest mesh of CalculiX with contact whose forces the book stores: 6 layers, 400 facets.
STORED = "calculix_cylinder_H500_6_layers.csv"


def build(
    cells: int, layers: int, cell: str, across: int = 0, levels: int = PAPER.steps, stroke: float = PAPER.stroke
) -> Problem:
    """Half of the strip: one cell wide with all nodes held across; or so many cells over half of its width, free."""
    z = np.linspace(-0.5 * THICKNESS, 0.5 * THICKNESS, layers + 1)
    y = np.linspace(0.0, 0.5 * WIDTH, across + 1) if across else [0.0, 1.0]
    points, ids = grid(np.linspace(0.0, PAPER.length, cells + 1), y, z, cell)
    x0, lower, y0 = points[:, 0] == 0.0, points[:, 2] == z[0], points[:, 1] == 0.0
    return Problem(
        points=points,
        cells=ids,
        young=9 * KAPPA * MU / (3 * KAPPA + MU),
        poisson=(3 * KAPPA - 2 * MU) / (2 * (3 * KAPPA + MU)),
        fixed=held((x0, "x"), (y0 if across else np.full(len(points), True), "y")),
        probes={"top": np.flatnonzero(x0 & (points[:, 2] == z[-1]))},
        levels=levels,
        flow=(YIELD_STRESS, PAPER.hardening),
        pushed=np.flatnonzero(x0 & lower),
        stroke=-stroke,
        tool=Tool(25.0, -0.5 * THICKNESS - PAPER.radius, PAPER.radius, 100.0, FACETS),
        touching=np.flatnonzero(lower[ids[:, :4]].all(axis=1)),
        thickness=THICKNESS,
    )


def entry(
    peer: str, element: str, cells: int, layers: int, across: int = 0, loose: float = 0.0, points: int = 0
) -> Entry:
    """A run on so many cells along, across and through the thickness.

    Parameters
    ----------
    loose : float
        Tolerance of the residual, with one of a hundredth for the increment; default: those of the code.
    points : int
        Gauss points through the thickness; default: those of ``FORCES``.
    """
    newton = {"newton": {"residual": loose, "increment": 1e-2}} if loose else {}
    model = FORCES | ({} if across else HELD)
    model |= {"thickness_points": points, "thickness_rule": "gauss"} if points else {}
    options: Mapping[str, Any] = (
        STACK if element == "EAS3DEAS" else {"model": model} if peer == "umform" else {}
    ) | newton
    made = partial(build, cells, layers, CELLS[element], across)
    mesh = f"{cells} x {max(across, 1)} x {layers}"
    notes = [f"{points} points"] * (points > 0) + [f"tolerance {loose:.0e}".replace("e-0", "e-")] * (loose > 0)
    return Entry(peer, element, mesh, made, options, ", ".join(notes))


def entries(short: bool) -> list[Entry]:
    """Runs of the comparison; short: a coarse mesh, a small stroke, enough points through the thickness."""
    if short:
        made = {n: partial(build, 24, n, "hex8", levels=4, stroke=1.0) for n in (1, 2)}
        return [Entry("umform", "BEND8", "24 x 1 x 1", made[1]), Entry("CalculiX", "C3D8I", "24 x 1 x 2", made[2])]
    # CalculiX ends its iterations at 5e-3; its two layers of C3D8I have four points through the thickness.
    loose = [entry(*mesh, loose=tolerance) for tolerance in (5e-3, 1e-4) for mesh in MESHES if mesh[1] == "BEND8"]
    loose += [entry("umform", "BEND8", n, 1, loose=5e-3, points=6) for n in (12, 16, 24, 32)]
    return [*loose, *(entry(*mesh) for mesh in (*MESHES, FINEST))]


#: Runs that others are compared with, and that compete with none.
FINE = (entry(*FINEST).key,)


def forces(found: Found, width: float) -> dict[str, Any]:
    """Forces on a width of 10 at the marks, of the runs that reach them."""
    last = MARKS[-1] * (1 - 1e-9)
    return {key: np.interp(MARKS, o.u, width * o.force) for key, (_, o) in found.items() if o.u[-1] >= last}


def deviations(found: Found, width: float, references: Mapping[str, Any]) -> dict[str, dict[str, float]]:
    """Forces, their largest deviation from each reference, and the thickness of the hinge at the end."""
    made: dict[str, dict[str, float]] = {}
    for key, force in forces(found, width).items():
        made[key] = {f"F({u:g})": f for u, f in zip(MARKS, force, strict=True)}
        made[key] |= {f"off {name}, %": 100 * np.abs(force / fine - 1).max() for name, fine in references.items()}
        made[key]["thickness"] = THICKNESS + found[key][1].probes["top"][2] + PAPER.stroke
    return made


def measures(found: Found) -> dict[str, dict[str, float]]:
    """Deviations from the finest stack of umform, from the finest mesh of CalculiX that is stored, and from their mean.

    The two part by up to 1 %; the mean favours neither, and is what the errors are counted from.
    """
    fine = stored(STORED)
    references = {"CalculiX": np.interp(MARKS, fine["u"], fine["force"])}
    finest = entry(*FINEST).key
    if finest in found:
        references["umform"] = forces(found, WIDTH)[finest]
        references["their mean"] = 0.5 * (references["CalculiX"] + references["umform"])
    return deviations(found, WIDTH, references)


def comparisons(found: Found) -> list[Comparison]:
    """On the same mesh; and, for each run of CalculiX, the cheapest run of umform that is not further off."""
    rows = measures(found)
    error = {key: row.get("off their mean, %", np.inf) for key, row in rows.items() if key not in FINE}
    return same_mesh(found) + as_good(found, error, GOALS)


def same_mesh(found: Found) -> list[Comparison]:
    """BEND8 against each element of CalculiX on the same mesh, as tight as umform iterates of itself."""
    own = {e.mesh: key for key, (e, _) in found.items() if e.element == "BEND8" and not e.note}
    others = {key: e.mesh for key, (e, _) in found.items() if e.peer == "CalculiX"}
    return [Comparison("same mesh", own[mesh], key) for key, mesh in others.items() if mesh in own]

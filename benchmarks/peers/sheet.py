"""(c) One linear step of a clamped sheet of 100 000 hexahedra under a line load."""

from __future__ import annotations

from functools import partial

import numpy as np
from entries import Entry
from meshes import grid, held
from ratios import Comparison, Found

from problem import Problem

TITLE = "(c) One linear step, 100 000 hexahedra"
GOAL = 5.0
LENGTH, WIDTH, THICKNESS, YOUNG, LOAD = 1000.0, 400.0, 1.0, 210e3, 0.01
FULL = (500, 200)
#: For solvers whose factors of the full sheet do not fit into an ordinary machine.
SMALL = (160, 64)


def build(along: int, across: int, cell: str) -> Problem:
    """Sheet clamped at x = 0, a vertical load of so much per length on the other end."""
    z = [-0.5 * THICKNESS, 0.5 * THICKNESS]
    y = np.linspace(0.0, WIDTH, across + 1)
    points, ids = grid(np.linspace(0.0, LENGTH, along + 1), y, z, cell)
    clamped, end = points[:, 0] == 0.0, points[:, 0] == LENGTH
    corner = np.abs(points[:, 1] - 0.5 * WIDTH) == 0.5 * WIDTH
    weight = np.where(end, np.where(corner, 0.5, 1.0), 0.0)
    forces = np.zeros_like(points)
    forces[:, 2] = LOAD * WIDTH * weight / weight.sum()
    return Problem(
        points=points,
        cells=ids,
        young=YOUNG,
        poisson=0.3,
        fixed=held((clamped, "xyzuvw" if cell == "quad4" else "xyz")),
        probes={"end": np.flatnonzero(end)},
        forces=forces,
        large=False,
        thickness=THICKNESS,
    )


def _entry(peer: str, element: str, cells: tuple[int, int], solver: str = "", cell: str = "hex8") -> Entry:
    options = {"solver": solver} if solver else {}
    mesh = f"{cells[0]} x {cells[1]}"
    return Entry(peer, element, mesh, partial(build, *cells, cell), options, solver.capitalize())


def entries(short: bool) -> list[Entry]:
    """Runs of the comparison; short: 20 x 8 hexahedra."""
    if short:
        return [_entry("umform", "ANS3DEAS", (20, 8)), _entry("CalculiX", "C3D8I", (20, 8))]
    return [
        _entry("umform", "ANS3DEAS", FULL),
        _entry("CalculiX", "C3D8I", FULL),
        _entry("umform", "ANS3DEAS", SMALL),
        _entry("umform", "ANS3DEAS", SMALL, "superlu"),
        _entry("CalculiX", "C3D8I", SMALL),
        _entry("felupe", "Hexahedron", SMALL),
        _entry("GetFEM", "FEM_QK(3,1)", SMALL),
        _entry("Kratos", "SmallDisplacementElement3D8N", SMALL),
        _entry("Kratos", "ShellThinElementCorotational3D4N", SMALL, cell="quad4"),
    ]


def measures(found: Found) -> dict[str, dict[str, float]]:
    """Mean deflection of the end, and over that of a beam: P l^3 / (3 E I) + shear, without the effect of Poisson."""
    beam = LOAD * LENGTH**3 / (3 * YOUNG * THICKNESS**3 / 12)
    return {key: {"w": o.probes["end"][2], "w over beam": o.probes["end"][2] / beam} for key, (_, o) in found.items()}


def comparisons(found: Found) -> list[Comparison]:
    """Each run of another code against umform with its fastest solver on as many cells."""
    full = f"{FULL[0]} x {FULL[1]}"
    own = {e.mesh: key for key, (e, _) in found.items() if e.peer == "umform" and not e.note}
    return [
        Comparison("same mesh", own[e.mesh], key, GOAL if (e.peer, e.mesh) == ("CalculiX", full) else None)
        for key, (e, _) in found.items()
        if e.peer != "umform" and e.mesh in own
    ]

"""(c) One linear step of a clamped sheet of 100 000 hexahedra under a line load."""

from __future__ import annotations

from functools import partial

import numpy as np
from entries import Entry
from meshes import grid, held
from problem import Problem
from ratios import Comparison, Found

TITLE = "(c) One linear step, 100 000 hexahedra"
GOAL = 4.0
LENGTH, WIDTH, THICKNESS, YOUNG, LOAD = 1000.0, 400.0, 1.0, 210e3, 0.01


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


def entries(short: bool) -> list[Entry]:
    """Runs of the comparison; short: 20 x 8 hexahedra."""
    cells = (20, 8) if short else (500, 200)
    mesh = f"{cells[0]} x {cells[1]}"
    solid = partial(build, *cells, "hex8")
    made = [
        Entry("umform", "ANS3DEAS", mesh, solid),
        Entry("CalculiX", "C3D8I", mesh, solid),
        Entry("CalculiX", "C3D8I", mesh, solid, {"solver": "ITERATIVE CHOLESKY"}, "iterative"),
    ]
    if short:
        return made[:2]
    return [
        *made,
        Entry("umform", "ANS3DEAS", mesh, solid, {"solver": "superlu"}, "SuperLU"),
        Entry("felupe", "Hexahedron", mesh, solid),
        Entry("Kratos", "SmallDisplacementElement3D8N", mesh, solid),
        Entry("Kratos", "ShellThinElementCorotational3D4N", mesh, partial(build, *cells, "quad4")),
    ]


def measures(found: Found) -> dict[str, dict[str, float]]:
    """Mean deflection of the end, and over that of a beam: P l^3 / (3 E I) + shear, without the effect of Poisson."""
    beam = LOAD * LENGTH**3 / (3 * YOUNG * THICKNESS**3 / 12)
    return {key: {"w": o.probes["end"][2], "w over beam": o.probes["end"][2] / beam} for key, (_, o) in found.items()}


def comparisons(found: Found) -> list[Comparison]:
    """Each run of another code against the first of umform."""
    own = [key for key, (e, _) in found.items() if e.peer == "umform"][:1]
    return [
        Comparison("same mesh", mine, key, GOAL if e.peer == "CalculiX" else None)
        for mine in own
        for key, (e, _) in found.items()
        if e.peer != "umform"
    ]

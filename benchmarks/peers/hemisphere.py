"""(b) Pinched hemisphere with a hole, P = 400 on the quarter: the problem of the page nonlinear-hemisphere."""

from __future__ import annotations

from functools import partial

import numpy as np
from entries import LOOSE, Entry
from meshes import grid, held
from ratios import Comparison, Found, as_good

from problem import Problem
from umform_book.nonlinear.hemisphere import FORCE
from umform_book.references import table as stored
from umform_book.shells import onto_hemisphere

TITLE = "(b) Pinched hemisphere, P = 400"
GOAL = 12.0
RADIUS, THICKNESS, LEVELS = 10.0, 0.04, 20
TIED = {"model": {"tie_E33": True}}
KRATOS_SHELL = "ShellThinElementCorotational3D4N"
FINE = 48
#: The table is so many % above what meshes of 64 intervals find (see the page): errors below count as equal.
UNCERTAIN = 0.4


def build(cells: int, cell: str, levels: int = LEVELS) -> Problem:
    """Quarter with half of each force, in equal parts on the lower and the upper node."""
    line = np.linspace(0.0, 1.0, cells + 1)
    flat, ids = grid(line, line, [-0.5 * THICKNESS, 0.5 * THICKNESS], cell)
    y0, y1, equator = flat[:, 1] == 0.0, flat[:, 1] == 1.0, flat[:, 0] == 1.0
    outside = np.abs(flat[:, 2]) == 0.5 * THICKNESS if cell != "quad4" else np.full(len(flat), True)
    at_B, at_A = (np.flatnonzero(equator & side & outside) for side in (y0, y1))
    forces = np.zeros_like(flat)
    forces[at_B, 0], forces[at_A, 1] = -0.5 * FORCE / len(at_B), 0.5 * FORCE / len(at_A)
    one = np.arange(len(flat)) == at_B[0]
    turns = ((y0, "uw"), (y1, "vw")) if cell == "quad4" else ()
    return Problem(
        points=onto_hemisphere(flat, RADIUS),
        cells=ids,
        young=6.825e7,
        poisson=0.3,
        fixed=held((y0, "y"), (y1, "x"), (one, "z"), *turns),
        probes={"at_B": at_B, "at_A": at_A},
        forces=forces,
        levels=levels,
        thickness=THICKNESS,
    )


def entries(short: bool) -> list[Entry]:
    """Runs of the comparison; short: a coarse mesh."""
    n = 4 if short else FINE
    levels = 40 if short else LEVELS
    mesh, half = f"{n} x {n}", f"{n // 2} x {n // 2}"
    made = [
        Entry("umform", "EAS3DEAS", mesh, partial(build, n, "hex8", levels), TIED),
        Entry("CalculiX", "C3D8I", mesh, partial(build, n, "hex8", levels)),
    ]
    if short:
        return made
    return [
        Entry("umform", "EAS3DEAS", mesh, partial(build, n, "hex8"), TIED | LOOSE, "tolerance 1e-4"),
        Entry("umform", "EAS3DEAS", "32 x 32", partial(build, 32, "hex8"), TIED | LOOSE, "tolerance 1e-4"),
        *made,
        Entry("umform", "ANS3DEAS", mesh, partial(build, n, "hex8"), TIED),
        Entry("umform", "MI9K3DEAS", half, partial(build, n // 2, "hex18"), TIED),
        Entry("CalculiX", "C3D20R", half, partial(build, n // 2, "hex20")),
        *(Entry("Kratos", KRATOS_SHELL, f"{k} x {k}", partial(build, k, "quad4")) for k in (16, 24)),
    ]


def measures(found: Found) -> dict[str, dict[str, float]]:
    """Displacements at full load and how far they are off the table of Sze, Liu & Lo."""
    reference = stored("sze_hemisphere.csv")
    inward, outward = float(reference["minus_u_B"][-1]), float(reference["v_A"][-1])
    made = {}
    for key, (_, outcome) in found.items():
        u_B, v_A = -outcome.probes["at_B"][0], outcome.probes["at_A"][1]
        made[key] = {
            "-u_B": u_B,
            "v_A": v_A,
            "off -u_B, %": 100 * (u_B / inward - 1),
            "off v_A, %": 100 * (v_A / outward - 1),
        }
    return made


def comparisons(found: Found) -> list[Comparison]:
    """EAS3DEAS and C3D8I on 48 x 48; then each other code's run and the cheapest of umform that is no further off."""
    mesh = f"{FINE} x {FINE}"
    mine = [key for key, (e, _) in found.items() if (e.element, e.mesh) == ("EAS3DEAS", mesh)]
    other = [key for key, (e, _) in found.items() if (e.element, e.mesh) == ("C3D8I", mesh)]
    same = [Comparison("same mesh", own, key, GOAL) for own in mine for key in other]
    error = {key: max(UNCERTAIN, abs(row["off -u_B, %"])) for key, row in measures(found).items()}
    return same + (as_good(found, error) if mine else [])

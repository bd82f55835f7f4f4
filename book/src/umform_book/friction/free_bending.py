"""The paper's example with friction, and the cost of friction: iterations and discarded evaluations."""

from __future__ import annotations

from statistics import median

import numpy as np
from numpy.typing import NDArray

from umform.analysis.run import Result
from umform.analysis.steps import Move
from umform.processes import FreeBending
from umform.processes.bending.case import build
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.contact.hertz_line import EIGHT
from umform_book.contact.rolling_edge import SHARP, WIDE
from umform_book.friction import bending_work, drawn
from umform_book.page import Page

COEFFICIENTS, MESHES, STEPS = (0.0, 0.1, 0.3), ((24, 1), (48, 1), (96, 1)), 100
#: Force over that without friction, at the marks of the paper, against that on the finest mesh.
EXPECTED = {24: 0.02, 48: 0.01}
#: Limits of the iterations with friction over those without, and of the share of discarded evaluations.
ITERATIONS, DISCARDED = 1.5, 0.15


def bend(page: Page, mesh: tuple[int, int], mu: float) -> Result:
    """The paper's example up to its stroke, with friction on the cylinder."""
    case = FreeBending(mesh=mesh, contact=5, steps=STEPS, unload=False)
    model, punch = build(case)
    if mu > 0:
        without = model.contacts[0]
        model.remove(without)  # nothing is held yet: it leaves no force
        model.contact(
            "lower", without.tool.surface, penalty=case.penalty, points=5, friction=mu, slip=0.005, name="rough"
        )
    return page.solve(f"{mesh[0]} elements, mu = {mu:g}", model, Move(punch, -case.stroke, steps=STEPS))


def forces(result: Result) -> NDArray[np.float64]:
    """Force of the punch at the marks."""
    case = FreeBending()
    return np.interp(case.marks, -result["punch"], np.abs(result["punch_force"]))


def per_increment(result: Result) -> float:
    """Iterations of an increment."""
    return float(result["iterations"].sum()) / (len(result["time"]) - 1)


def by_mesh(page: Page) -> dict[tuple[int, float], Result]:
    """Meshes and coefficients."""
    meshes = page.pick(MESHES, MESHES[:1])
    found = {(mesh[0], mu): bend(page, mesh, mu) for mu in COEFFICIENTS for mesh in page.each(meshes, str)}
    rows, finest = [], meshes[-1][0]
    for (count, mu), result in found.items():
        taken = float(result["friction_work"][-1] / result["external_work"][-1])
        rows.append((f"mu = {mu:g}", count, *forces(result).tolist(), 100 * taken))
        if count != finest and mu > 0:
            ratios = [forces(found[mesh, mu]) / forces(found[mesh, 0.0]) for mesh in (count, finest)]
            off = float(np.abs(ratios[0] / ratios[1] - 1.0).max())
            what = f"mu = {mu:g}, {count} elements: force over that without friction, against {finest} elements"
            page.at_most(what, off, EXPECTED[count])
        if mu > 0:
            drift = float(np.abs(result.balance().drift).max())
            page.at_most(f"mu = {mu:g}, {count} elements: drift of the balance", drift, 5e-3)
    marks = [f"F at {mark:g} mm" for mark in FreeBending().marks]
    page.table("Force of the punch and work of friction", ("", "elements", *marks, "friction, % of the work"), rows)
    curves = [
        Curve(f"mu = {mu:g}", -found[finest, mu]["punch"], np.abs(found[finest, mu]["punch_force"]))
        for mu in COEFFICIENTS
    ]
    page.figure("force", plot(curves, "displacement, mm", "force, N"), f"Force of the punch, {finest} elements")
    return found


def cost(page: Page, bent: dict[tuple[int, float], Result]) -> None:
    """Iterations with friction over those without, and discarded evaluations."""
    count = max(mesh for mesh, _ in bent)
    pairs = {f"free bending, mu = {mu:g}": (bent[count, mu], bent[count, 0.0]) for mu in COEFFICIENTS[1:]}
    if not page.short:
        for edge in (WIDE, SHARP):
            runs = [drawn.draw(page, edge, EIGHT, 120, 2, mu) for mu in (drawn.MU, 0.0)]
            pairs[f"elastic strip over R = {edge.radius:g}"] = (runs[0], runs[1])
        runs = [bending_work.draw(page, mu, 54, 100) for mu in (0.1, 0.0)]
        pairs["plastic strip over R = 8"] = (runs[0], runs[1])
    rows: list[tuple[str | float | None, ...]] = []
    ratios, evaluations, discarded = [], [0, 0], [0, 0]
    for label, pair in pairs.items():
        ratios.append(per_increment(pair[0]) / per_increment(pair[1]))
        attempts = [result.timing.attempts for result in pair]
        for k, attempt in enumerate(attempts):
            evaluations[k], discarded[k] = evaluations[k] + attempt.evaluations, discarded[k] + attempt.discarded
        shares = [100 * attempt.share for attempt in attempts]
        rows.append((label, *(round(value, 1) for value in (*map(per_increment, pair), ratios[-1], *shares))))
    share = [100 * discarded[k] / evaluations[k] for k in (0, 1)]
    rows.append(("all", None, None, *(round(value, 1) for value in (median(ratios), *share))))
    columns = (
        "",
        "iterations per increment",
        "without friction",
        "ratio",
        "discarded evaluations %",
        "without friction %",
    )
    page.table("Cost of friction; last row: median, sums", columns, rows)
    page.at_most("iterations per increment with friction over those without, median", float(median(ratios)), ITERATIONS)
    page.at_most("share of discarded evaluations, with friction", share[0] / 100, DISCARDED)


def run(page: Page) -> None:
    """Fill the page."""
    bent = by_mesh(page)
    page.heading("What friction costs")
    cost(page, bent)


CASE = Case(
    name="friction-free-bending",
    title="The paper's example with friction, and the cost of friction",
    problem=f"""
The paper's free bending ([reproduction](bending-reproduction.md)) with friction on the cylinder, mu = 0, 0.1, 0.3; 24,
48 and 96 elements ANS3DEAS along the strip, 5 x 5 contact points, allowed elastic slip 0.005, {STEPS} increments. Cost:
iterations per increment with and without friction, and the share of evaluations in discarded attempts, also for the
strips of the [capstan](friction-capstan.md) and of [bending and unbending](friction-bending-work.md).
""",
    reference="""
No external reference. The force over that without friction on the same mesh is compared with the finest mesh, within 2
% and 1 %; meshes without friction: [reproduction](bending-reproduction.md). Also the balance of work. Limits of the
cost: half as many iterations more in the median, 15 % discarded evaluations.
""",
    run=run,
    cost=60.0,
    own="what friction adds on the finest mesh",
)

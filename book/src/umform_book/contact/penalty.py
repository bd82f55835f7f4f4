"""Penalty against penetration, error of the force, condition number and iterations: how to choose it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigvalsh

from umform import mesh
from umform.analysis.run import Result
from umform.analysis.steps import Move
from umform.materials import SVK
from umform.model import Model
from umform.surfaces import Cylinder
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot, rule_name
from umform_book.linear_algebra import stiffness
from umform_book.page import Page
from umform_book.printed import about, bounded

LENGTH, WIDTH, THICKNESS, RADIUS, DEPTH, E = 40.0, 2.0, 0.5, 20.0, 2.0, 1e5
EI = E * WIDTH * THICKNESS**3 / 12
PENALTIES = tuple(10.0**k for k in range(9))
#: Elements along the strip and contact rules; the first one is run in short.
RUNS: tuple[tuple[int, int | str], ...] = ((24, 10), (12, 10), (48, 10), (24, 2), (24, "nodes"))
#: Increments of a run that is not cut.
STEPS = 5


@dataclass(frozen=True)
class Found:
    """Numbers of a run.

    Attributes
    ----------
    force, penetration : float
        On half of the strip; the largest of all points.
    condition, largest : float
        Condition number and largest eigenvalue of the tangent.
    stiffness : float
        Penalty times the largest area that belongs to a point in contact.
    increments, iterations : int
        Of the whole run.
    residual : float
        The largest that an increment ended with, over the forces in the strip.
    lines : float
        Lines of points in contact across the strip.
    """

    force: float
    penetration: float
    condition: float
    largest: float
    stiffness: float
    increments: int
    iterations: int
    residual: float
    lines: float


def press(page: Page, penalty: float, cells: int, points: int | str, frames: int = 0) -> Result:
    """Half of a strip on two supports, bent by a cylinder in its middle."""
    strip = mesh.strip(LENGTH, WIDTH, THICKNESS, (cells, 1), grading=(10.0, 1.0))
    model = Model(strip, "ANS3DEAS", material=SVK(E=E, nu=0.0))
    model.symmetry("x0", "x")
    model.fix(np.arange(len(strip.points)), "y")
    model.fix("x1_lower", "z")
    tool = Cylinder((0.0, 0.0, RADIUS + 0.5 * THICKNESS), "y", RADIUS)
    contact = model.contact("upper", tool, penalty=penalty, points=points, name="tool")
    drive = model.drive(contact, "-z")
    label = f"penalty {penalty:g}, {cells} elements, {rule_name(points)}"
    return page.solve(label, model, Move(drive, DEPTH, steps=STEPS), frames=frames)


def measure(result: Result) -> Found:
    """Numbers of the last state; the condition number by LAPACK, of the tangent over the free unknowns."""
    model, contact = result.model, result.model.contacts[0]
    eigenvalues = eigvalsh(stiffness(model, model.evaluate(model.u)).toarray())
    at = contact.at_points()
    across = 2 if contact.points == "nodes" else int(contact.points)
    return Found(
        force=float(contact.resultant()[0][2]),
        penetration=float(-at.gap.min()),
        condition=float(eigenvalues[-1] / eigenvalues[0]),
        largest=float(eigenvalues[-1]),
        stiffness=contact.penalty * float(at.area[at.pressure > 0].max()),
        increments=len(result) - 1,
        iterations=int(result["iterations"].sum()),
        residual=max(iterations[-1].residual for iterations in result.iterations[1:]),
        lines=float((at.pressure > 0).sum()) / across,
    )


def line_penetration(force: float, penalty: float) -> float:
    """Penetration under a line force. eq. (4.14)"""
    moment = force * LENGTH
    relative = 1 / (1 / RADIUS - moment / EI)
    return float((0.75 * force * 2 / WIDTH / (penalty * np.sqrt(2 * relative))) ** (2 / 3))


def series(page: Page, cells: int, points: int | str, penalties: tuple[float, ...]) -> dict[float, Found]:
    """The runs of one mesh and rule."""
    return {penalty: measure(press(page, penalty, cells, points)) for penalty in page.each(penalties, str)}


def show_series(page: Page, found: dict[tuple[int, int | str], dict[float, Found]]) -> None:
    """Table and plots."""
    rows: list[tuple[str | float | int, ...]] = []
    depths, errors, conditions = [], [], []
    for (cells, points), row in found.items():
        stiffest = row[max(row)].force
        label = f"{cells} elements, {rule_name(points)}"
        for penalty, f in row.items():
            error = f.force / stiffest - 1
            rows.append(
                (
                    label,
                    f"{penalty:g}",
                    f.penetration,
                    f.force,
                    100 * error,
                    f.condition,
                    f.lines,
                    f.increments,
                    about(f.iterations),
                    bounded(f.residual, 1e-8) or f.residual,
                )
            )
        x = list(row)
        depths.append(Curve(label, x, [f.penetration / THICKNESS for f in row.values()], "o-"))
        errors.append(Curve(label, x[:-1], [abs(f.force / stiffest - 1) for f in list(row.values())[:-1]], "o-"))
        conditions.append(Curve(label, x, [f.condition for f in row.values()], "o-"))
    columns = (
        "mesh, rule",
        "penalty",
        "penetration",
        "force",
        "error of the force %",
        "condition",
        "lines in contact",
        "increments",
        "iterations, about",
        "last residual",
    )
    page.table("Penalty; the force is compared with that of the stiffest one", columns, rows)
    ends = np.array([1.0, 1e5])
    depths.append(Curve("slope -2/3, eq. (4.14)", ends, 0.15 * ends ** (-2 / 3), "k:"))
    page.figure("penetration", plot(depths, "penalty", "penetration over thickness", log="xy"), "Penetration")
    page.figure("force", plot(errors, "penalty", "error of the force", log="xy"), "Error of the force")
    page.figure("condition", plot(conditions, "penalty", "condition number", log="xy"), "Condition of the tangent")


def check_series(page: Page, cells: int, row: dict[float, Found]) -> None:
    """Penetration of a line force, error of the force by the penetration, condition number."""
    limit = max(row)
    for penalty, f in row.items():
        if f.lines >= 4 and penalty >= 10:
            what = f"{cells} elements, 10 x 10, penalty {penalty:g}: penetration of the line force"
            # 4 lines of points and more resolve the parabola of the gap; the faces bend it by their chords
            page.check(what, f.penetration, line_penetration(f.force, penalty), 0.1)
        if 1 < penalty < 1e3:
            what = f"{cells} elements, 10 x 10, penalty {penalty:g}: error of the force over penetration / travel"
            page.check(what, (1 - f.force / row[limit].force) / (f.penetration / DEPTH), 1.0, 0.25)
    low = [f.condition for penalty, f in row.items() if 100 <= penalty <= E]
    what = f"{cells} elements: spread of the condition number, penalties from 100 to E per length"
    page.at_most(what, max(low) / min(low) - 1, 0.1)


def check_condition(page: Page, row: dict[float, Found], points: int | str) -> None:
    """Condition number where the penalty sets the largest eigenvalue: penalty times area of a node in contact."""
    f = row[max(row)]
    page.check(f"{rule_name(points)}, penalty {max(row):g}: largest eigenvalue", f.largest, f.stiffness, 0.1)


def check_stiff(page: Page, rows: Iterable[dict[float, Found]]) -> None:
    """Stiff penalties also converge without cuts, at the default tolerance or the floor of eq. (5.36)."""
    found = [f for row in rows for f in row.values()]
    page.at_most("additional increments, all runs", sum(f.increments - STEPS for f in found), 0)
    page.at_most("largest final residual of an increment", max(f.residual for f in found), 1e-8)


def run(page: Page) -> None:
    """Fill the page."""
    penalties = tuple(page.pick(PENALTIES, (1.0, 10.0, 100.0, 1e4)))
    found = {(cells, points): series(page, cells, points, penalties) for cells, points in page.pick(RUNS, RUNS[:1])}
    show_series(page, found)
    for (cells, points), row in found.items():
        if points == 10:
            check_series(page, cells, row)
    if not page.short:
        check_stiff(page, found.values())
        check_condition(page, found[24, "nodes"], "nodes")
    row = found[24, 10]
    worst = row[100.0].penetration
    error = 100 * abs(row[100.0].force / row[max(row)].force - 1)
    page.text(
        "Choice: allow a penetration d of at most 1 % of the thickness and of the travel of the tool, and take the "
        f"penalty p/d. Here 100 penetrates by {100 * worst / THICKNESS:.2g} % of the thickness and changes the force "
        f"by {error:.2g} %. Under a line force the penetration falls with the power -2/3, eq. (4.14): ten times the "
        "penalty for a fifth of the penetration. The penalty raises the condition number only where penalty times the "
        "area of a point exceeds the largest stiffness of the sheet. Below that, a stiff penalty costs iterations and "
        "smoothness."
    )
    if page.images is not None:
        result = press(page, 100.0, 24, 2, frames=1)
        page.shape(
            "shape", result, "Half of the strip under the cylinder", values="thickness_change", view=(-80.0, 15.0)
        )


CASE = Case(
    name="contact-penalty",
    title="How to choose the penalty",
    problem=f"""
Half of a strip on two supports {2 * LENGTH:g} apart, {WIDTH:g} wide, {THICKNESS:g} thick, E = {E:g}, nu = 0, u_y = 0,
ANS3DEAS, 12, 24 or 48 elements (graded by ten). A rigid cylinder of R = {RADIUS:g} bends it by {DEPTH:g}. Penalties
from 1 to 1e8. Measured: force on half of the strip, largest penetration, condition number of the tangent (all
eigenvalues, LAPACK), iterations in 5 increments.
""",
    reference="""
Penetration under a line force, eq. (4.14), with the relative radius of tool and strip, 1/R - M/EI; valid while the
contact is short against the strip and long against the distance of the points. The force is linear in the travel, so
its relative error is penetration / travel, apart from the stiffness that the width of the contact adds. The stiffest
penalty gives the reference of the force.
""",
    own="for the force, the stiffest penalty of umform itself; the penetration is a closed form",
    run=run,
    cost=15.0,
)

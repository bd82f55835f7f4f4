"""The rows of the reference: forces at four displacements, springback, the number of increments."""

from __future__ import annotations

import csv
from dataclasses import replace
from importlib.resources import files
from typing import Any

import numpy as np

from umform.processes import Bending, FreeBending
from umform.processes.bending.spec import RECONSTRUCTION, ContactRule
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot, rule_name
from umform_book.free_bending.runs import MESHES, RECOMMENDED, bend
from umform_book.page import Page

FILE = files("umform_book") / "reference" / "free_bending.csv"
#: Same mesh, element and rule: the reference prints three decimals, but its increments are its own.
WITHIN = 0.005


def rows() -> list[dict[str, str]]:
    """Rows of the reference."""
    lines = FILE.read_text(encoding="utf-8").splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


def case_of(row: dict[str, str]) -> FreeBending:
    """The case of a row."""
    along, across = row["cells"].split("x")
    points = row["contact_points"]
    options: dict[str, Any] = RECOMMENDED if row["recommended"] == "1" else {}
    contact: ContactRule = "nodes" if points == "nodes" else int(points)
    return FreeBending(mesh=(int(along), int(across)), element=row["element"], contact=contact, **options)


def against_the_reference(page: Page) -> dict[str, Bending]:
    """All rows of the reference."""
    found: dict[str, Bending] = {}
    table: list[tuple[str | float | None, ...]] = []
    for row in page.each(rows()[: 2 if page.short else None], lambda row: row["cells"]):
        case = case_of(row)
        bending = found[case.name] = bend(page, case)
        for mark, force in zip(case.marks, bending.forces, strict=True):
            assert force is not None
            page.check(f"{case.name}: F({mark:g})", force, float(row[f"F{mark:g}"]), WITHIN)
        expected = row["u_unloaded"]
        table.append((case.name, *bending.forces, f"{bending.zero_force:.3f}", expected or None))
        if expected and row["recommended"] == "0":
            assert bending.zero_force is not None
            springback = case.stroke - bending.zero_force
            page.check(f"{case.name}: springback", springback, case.stroke - float(expected), 0.01)
            page.at_most(f"{case.name}: force after the release, N", abs(float(bending.F[-1])), 1e-4)
    columns = ("run", "F(2)", "F(5)", "F(10)", "F(15)", "u at F = 0", "u at F = 0, reference")
    page.table("Forces in N, displacements in mm", columns, table)
    return found


def increments(page: Page) -> None:
    """Half and twice as many increments."""
    base = FreeBending()
    counts = page.pick((150, 300, 600), (75, 150))
    found = [bend(page, replace(base, steps=steps)) for steps in counts]
    columns = ("increments", "F(2)", "F(5)", "F(10)", "F(15)", "u at F = 0", "J %")
    rows = [(n, *b.forces, b.zero_force, 100 * (b.jump or 0.0)) for n, b in zip(counts, found, strict=True)]
    page.table(f"{base.name}, number of increments", columns, rows)
    last = [b.forces[-1] or 0.0 for b in found]
    within = 0.0005 if not page.short else 0.002
    page.check(f"F(15) with {counts[0]} increments against {counts[-1]}", last[0], last[-1], within)


def first_stiffness(bending: Bending) -> float:
    """Slope of the first increment of the release, N/mm."""
    last = int(np.flatnonzero(bending.step == 1)[-1])
    return float((bending.F[last] - bending.F[last + 1]) / (bending.u[last] - bending.u[last + 1]))


def springback(page: Page, found: dict[str, Bending]) -> None:
    """The part of the springback that is not checked, and the reason."""
    ratios = []
    for bending in found.values():
        assert bending.zero_force is not None and bending.forces[-1] is not None
        back, force, slope = bending.case.stroke - bending.zero_force, bending.forces[-1], first_stiffness(bending)
        ratios.append((bending.case.name, back, force, slope, force / slope))
        # the release is elastic but for the last of the contact
        page.check(f"{bending.case.name}: springback against force over first slope", back, force / slope, 0.1)
    columns = ("run", "springback mm", "force before it N", "first slope of the release N/mm", "force over slope mm")
    page.table("Springback", columns, ratios)
    odd = next((b for b in found.values() if not b.case.is_paper_element), None)
    if odd is None or odd.zero_force is None or odd.forces[-1] is None:
        return
    listed = next(float(row["u_unloaded"]) for row in rows() if row["recommended"] == "1")
    paper = next(float(row["u_unloaded"]) for row in rows() if row["u_unloaded"] and row["recommended"] == "0")
    stroke, force, slope = odd.case.stroke, odd.forces[-1], first_stiffness(odd)
    page.text(
        f"For {odd.case.name} the reference lists {listed:.2f} mm at zero force, with two decimals (its first row has "
        f"{paper:.3f}); umform finds {odd.zero_force:.3f}. The forces of the row agree. The release is nearly elastic: "
        f"its first slope of {slope:.1f} N/mm brings the force to zero after {force / slope:.3f} mm, while "
        f"{stroke - listed:.2f} mm would need {force / (stroke - listed):.1f} N/mm. The value is probably copied from "
        "the first row; this cannot be shown, and it is not among the checks."
    )


def curves(page: Page, found: dict[str, Bending]) -> None:
    """Nodes against Gauss points, a plot for each mesh."""
    for mesh in MESHES:
        drawn = []
        for points in ("nodes", mesh.least, 5):
            case = FreeBending(mesh=mesh.mesh, element=mesh.element, contact=points, steps=150)
            bending = found.get(case.name) or bend(page, case)
            drawn.append(Curve(rule_name(points), bending.u, bending.F, "-"))
        for bending in found.values():
            if not bending.case.is_paper_element and bending.case.mesh == mesh.mesh:
                drawn.append(Curve("order 3, E_33 tied", bending.u, bending.F, "k--"))
        figure = plot(drawn, "displacement u, mm", "force F, N")
        page.figure(f"curve-{mesh.mesh[0]}x{mesh.mesh[1]}", figure, f"{mesh.label}: nodes against Gauss points")


def run(page: Page) -> None:
    """Fill the page."""
    page.text(RECONSTRUCTION)
    found = against_the_reference(page)
    springback(page, found)
    increments(page)
    if page.images is not None:
        curves(page, found)
        best = list(found.values())[-1]
        assert best.shape is not None
        name = "plastic_strain_max"
        page.shape("shape", best.shape, f"{best.case.name} at the end of the stroke", values=name, view=(-82.0, 26.0))


_CASE = FreeBending()
CASE = Case(
    name="bending-reproduction",
    title="Free bending of the paper: reproduction",
    problem=f"""
{RECONSTRUCTION} Half of a strip {_CASE.length:g} x {_CASE.width:g} x {_CASE.thickness:g} mm, symmetric about x = 0, on
a rigid frictionless cylinder of R = {_CASE.radius:g} mm along y with its axis at x = {_CASE.tool_x:g} mm. The lower
nodes of x = 0 move down by {_CASE.stroke:g} mm in {_CASE.steps} increments and back until the force is zero. J2
plasticity: kappa = {_CASE.kappa:g}, mu = {_CASE.mu:g}, y = {_CASE.yield_stress:g} MPa without hardening; penalty
{_CASE.penalty:g} N/mm^3; {_CASE.thickness_points} Gauss points through the thickness (8 with thickness order 3 and E_33
tied). Measured: force at four displacements, displacement at zero force.
""",
    reference="""
An independent program for the same reconstruction of the example of Harnau & Schweizerhof (PAMM); three decimals, and
0.05 % between numbers of increments. The paper prints no dimensions and no numbers. The rows of the paper's elements,
linear in the thickness strain, are a reproduction and no prediction: fine continuum meshes end at 21 to 23 N.
""",
    run=run,
    cost=35.0,
)

"""Three-point bending without contact: force and radius of the hinge, against continuum meshes; advice."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.page import Page
from umform_book.printed import about
from umform_book.sharp_bends import calculix
from umform_book.sharp_bends.candidates import BEND8, BEND18, of_order, stack
from umform_book.sharp_bends.moment import radius_of_excess
from umform_book.sharp_bends.strips import Bend, Strip, bend

Floats = NDArray[np.float64]

HALF_SPAN = 25.0
STROKE = 20.0
MARKS = (2.0, 5.0, 10.0, 15.0, 20.0)
HARDENING = (500.0, 100.0)
#: Elements along half the span: lengths near 2, 1 and 1/2 thickness; twice that with 18 nodes.
MESHES = {8: (12, 25, 50), 18: (6, 12, 25)}
CANDIDATES = (*(of_order("ANS3DEAS", p) for p in (1, 2, 3)), BEND8, *(of_order("MI9K3DEAS", p) for p in (1, 3)), BEND18)
STACKS = ((stack("EAS3DEAS", 4, 2), 80), (stack("DISP9K3DEAS", 4, 2, 5), 50))
#: Deviation that is allowed where the material hardens.
WITHIN = 0.03

Runs = dict[tuple[str, int], Bend]


def _run_all(page: Page, hardening: float) -> tuple[Runs, dict[str, Bend]]:
    """One element through the thickness on all meshes, and stacks."""
    strip = Strip("supports", HALF_SPAN, STROKE, hardening)
    chosen = page.pick(CANDIDATES, (CANDIDATES[0], BEND8, BEND18))
    runs: Runs = {}
    for candidate in page.each(chosen, lambda c: f"H = {hardening:g}, {c.label}"):
        meshes = MESHES[candidate.nodes]
        for cells in page.pick(meshes, meshes[1:2] if candidate.nodes == 18 else meshes[-1:]):
            runs[candidate.label, cells] = bend(page, strip, candidate, cells, frames=2)
    stacks = page.pick(STACKS, ())
    return runs, {c.label: bend(page, strip, c, cells) for c, cells in stacks}


def _continuum(page: Page, hardening: float) -> dict[int, Curve]:
    """Forces of the continuum meshes by the number of layers."""
    found: dict[int, Curve] = {}
    meshes = [m for m in calculix.STORED if m.over == "supports" and m.hardening == hardening]
    said = []
    for mesh in page.each(meshes, lambda m: f"CalculiX, {m.layers} layers"):
        u, force, origin = calculix.forces(mesh)
        found[mesh.layers] = Curve(f"continuum, {mesh.layers} layers", u, force, "k--" if mesh.layers == 6 else "k:")
        said.append(f"{mesh.layers} layers: {origin}")
    page.text(f"CalculiX forces for H = {hardening:g}: {', '.join(said)}.")
    return found


def _force(curve: Curve, u: float) -> float:
    x = np.asarray(curve.x)
    return float(np.interp(u, x, np.asarray(curve.y))) if u <= x[-1] else float("nan")


def _table(page: Page, hardening: float, runs: Runs, stacks: dict[str, Bend], continuum: dict[int, Curve]) -> None:
    rows: list[tuple[str | float | None, ...]] = [
        (curve.label, None, *(_force(curve, u) for u in MARKS), None, None) for curve in continuum.values()
    ]
    rows += [(k, None, *(b.at(u) for u in MARKS), b.radius, about(b.iterations)) for k, b in stacks.items()]
    for (label, cells), found in runs.items():
        rows.append((label, HALF_SPAN / cells, *(found.at(u) for u in MARKS), found.radius, about(found.iterations)))
    columns = ("run", "length / h", *(f"F({u:g})" for u in MARKS), "least R/h at the end", "iterations, about")
    page.table(f"Force in N on a width of 10 mm, H = {hardening:g} MPa", columns, rows)


def _check(page: Page, hardening: float, runs: Runs, stacks: dict[str, Bend], continuum: Curve) -> None:
    """Order 3 and order 4 on the meshes that one would take: h/2 with 8 nodes, 2 h and h with 18."""
    eight, eighteen = ("BEND8", "order 3, 8 nodes"), ("BEND18", "order 3, 18 nodes")
    for (label, cells), found in runs.items():
        fine = (label in eight and cells == MESHES[8][-1]) or (label in eighteen and cells in MESHES[18][1:])
        if not fine:
            continue
        for u in MARKS:
            what = f"{label}, length {HALF_SPAN / cells:.2g} h, H = {hardening:g}: F({u:g})"
            page.check(what + " against CalculiX", found.at(u), _force(continuum, u), WITHIN)
        for name, other in stacks.items():
            u = 15.0
            page.check(f"{label}, H = {hardening:g}: F({u:g}) against {name}", found.at(u), other.at(u), WITHIN)
    for name, other in stacks.items():
        for u in (5.0, 15.0):
            what = f"{name}, H = {hardening:g}: F({u:g}) against CalculiX"
            page.check(what, other.at(u), _force(continuum, u), WITHIN)


def _plot(page: Page, hardening: float, runs: Runs, stacks: dict[str, Bend], continuum: dict[int, Curve]) -> None:
    finest = {label: found for (label, _), found in runs.items()}
    drawn = [Curve(k, found.u, found.force, "--" if "18" in k else "-") for k, found in finest.items()]
    drawn += [Curve(label, found.u, found.force, "-.") for label, found in stacks.items()]
    figure = plot([*drawn, *continuum.values()], "displacement u, mm", "force F, N", limits=(15.0, 65.0))
    page.figure(f"H{hardening:g}", figure, f"H = {hardening:g} MPa, finest mesh of each element")
    if page.short:
        return
    lines = []
    reference = continuum[6]
    for label in dict.fromkeys(name for name, _ in runs):
        lengths = [HALF_SPAN / cells for name, cells in runs if name == label]
        errors = [
            100 * abs(b.at(STROKE) / _force(reference, STROKE) - 1) for (name, _), b in runs.items() if name == label
        ]
        lines.append(Curve(label, lengths, errors, "o--" if "18" in label else "o-"))
    figure = plot(lines, "length of an element / h", f"error of F({STROKE:g}), %", log="y")
    page.figure(f"lengths-H{hardening:g}", figure, f"H = {hardening:g} MPa: error at the end of the stroke over length")


def _errors(runs: Runs, continuum: Curve) -> list[tuple[str, float]]:
    """Error at the end of each element on its finest mesh."""
    finest = {label: found for (label, _), found in runs.items()}
    return [(label, found.at(STROKE) / _force(continuum, STROKE) - 1.0) for label, found in finest.items()]


def _advice(page: Page, worst: dict[float, tuple[float, list[tuple[str, float]]]]) -> None:
    page.heading("What to take")
    said = "; ".join(
        f"with H = {hardening:g} the hinge is bent to R/h = {radius:.2g}, and F({STROKE:g}) errs by "
        + ", ".join(f"{100 * error:+.1f} % ({label})" for label, error in errors)
        for hardening, (radius, errors) in worst.items()
    )
    page.text(f"On the finest mesh of each element, {said}.")
    reached = ", ".join(f"{radius_of_excess(order):.2g} (order {order})" for order in (1, 2, 3, 4))
    page.text(f"By formula (2.29) the false moment is 3 % at R/h = {reached}: these are the bounds of the table.")
    page.table(
        "Advice, from these runs, the [moments](bend-moment.md), [small cylinders](bend-small-cylinders.md), the "
        "[turn of an element](bend-meshes.md) and the [thickness points](bend-thickness-points.md)",
        ("R/h in the bend (mid-surface)", "element", "length of the elements", "thickness points"),
        (
            (f"over {radius_of_excess(1):.0f}", "any, order 1", "as the geometry asks", "8 split (5 Gauss: 5 % soft)"),
            (
                f"{radius_of_excess(1):.0f} to 4",
                "order 2 at least; BEND8, BEND18",
                "turn under 20° (18 nodes: 50°)",
                "8 split",
            ),
            (
                f"4 to {radius_of_excess(4):.1f}",
                "BEND8, BEND18",
                "8 nodes h/2, at most R/3; 18 nodes h to 2 h",
                "12 split",
            ),
            (f"under {radius_of_excess(4):.1f}", "a continuum; BEND18 with more than 3 %", "h", "12 split"),
        ),
    )


def _without_hardening(page: Page) -> None:
    """Without hardening no element is checked: the continuum meshes do not agree."""
    coarse, fine = (m for m in calculix.STORED if m.over == "supports" and m.hardening == 0.0)
    u, force = 10.0, [float(np.interp(10.0, *calculix.forces(mesh)[:2])) for mesh in (coarse, fine)]
    page.heading("Without hardening")
    page.text(
        f"CalculiX with {coarse.layers} and {fine.layers} layers finds F({u:g}) = {force[0]:.2f} and {force[1]:.2f} N, "
        f"{100 * (force[0] / force[1] - 1):+.0f} %: the hinge contracts to a length that the mesh sets. No element is "
        "judged there."
    )


def run(page: Page) -> None:
    """Fill the page."""
    worst = {}
    for hardening in page.pick(HARDENING, HARDENING[:1]):
        page.heading(f"Hardening modulus {hardening:g} MPa")
        continuum = _continuum(page, hardening)
        runs, stacks = _run_all(page, hardening)
        _table(page, hardening, runs, stacks, continuum)
        _check(page, hardening, runs, stacks, continuum[6])
        if page.images is not None:
            _plot(page, hardening, runs, stacks, continuum)
        u = 10.0 if hardening == HARDENING[0] else 15.0
        four, six = (_force(continuum[n], u) for n in (4, 6))
        page.check(f"CalculiX, H = {hardening:g}: F({u:g}) with four layers against six", four, six, 0.015)
        best = [found for (label, _), found in runs.items() if label == "BEND8"][-1]
        worst[hardening] = best.radius, _errors(runs, continuum[6])
        if hardening == HARDENING[0]:
            title = "BEND8, length h/2, at the end of the stroke"
            page.shape("shape", best.result, title, values="plastic_strain_max", view=(-90.0, 0.0))
    _without_hardening(page)
    _advice(page, worst)


CASE = Case(
    name="bend-hinge",
    title="Three-point bending to a sharp hinge",
    problem=f"""
Half of a strip in plane strain, h = 1 mm, symmetric about x = 0. Its lower edge at x = {HALF_SPAN:g} mm is supported
(u_z = 0), its lower edge at x = 0 is pushed down by {STROKE:g} mm. There is no contact, so only the element errs. J2
plasticity: kappa = 175000, mu = 80770, y0 = 160, linear hardening H = 500 and 100 MPa. Force on a width of 10 mm.
Without hardening the hinge would contract to a length set by the mesh.
""",
    reference=f"""
CalculiX 2.20, C3D20R, six layers, 1/6 x 1/6 mm in the hinge; 1.2 % from four layers. Stored; it runs where
`{calculix.VARIABLE}` is set and `ccx` is found. Also stacks of four EAS3DEAS and DISP9K3DEAS of order 2 (stacks of
ANS3DEAS lock in their own plane).
""",
    own="beside CalculiX, four layers of EAS3DEAS and DISP9K3DEAS of order 2, umform itself",
    run=run,
    cost=80.0,
)

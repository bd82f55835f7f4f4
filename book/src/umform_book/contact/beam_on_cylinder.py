"""Strip hanging over a cylinder: an elastica, a line force where it leaves the tool, the pressure of its tension."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from umform.analysis.run import Result
from umform.analysis.steps import Move
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot, rule_name
from umform_book.contact.hertz_line import EIGHT, EIGHTEEN, least_rule
from umform_book.contact.strip_on_cylinder import (
    EI,
    MIDDLE,
    RADIUS,
    THICKNESS,
    WIDTH,
    E,
    Hanging,
    flat_strip,
    hanging,
)
from umform_book.convergence import show, study
from umform_book.page import Page
from umform_book.variants import GOOD, Variant

LENGTH, FORCE, PENALTY, OVERLAP = 20.0, 2.0, 1000.0, 0.02
#: Largest errors that are expected, by intervals along the strip. The strip is a polygon on the arc: its normals are
#: off by up to h/2R, which changes the sum of forces by (h/R)^2/8 and the position of the end by (h/R)^2/4 of R.
#: Stretching and shear of the strip, which the closed form leaves out, are 0.03 % of its length.
EXPECTED = {20: 0.005, 40: 0.002, 80: 0.001}


@dataclass(frozen=True)
class Found:
    """Numbers of a run over those of the closed form: position of the end (distance over length), forces, pressure."""

    tip: float
    pressing: float
    centre: float
    pressure: float


def hang(
    page: Page, variant: Variant, divisions: int, points: int | str, *, penalty: float = PENALTY, frames: int = 0
) -> Result:
    """Bend the strip by its end force."""
    model, _, load = flat_strip(variant, divisions, (0.0, LENGTH), penalty, points, overlap=OVERLAP)
    model.symmetry("x0", "x")
    label = f"{variant.label}, {divisions} intervals, {rule_name(points)}, penalty {penalty:g}"
    return page.solve(label, model, Move(load, FORCE, steps=20), frames=frames)


def compare(result: Result, exact: Hanging) -> Found:
    """The last state against the closed form."""
    model, contact = result.model, result.model.contacts[0]
    at = contact.at_points()
    angle = np.arctan2(at.x[:, 0], at.x[:, 2] + RADIUS + 0.5 * THICKNESS - OVERLAP)
    force = at.pressure * at.area
    of_facets = angle.reshape(len(contact.facets), -1).mean(axis=1) < 0.5 * exact.angle
    on_arc = np.repeat(of_facets, len(angle) // len(of_facets))
    tip = model.positions[model.mesh.nodes("x1")].mean(axis=0) - [0.0, 0.0, OVERLAP]
    return Found(
        tip=float(np.hypot(tip[0] - exact.tip[0], tip[2] - exact.tip[1])) / LENGTH,
        pressing=float(force.sum()) / exact.pressing,
        centre=float(force @ angle / force.sum()) / exact.centre,
        pressure=float(force[on_arc].sum() / at.area[on_arc].sum()) / exact.pressure,
    )


def by_elements(page: Page, exact: Hanging) -> None:
    """All elements over the meshes."""
    meshes = page.pick((10, 20, 40, 80), (20, 40))
    found: dict[tuple[Variant, int], Found] = {}

    def pressing(variant: Variant, divisions: int) -> float:
        found[variant, divisions] = compare(hang(page, variant, divisions, least_rule(variant)), exact)
        return found[variant, divisions].pressing

    variants = page.pick((Variant("DISP3D"), Variant("DISP9K3D"), *GOOD), (EIGHT, EIGHTEEN))
    show(
        page,
        "elements",
        "sum of the normal forces over the closed form",
        study(page, variants, meshes, pressing),
        mesh="intervals between nodes along the strip",
    )
    page.table(
        "2 x 2 (3 x 3) contact points, over the closed form",
        (
            "element",
            "intervals",
            "end off by (of length)",
            "sum of normal forces",
            "their mean angle",
            "pressure on arc",
        ),
        [(v.label, n, f.tip, f.pressing, f.centre, f.pressure) for (v, n), f in found.items()],
    )
    for (variant, divisions), f in found.items():
        within = EXPECTED.get(divisions)
        if variant in GOOD and within and divisions in (20, max(meshes)):
            what = f"{variant.label}, {divisions} intervals"
            page.at_most(f"{what}: position of the end, over the length", f.tip, within)
            page.check(f"{what}: sum of the normal forces", f.pressing, 1.0, within)
            page.check(f"{what}: mean angle of the normal forces", f.centre, 1.0, 5 * within)


def by_rules(page: Page, exact: Hanging) -> None:
    """Contact rules on three meshes."""
    rules: tuple[int | str, ...] = ("nodes", 2, 3, 5, 10)
    rows = []
    for variant in (EIGHT, EIGHTEEN):
        for points in rules:
            for divisions in (20, 40, 80):
                f = compare(hang(page, variant, divisions, points), exact)
                label = f"{variant.label}, {rule_name(points)}"
                rows.append((label, divisions, f.tip, f.pressing, f.centre, f.pressure))
            if points == "nodes" or int(points) >= least_rule(variant):
                page.check(f"{label}, 80 intervals: sum of the normal forces", f.pressing, 1.0, EXPECTED[80])
                page.check(f"{label}, 80 intervals: pressure on the arc", f.pressure, 1.0, 0.005)
    columns = ("rule", "intervals", "end off by (of length)", "normal forces", "mean angle", "pressure on the arc")
    page.table("Contact rules, over the closed form", columns, rows)


def by_force(page: Page) -> None:
    """Path of the end and distribution of the normal force."""
    result = hang(page, EIGHT, 80, 2, frames=20)
    model, frames = result.model, result.frames[2:]
    ends = model.mesh.nodes("x1")
    fall = [float(frame.points["displacement"][ends, 2].mean()) - OVERLAP for frame in frames]
    forces = [frame.time * FORCE for frame in frames]
    exact = [hanging(force, LENGTH) for force in forces]
    curves = [
        Curve("closed form", [-e.tip[1] for e in exact], forces, "k-"),
        Curve("ANS3DEAS, 80 elements", [-w for w in fall], forces, "o"),
    ]
    page.figure("path", plot(curves, "fall of the end", "force"), "Fall of the end under the force")
    worst = max(abs(w - e.tip[1]) for w, e in zip(fall, exact, strict=True)) / LENGTH
    page.at_most("ANS3DEAS, 80 elements: fall of the end along the path, over the length", worst, EXPECTED[80])

    profiles = []
    for variant, points, divisions in ((EIGHT, "nodes", 40), (EIGHT, 2, 40), (EIGHT, 2, 80), (EIGHTEEN, 3, 80)):
        run = hang(page, variant, divisions, points)
        facets = np.unique(run.model.contacts[0].facets)
        pressure, _ = run.model.contacts[0].at_nodes(run.model.u, run.model.mesh)
        x = run.model.positions[facets]
        angle = np.arctan2(x[:, 0], x[:, 2] + RADIUS + 0.5 * THICKNESS - OVERLAP)
        order = np.argsort(angle)
        order = order[angle[order] < 1.7]
        label = f"{variant.name}, {divisions} intervals, {rule_name(points)}"
        profiles.append(Curve(label, angle[order], pressure[facets][order] / exact[-1].pressure, "."))
    figure = plot(profiles, "angle from the top", "pressure at nodes over that on the arc", level=1.0)
    page.figure("pressure", figure, "Pressure along the arc, and the line force where the strip leaves the tool")


def run(page: Page) -> None:
    """Fill the page."""
    exact = hanging(FORCE, LENGTH)
    page.table(
        "The closed form",
        ("force", "angle of contact", "x of the end", "z of the end", "sum of normal forces", "mean angle", "pressure"),
        [
            (force, e.angle, *e.tip, e.pressing, e.centre, e.pressure)
            for force in (0.25, 0.5, 1.0, FORCE)
            for e in (hanging(force, LENGTH),)
        ],
    )
    by_elements(page, exact)
    if not page.short:
        by_rules(page, exact)
        by_force(page)
    page.text(
        f"Where the strip leaves the cylinder, the line force ({FORCE * np.cos(exact.angle):.3g} of {FORCE:g}) is "
        "spread over a few elements by the penalty and the shear of the strip. Its peak pressure has no limit; its "
        "sum and its place converge."
    )
    if page.images is not None:
        result = hang(page, EIGHT, 40, 2, frames=1)
        page.shape(
            "shape", result, "Half of the strip over the cylinder", values="contact_pressure", view=(-80.0, 15.0)
        )


CASE = Case(
    name="contact-beam-on-cylinder",
    title="Elastic strip hanging over a cylinder",
    problem=f"""
Half of a strip, {LENGTH:g} long, {WIDTH:g} wide, {THICKNESS:g} thick, E = {E:g}, nu = 0, u_y = 0, lies on a rigid
frictionless cylinder of R = {RADIUS:g}; x = 0 is a symmetry plane. A dead force at the end pulls it down to F =
{FORCE:g} (F L R / EI = {FORCE * LENGTH * MIDDLE / EI:.0f}). Penalty {PENALTY:g}. The tool starts {OVERLAP} inside the
strip, so that Gauss points hold it too. Measured: position of the end, sum and mean angle of the normal forces, mean
pressure on the first half of the arc.
""",
    reference="""
Elastica with large rotations, inextensible and without shear: an arc of curvature 1/R with the pressure T/(R b) of the
tension T = F sin(angle), a line force F cos(angle) where it leaves the cylinder, and an elastica beyond. Stretching,
shear and penetration: below 0.05 % of the length.
""",
    run=run,
    cost=25.0,
)

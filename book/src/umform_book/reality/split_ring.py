"""Rings cut from a drawn cup and split: the opening, by height, and beside the moment that the ring held."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.analysis.steps import Move
from umform.materials.j2 import Plastic
from umform.model import Model
from umform.model.transfer.trim import Trim
from umform.processes.draw import Cup
from umform.surfaces import Profile
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.drawing.cups import NEWTON, esaform, isotropic
from umform_book.page import Page
from umform_book.reality.measured_loop import law_of_sheet

Floats = NDArray[np.float64]

#: Radii in the blank between which rings are cut, moved to the nearest line of the mesh.
CUTS = (37.2, 42.3, 47.4, 52.5)
#: Without ironing: the rim thickens to some 1.3 mm.
_WIDE: dict[str, Any] = {"die_radius": 32.0, "holder_force": 2e3}
_AROUND = 8
BASE, COARSE, IRONED, LOOP = "5 degrees", "7 degrees", "5 degrees, ironed", "5 degrees, law of the measured loop"
#: Largest deviations: from a bar of constant section, whose stiffness is 12 % below that of a plate; by the mesh.
_BEAM, _MESH = 0.15, 0.06


@dataclass(frozen=True)
class Ring:
    """A split ring.

    Attributes
    ----------
    height : float
        Of its middle above the bottom of the cup, mm.
    width, thickness, radius : float
        Mean width, since lines of the mesh are not quite circles; thickness and radius of the middle where it is split,
        before that, mm.
    moment, force : float
        That the cross-section carried before the split, N mm and N.
    opening : float
        Of the split, mm.
    flow : float
        Plastic work of the split over the elastic energy that it sets free.
    """

    height: float
    width: float
    thickness: float
    radius: float
    moment: float
    force: float
    opening: float
    flow: float

    def beam(self, young: float) -> float:
        """Opening 4 R sin(pi/2 M R / EI) of a bar of the radius R that loses this moment."""
        stiffness = young * self.width * self.thickness**3 / 12.0
        turn = 0.5 * np.pi * self.moment * self.radius / stiffness
        return float(4.0 * self.radius * np.sin(abs(turn)) * -np.sign(self.moment))


def split(page: Page, label: str, cup: Model, inner: float, outer: float, bottom: float) -> Ring:
    """Cut a ring between two radii of the blank, relax it, and split it at y = 0; a quarter of it is computed."""
    part = Trim(Profile.circle((0.0, 0.0), inner, hole=True), formed=False, edge="elements").of(cup)
    ring = Trim(Profile.circle((0.0, 0.0), outer), formed=False, edge="elements").of(part.model).model
    end, middle = ring.mesh.nodes("y0"), ring.mesh.nodes("x0")
    ring.symmetry("x0", "x")
    plane = ring.symmetry("y0", "y")
    ring.fix(middle[:1], "z", here=True)
    relaxed = page.solve(f"{label}: cut", ring, Move(ring.unbalanced("cut"), 0.0, steps=5), frames=1, options=NEWTON)
    x, volume = ring.positions, _volume(ring)
    forces = relaxed.frames[-1].points["reaction"][end, 1]
    across = x[end, 0] - x[end, 0].mean()
    heights = x[middle, 2]
    ring.fix([middle[heights.argmin()], middle[heights.argmax()]], "y", here=True)
    opened = page.solve(f"{label}: split", ring, Move(ring.remove(plane), 0.0, steps=8), options=NEWTON)
    inside = ring.mesh.points[end, 2] > 0.0
    before, after = ([y[end][side].mean(axis=0) for side in (inside, ~inside)] for y in (x, ring.positions))
    turned = after[1] - after[0]
    angle = np.arctan2(turned[1], turned[0])
    radius = float(0.5 * (before[0] + before[1])[0])
    wall = float((before[1] - before[0])[0])
    work, energy = (np.ptp(opened[name]) for name in ("plastic_work", "elastic_energy"))
    return Ring(
        height=float(x[end, 2].mean() - bottom),
        width=volume / (0.5 * np.pi * radius * wall),
        thickness=wall,
        radius=radius,
        moment=float(forces @ across),
        force=float(forces.sum()),
        opening=float(2.0 * (after[0] + after[1])[0] * np.sin(angle)),
        flow=float(work / energy),
    )


def _volume(model: Model) -> float:
    """Volume of cells of eight nodes, by the determinants at their centres."""
    corners = model.positions[model.mesh.connectivity]
    sides = np.array([[-1, 1, 1, -1] * 2, [-1, -1, 1, 1] * 2, [-1] * 4 + [1] * 4]) / 4.0
    return float(np.linalg.det(np.einsum("ka,nai->nki", sides, corners)).sum())


def rings(page: Page, label: str, case: Cup) -> list[Ring]:
    """Draw the cup, open the press, and cut its rings."""
    model, press = case.build()
    page.solve(label, model, press.closing, options=NEWTON)
    page.solve(f"{label}: released", model, press.opening, options=NEWTON)
    lines = case.sizes.ends
    cuts = [float(lines[np.abs(lines - radius).argmin()]) for radius in CUTS]
    bottom = float(model.positions[:, 2].min())
    hair = 1e-3
    return [
        split(page, f"{label}, {n + 1}", model, a - hair, b + hair, bottom)
        for n, (a, b) in enumerate(itertools.pairwise(cuts))
    ]


def cases() -> dict[str, Cup]:
    """Cups of the page."""

    def cup(turn: float, material: Plastic, **changes: Any) -> Cup:
        return esaform(material, turn=turn, around=_AROUND, **changes)

    return {
        COARSE: cup(7.0, isotropic(), **_WIDE),
        BASE: cup(5.0, isotropic(), **_WIDE),
        LOOP: cup(5.0, law_of_sheet(), **_WIDE),
        IRONED: cup(5.0, isotropic()),
    }


def run(page: Page) -> None:
    """Fill the page."""
    made = {name: case for name, case in cases().items() if not page.short or name == COARSE}
    found = {name: rings(page, name, made[name]) for name in page.each(made, str)}
    columns = (
        "height, mm",
        "width",
        "thickness",
        "radius",
        "moment, N mm",
        "opening, mm",
        "of a curved bar, mm",
        "plastic work, %",
    )
    rows = [
        (
            name,
            one.height,
            one.width,
            one.thickness,
            one.radius,
            one.moment,
            one.opening,
            one.beam(made[name].material.E),
            100.0 * one.flow,
        )
        for name, some in found.items()
        for one in some
    ]
    page.table("Rings, from the bottom up", ("cup", *columns), rows)
    curves = [
        Curve(name, np.array([r.height for r in some]), np.array([r.opening for r in some]), "o-")
        for name, some in found.items()
    ]
    page.figure(
        "opening", plot(curves, "height of the middle of the ring, mm", "opening, mm"), "Opening of the split rings"
    )
    for name, some in found.items():
        page.check(f"{name}: sign of the smallest opening", float(np.sign(min(one.opening for one in some))), 1.0, 0.0)
        force = max(abs(one.force) for one in some)
        page.at_most(f"{name}: hoop force of the relaxed ring, N", force, 1e-2)
        if name == LOOP:
            continue  # the bar is elastic, and this sheet flows again
        for n, one in enumerate(some, 1):
            bar = one.beam(made[name].material.E)
            page.check(f"{name}, ring {n}: opening against a curved bar", one.opening, bar, _BEAM)
    if page.short:
        return
    base, coarse = found[BASE], found[COARSE]
    for n, one in enumerate(coarse, 1):
        fine = np.interp(one.height, [r.height for r in base], [r.opening for r in base])
        page.check(f"ring {n}: opening with {COARSE} against {BASE} at its height", one.opening, float(fine), _MESH)
    middle = base[1]
    page.compare(f"opening of a ring {middle.height:.0f} mm above the bottom, mm", middle.opening, None)
    ironed, loop = found[IRONED][1], found[LOOP][1]
    largest = 50.0 * max(one.opening for one in base) / middle.radius
    page.text(
        f"The rings open, as in all measurements, by up to {largest:.0f} % of their diameter. The opening falls "
        f"towards the rim, from {base[0].opening:.1f} to {base[-1].opening:.1f} mm, where the "
        "sheet is thicker. The ring in the middle opens by "
        f"{middle.opening:.1f} mm at {middle.height:.1f} mm above the bottom; with the gap of 1.2 mm, which irons the "
        f"wall, by {ironed.opening:.1f} mm at {ironed.height:.1f} mm; with the law of the measured loop, a harder "
        f"sheet, by {loop.opening:.1f} mm. With the Bauschinger effect of this law the metal flows again as the ring "
        f"opens, which takes {100.0 * loop.flow:.0f} % of the energy set free."
    )


CASE = Case(
    name="reality-split-ring",
    title="Split rings of a drawn cup",
    problem="""
The cup of the [ESAFORM benchmark](drawing-aa6016-cup.md) with an opening of 64 mm and a holder of 2 kN, so that the
wall is not ironed; isotropic flow, hardening of Voce, one layer of ANS3DEAS, 8 elements around a quarter. After the
release three rings are cut along lines of the mesh. A ring relaxes, then it is split where y = 0. A quarter of it is
computed with symmetry about x = 0: without forces at its ends each quarter of the ring deforms alike, so the opening is
4 R sin(psi), with the radius R and the rotation psi of the end of the quarter. One cup has the gap of 1.2 mm of
the benchmark, one the law of the [measured loop](material-measured-loop.md) of AA6xxx-T4.
""",
    reference="""
Split rings are measured by the test of Demeri (ASTM E2492-07, withdrawn 2017): AA6111-T4 by Xia, Miller and Ren, J.
Manuf. Sci. Eng. 129 (2007) 352, six metals in SAE 2005-01-0083. Their numbers are not at hand, and their cups are of
other size: only the sign is compared. Checks: rings open; where the metal stays elastic, the opening is within
15 % that of a curved bar that loses the moment of its cross-section, which the plane of symmetry carried (Young's
modulus, not that of a plate, which is 12 % stiffer; thickness and width vary); a finer mesh changes it by 6 % at most.
By simulations of Simões et al., Int. J. Mater. Form. 2017, doi 10.1007/s12289-017-1351-x, ironing changes how the
opening depends on the height; the table has an ironed cup.
""",
    own="the openings; only their sign is from measurements",
    run=run,
    cost=80.0,
)

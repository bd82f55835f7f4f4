"""A thick strip with free edges over a small cylinder: effect of the surface mesh on its force."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

import umform as uf
from umform_book.case import Case
from umform_book.page import Page
from umform_book.sharp_bends.candidates import steel
from umform_book.variants import Variant

HARDENING, STROKE, MARKS = 500.0, 15.0, (2.0, 5.0, 10.0, 15.0)
_STACK: dict[str, Any] = {"thickness_order": 2, "tie_E33": True}


@dataclass(frozen=True)
class Mesh:
    """An element of the catalogue with its defaults, cells along and across, and layers; several are of order 2."""

    name: str
    along: int
    across: int
    layers: int = 1

    @property
    def label(self) -> str:
        """Name in tables."""
        return f"{self.name}, {self.along} x {self.across}" + (f", {self.layers} layers" if self.layers > 1 else "")


FINEST = Mesh("EAS3DEAS", 96, 8, 4)
MESHES = (
    Mesh("BEND8", 24, 2),
    Mesh("BEND8", 48, 2),
    Mesh("BEND8", 48, 4),
    Mesh("BEND8", 96, 8),
    Mesh("EAS3DEAS", 48, 2),
    Mesh("EAS3DEAS", 96, 8),
    Mesh("BEND18", 24, 2),
    Mesh("BEND18", 48, 4),
    Mesh("EAS3DEAS", 48, 2, 4),
    Mesh("EAS3DEAS", 48, 4, 4),
)


def forces(page: Page, mesh: Mesh) -> list[float]:
    """Force at the marks."""
    cell = Variant(mesh.name).cell
    strip = uf.mesh.strip(60.0, 10.0, 2.0, (mesh.along, mesh.across), cell=cell, layers=mesh.layers)
    material = steel(HARDENING)
    if mesh.layers > 1:
        model = uf.Model(strip, mesh.name, material=material, thickness_points=4, **_STACK)
    else:
        model = uf.Model(strip, mesh.name, material=material, tie_E33=True)
    model.symmetry("x0", "x")
    model.fix(np.intersect1d(strip.nodes("x0_lower"), strip.nodes("y0_lower")), "y")
    way = model.prescribe("x0_lower", "z", "way")
    model.contact("lower", uf.Cylinder((40.0, 0.0, -11.0), axis="y", radius=10.0), penalty=500.0, points=3)
    result = page.solve(mesh.label, model, uf.Move(way, to=-STROKE, steps=40))
    return [float(np.interp(u, -result["way"], -result["way_force"])) for u in MARKS]


def run(page: Page) -> None:
    """Fill the page."""
    meshes = page.pick((FINEST, *MESHES), (MESHES[0],))
    found = {mesh: forces(page, mesh) for mesh in page.each(meshes, lambda m: m.label)}
    page.table(
        "Force in N at displacements of the clamped end",
        ("mesh", *(f"F({u:g})" for u in MARKS)),
        [(mesh.label, *values) for mesh, values in found.items()],
    )
    if page.short:
        page.check("BEND8, 24 x 2: F(15)", found[MESHES[0]][-1], 51.0, 0.03)
        return
    fine = found[FINEST]
    for mesh, within in (
        (MESHES[1], 0.03),
        (MESHES[3], 0.015),
        (MESHES[5], 0.01),
        (MESHES[7], 0.01),
        (MESHES[9], 0.012),
    ):
        for u, value, reference in zip(MARKS, found[mesh], fine, strict=True):
            page.check(f"{mesh.label}: F({u:g})", value, reference, within)
    last = {mesh: values[-1] / fine[-1] - 1.0 for mesh, values in found.items()}
    across, inplane, layers = last[MESHES[1]] - last[MESHES[3]], last[MESHES[3]] - last[MESHES[5]], last[MESHES[5]]
    page.text(
        f"One layer of BEND8 on 48 x 2 elements is {100 * last[MESHES[1]]:.1f} % above four layers at the end. It is "
        f"not the thickness: a finer surface mesh removes {100 * across:.1f} %, {100 * inplane:.1f} % is the "
        f"difference between BEND8 and EAS3DEAS (enhanced membrane strains) on that mesh, and {100 * layers:.1f} % "
        "remains for the single layer. The edges of the strip rise (anticlastic curvature): it bends in its own plane "
        "there, where BEND8 locks. EAS3DEAS with E_33 tied and BEND18 do not."
    )


CASE = Case(
    name="bend-wide-strip",
    title="A thick strip with free edges over a small cylinder",
    problem=f"""
Half of a strip of 60 x 10 x 2 mm, H = {HARDENING:g} MPa, on a cylinder of radius 10 mm at x = 40; its end at x = 0,
with an upright section, is pushed down by {STROKE:g} mm. The edges are free. Penalty 500, 3 x 3 contact points, 40
increments. One layer has the default points and order and E_33 tied.
""",
    reference="""
Four layers of EAS3DEAS of order 2 with E_33 tied on 96 x 8 elements; on 48 x 4 they differ by 0.7 to 1.1 %.
""",
    own="four layers of umform",
    run=run,
    cost=70.0,
)

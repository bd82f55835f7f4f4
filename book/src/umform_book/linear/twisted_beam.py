"""Twisted cantilever: warped elements in bending and shear, thick and thin."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.materials import SVK
from umform.results.shape import Shape
from umform_book.case import Case
from umform_book.convergence import normalised, show, study
from umform_book.linear.beams import Beam
from umform_book.linear.meshes import rectangle
from umform_book.linear.sentences import coarse_and_fine
from umform_book.page import Page
from umform_book.variants import GOOD, VARIANTS, Variant, with_tying

Floats = NDArray[np.float64]

LENGTH, WIDTH = 12.0, 1.1
MATERIAL = SVK(E=29e6, nu=0.22)
THICK, THIN = 0.32, 0.0032
#: MacNeal & Harder (1985): displacement under a unit force at the end, along its width and across it.
DIRECTIONS = {"in-plane": (0.0, 0.0, 1.0), "out-of-plane": (0.0, 1.0, 0.0)}
REFERENCES_THICK = {"in-plane": 0.005424, "out-of-plane": 0.001754}


def pretwisted_bar(load: str, thickness: float) -> float:
    """Displacement under a unit force by the theory of slender bars, where both principal axes turn by 90 degrees.

    The integral of (L - x)^2 (sin^2 / E I_flat + cos^2 / E I_edge) along the bar.
    """
    flat, edge = WIDTH * thickness**3 / 12, thickness * WIDTH**3 / 12
    more, less = LENGTH**3 * (1 / 6 + 1 / np.pi**2), LENGTH**3 * (1 / 6 - 1 / np.pi**2)
    large, small = (more, less) if load == "in-plane" else (less, more)
    return float((large / flat + small / edge) / MATERIAL.E)


def twisted(variant: Variant, divisions: int, thickness: float) -> Beam:
    """The beam, six intervals along it to one across."""

    def turned(X: Floats) -> Floats:
        x, y, z = X.T
        angle = 0.5 * np.pi * x / LENGTH
        y = y - 0.5 * WIDTH
        return np.column_stack([x, y * np.cos(angle) - z * np.sin(angle), y * np.sin(angle) + z * np.cos(angle)])

    plain = rectangle(variant, (divisions, divisions // 6), (LENGTH, WIDTH, thickness))
    return Beam(plain.transformed(turned), variant, MATERIAL)


def run(page: Page) -> None:
    """Fill the page."""
    divisions = page.pick((6, 12, 24), (6, 12))
    for thickness in (THICK, THIN):
        for load, direction in DIRECTIONS.items():
            bar = pretwisted_bar(load, thickness)
            reference = REFERENCES_THICK[load] if thickness == THICK else bar

            def tip(variant: Variant, n: int, d: tuple[float, ...] = direction, h: float = thickness) -> float:
                return twisted(variant, n, h).tip(d)

            found = study(page, page.pick(VARIANTS, GOOD), divisions, tip)
            name = f"h = {thickness:g}, {load}"
            show(
                page,
                f"{load}-{thickness:g}",
                f"{name}: displacement over {reference:.4g}",
                normalised(found, reference),
            )
            page.text(coarse_and_fine(found, reference))
            if thickness == THICK:
                page.check(f"{name}: slender bar against the paper", bar, reference, within=0.02)
            for variant in (with_tying("ANS3DEAS"), with_tying("EAS3DEAS"), with_tying("MI9K3DEAS")):
                for n in (12, divisions[-1]):
                    what = f"{name}: {variant.label}, {n} intervals"
                    page.check(what, found[variant][n], reference, _expected(variant, n, thickness))
    beam = twisted(with_tying("EAS3DEAS"), 24, THICK)
    page.shape("shape", Shape.displaced(beam.mesh, 400 * beam.under_force((0, 0, 1))), "In-plane load, 400 times")
    page.text(
        f"Through its thickness a thin solid is stiffer than in bending by about (L/h)^4, {(LENGTH / THIN) ** 4:.1e} "
        "for the thin beam. There, round-off reaches some per cent in any element with displacements on two faces."
    )


def _expected(variant: Variant, divisions: int, thickness: float) -> float:
    """Expected error: ANS3DEAS, on few elements over the width, locks in bending in its own plane."""
    if variant.name == "ANS3DEAS":
        return 0.1 if divisions == 12 else 0.04
    return 0.02 if thickness == THICK and divisions > 12 else 0.03


CASE = Case(
    name="twisted-beam",
    title="Twisted cantilever",
    problem=f"""
Beam of length {LENGTH:g}, width {WIDTH:g}, thickness {THICK:g} or {THIN:g}; its section turns by 90 degrees from end to
end; E = 29e6, nu = 0.22. One end stays plane but may contract; a unit force on the other acts along its width
(in-plane) or across it (out-of-plane). Measured: mean displacement of that end along the force. Every element is
warped. Coarsest mesh: 6 x 1 intervals between nodes; the literature has 12 x 2.
""",
    reference="""
Thick: MacNeal & Harder, Finite Elem. Anal. Des. 1 (1985) 3-20: 0.005424 and 0.001754. Thin: closed form of a slender
bar with turning principal axes; for the thick beam it agrees with the paper within 0.5 %. A thin bar is a plate that
partly hinders transverse contraction: 1 to 2 % of uncertainty.
""",
    run=run,
    picture="in-plane-0.0032",
    cost=5.0,
)

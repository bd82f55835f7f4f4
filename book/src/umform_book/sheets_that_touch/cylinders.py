"""Hertz: two elastic bodies with round faces, of equal and of different moduli."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import umform as uf
from umform.analysis.steps import Move
from umform.mesh import Mesh
from umform_book.case import Case
from umform_book.contact.half_space import growing
from umform_book.contact.hertz_line import EIGHT
from umform_book.page import Page

Floats = NDArray[np.float64]

NU, END, GROWTH = 0.3, 40.0, 1.35


@dataclass(frozen=True)
class Pair:
    """Two bodies: elements over a length of 1, radius of the face, modulus."""

    elements: tuple[int, int]
    radii: tuple[float, float]
    moduli: tuple[float, float]

    @property
    def modulus(self) -> float:
        """E* of both."""
        return 1.0 / sum((1.0 - NU**2) / modulus for modulus in self.moduli)

    @property
    def radius(self) -> float:
        """Relative radius."""
        return 1.0 / sum(1.0 / radius for radius in self.radii)

    @property
    def label(self) -> str:
        """For tables."""
        (n, m), (E, F), (R, S) = self.elements, self.moduli, self.radii
        return f"{n} and {m} elements, E {E:g} and {F:g}, R {R:g} and {S:g}"


def bodies(pair: Pair) -> Mesh:
    """Halves of two blocks with parabolic faces that touch at the origin."""
    made = []
    for elements, radius, side in zip(pair.elements, pair.radii, (-1.0, 1.0), strict=True):
        across, depth = growing(1.0 / elements, 1.5, END, GROWTH), growing(1.0 / elements, 1.0, END, GROWTH)
        flat = uf.mesh.grid(across, [0.0, 1.0], depth if side > 0.0 else -depth[::-1])

        def rounded(X: Floats, radius: float = radius, side: float = side) -> Floats:
            rise = side * X[:, 0] ** 2 / (2.0 * radius) * (1.0 - np.abs(X[:, 2]) / END)
            return np.column_stack([X[:, 0], X[:, 1], X[:, 2] + rise])

        made.append(flat.transformed(rounded))
    return uf.mesh.together(a=made[0], b=made[1])


def press(page: Page, pair: Pair) -> tuple[float, list[tuple[float, float]]]:
    """Half-width after Hertz; of each side peak and half-width over Hertz."""
    mesh = bodies(pair)
    above = mesh.points[mesh.connectivity].mean(axis=1)[:, 2] > 0.0
    model = uf.Model(
        mesh,
        bodies=[
            uf.Body(EIGHT.element, material=uf.SVK(E=modulus, nu=NU), cells=cells, name=name)
            for name, modulus, cells in zip("ab", pair.moduli, (~above, above), strict=True)
        ],
    )
    contact = model.sheet_contact("upper of a", "lower of b", name="faces", cells=3)
    model.symmetry(np.flatnonzero(mesh.points[:, 0] == 0.0), "x")
    model.symmetry(np.arange(len(mesh.points)), "y")
    model.fix("lower of a", "z")
    down = model.prescribe("upper of b", "z", "down")
    result = page.solve(pair.label, model, Move(down, lambda part: -0.023 * part**2, steps=6))
    force = 2.0 * abs(float(result["faces_fz"][-1]))
    half_width = float(np.sqrt(4.0 * force * pair.radius / (np.pi * pair.modulus)))
    peak = 2.0 * force / (np.pi * half_width)
    found = []
    for side in contact.found.sides:
        share, x = side.pressure * side.area, side.x[:, 0]
        near = x < 0.3 * half_width
        of_near = share[near].sum() / side.area[near].sum()
        ellipse = np.sqrt(1.0 - (x[near] / half_width) ** 2) @ side.area[near] / side.area[near].sum()
        found.append((float(of_near / ellipse / peak), float(np.sqrt(4.0 * (share @ x**2) / share.sum()) / half_width)))
    return half_width, found


def run(page: Page) -> None:
    """Equal and different moduli and radii."""
    rows = []
    pairs = [
        Pair((8, 14), (np.inf, 200.0), (1000.0, 1000.0)),
        Pair((8, 14), (np.inf, 200.0), (1000.0, 5000.0)),
        Pair((14, 8), (400.0, 400.0), (1000.0, 1000.0)),
    ]
    for pair in page.pick(pairs, pairs[:1]):
        half_width, found = press(page, pair)
        for name, (peak, width) in zip(("lower", "upper"), found, strict=True):
            rows.append((pair.label, name, half_width, peak, width))
            page.check(f"{pair.label}, {name} face: half-width by the second moment", width, 1.0, 0.01)
        page.check(f"{pair.label}: peak pressure, mean of both faces", float(np.mean(found, axis=0)[0]), 1.0, 0.01)
    page.table("Over Hertz", ("bodies", "face", "half-width after Hertz", "peak pressure", "half-width"), rows)
    page.text(
        "Each face finds the pressure from its own gaps, and carries half of it: what acts is the mean. With meshes of "
        "8 and 14 elements the two differ by up to 2 %."
    )


CASE = Case(
    name="touch-cylinders",
    title="Two elastic cylinders",
    problem="Halves of two blocks of 40 x 40 in plane strain, with parabolic faces of given radii, are pressed "
    "together by 0.023. Poisson's ratio 0.3; default penalty; 3 x 3 cells; no friction. The peak pressure "
    "is the mean over the inner third of the contact, divided by that of the ellipse.",
    reference="Hertz, by the force that was found: half-width sqrt(4 P R / (pi E*)), peak pressure 2 P / (pi a) "
    "[Johnson1985]. The blocks are 27 half-widths large.",
    run=run,
)

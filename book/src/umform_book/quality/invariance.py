"""Invariance: the answer depends neither on the numbering of the nodes, nor on the frame, nor on the units."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from umform import mesh
from umform.analysis.run import Result, solve
from umform.analysis.steps import Move
from umform.materials import J2, Linear
from umform.mesh import Mesh
from umform.model import Model
from umform.results.shape import Shape
from umform_book.case import Case
from umform_book.page import Page
from umform_book.printed import shown
from umform_book.variants import VARIANTS, Variant, with_tying

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]

LENGTH, WIDTH, HEIGHT = 20.0, 10.0, 1.0
FORCE = np.array([1000.0, 160.0, 110.0])
#: What round-off of converged increments leaves.
ROUND_OFF = 1e-10
#: Rule whose columns have the same heights; largest change of a displacement by the place of staggered ones.
ALIKE, STAGGERED = "graded", 0.005


@dataclass(frozen=True)
class Units:
    """Size of millimetre, newton and megapascal in a system of units."""

    name: str
    length: float = 1.0
    force: float = 1.0

    @property
    def stress(self) -> float:
        """Size of a megapascal."""
        return self.force / self.length**2


MILLIMETRES = Units("mm, N, MPa")
OTHER_UNITS = (Units("m, N, Pa", length=1e-3), Units("in, lbf, psi", length=1 / 25.4, force=1 / 4.4482216152605))


def sheet(cell: str) -> Mesh:
    """Two by two distorted, warped elements, 18-node ones too."""

    def distorted(X: Floats) -> Floats:
        x, y, z = X.T
        return np.column_stack([x + np.sin(np.pi * x / LENGTH) * (y - 4) / 5, y + 0.02 * x, z + 0.004 * x * (y - 3)])

    return mesh.strip(LENGTH, WIDTH, HEIGHT, (2, 2), cell=cell).transformed(distorted)


def bent(
    variant: Variant,
    renumbered: Callable[[Ids], Ids] = lambda cells: cells,
    frame: Rotation | None = None,
    units: Units = MILLIMETRES,
    solving: Callable[..., Result] = solve,
    rule: str = ALIKE,
) -> tuple[Floats, Result]:
    """Displacements (n, 3) of the clamped sheet under a force at its end, in mm and in the unrotated frame."""
    frame = frame or Rotation.identity()
    plain = sheet(variant.cell)
    cells = renumbered(plain.connectivity.astype(np.int64))
    at_end = np.isin(np.arange(len(plain.points)), plain.nodes("x1"))
    model = Model(
        Mesh(frame.apply(plain.points) * units.length, {plain.cell: cells}),
        variant.element,
        material=J2(
            kappa=175000 * units.stress,
            mu=80770 * units.stress,
            hardening=Linear(160.0 * units.stress, 2000.0 * units.stress),
        ),
        thickness_points=12,
        thickness_rule=rule,
    )
    model.fix(plain.nodes("x0"))
    area = WIDTH * HEIGHT * units.length**2
    load = model.traction(lambda x, y, z: at_end, frame.apply(FORCE) * units.force / area, "force")
    result = solving(model, Move(load, 1.0, steps=4), frames=1)
    return frame.inv().apply(model.u.reshape(-1, 3)) / units.length, result


# Numberings -----------------------------------------------------------------------------------------------------------


def turned(cells: Ids, turns: NDArray[np.integer] | int = 1) -> Ids:
    """The same cells with their local numbering turned about t by quarter turns, one number for each cell."""
    half = cells.shape[1] // 2
    out = cells.copy()
    for start in range(0, 2 * half, 4 if half == 4 else 9):
        for ring in (start, start + 4)[: 1 if half == 4 else 2]:
            columns = ring + (np.arange(4) + np.broadcast_to(turns, len(cells))[:, None]) % 4
            out[:, ring : ring + 4] = np.take_along_axis(cells, columns, axis=1)
    return out


def flipped(cells: Ids) -> Ids:
    """The same cells with upper and lower face exchanged, and reflected so that their volume stays positive."""
    half = cells.shape[1] // 2
    reflected = [0, 3, 2, 1] if half == 4 else [0, 3, 2, 1, 7, 6, 5, 4, 8]
    return np.hstack([cells[:, half:][:, reflected], cells[:, :half][:, reflected]])


NUMBERINGS: dict[str, Callable[[Ids], Ids]] = {
    "turned by 90 degrees": lambda cells: turned(cells, 1),
    "turned by 180 degrees": lambda cells: turned(cells, 2),
    "turned by 270 degrees": lambda cells: turned(cells, 3),
    "each cell turned differently": lambda cells: turned(cells, np.arange(len(cells)) % 4),
    "upper and lower exchanged": flipped,
}


# The page -------------------------------------------------------------------------------------------------------------


def run(page: Page) -> None:
    """Fill the page."""
    frame = Rotation.from_rotvec([0.4, -1.1, 0.7])
    columns: dict[str, Callable[[Variant], tuple[Floats, Result]]] = {
        **{name: partial(bent, renumbered=numbering) for name, numbering in NUMBERINGS.items()},
        "rotated model": partial(bent, frame=frame),
        **{units.name: partial(bent, units=units) for units in OTHER_UNITS},
    }
    staggered = NUMBERINGS["each cell turned differently"]
    by_columns: list[float] = []
    changes: dict[str, list[float]] = {}
    iterations: dict[str, list[int]] = {}
    variants = page.pick(VARIANTS, (with_tying("EAS3DEAS"), Variant("MI9K3DEAS")))
    for variant in page.each(variants, lambda v: v.label):
        u, result = bent(variant, solving=partial(page.solve, variant.label))
        others = [compute(variant) for compute in columns.values()]
        change = [float(np.abs(other - u).max() / np.abs(u).max()) for other, _ in others]
        pair = [bent(variant, numbering, rule="staggered")[0] for numbering in (lambda cells: cells, staggered)]
        by_columns.append(float(np.abs(pair[1] - pair[0]).max() / np.abs(pair[0]).max()))
        plastic = float(result.frames[-1].cells["plastic_strain_max"].max())
        changes[variant.label] = [float(np.abs(u).max()), plastic, *change]
        iterations[variant.label] = [int(r["iterations"].sum()) for r in (result, *(r for _, r in others))]
    page.table(
        "Largest displacement (mm) and plastic strain, and relative changes of the displacement",
        ("element", "u", "plastic strain", *columns),
        [(label, *row) for label, row in changes.items()],
    )
    page.table(
        "Iterations of all increments",
        ("element", "original", *columns),
        [(label, *row) for label, row in iterations.items()],
    )
    for number, name in enumerate(columns, start=2):
        page.at_most(f"all elements: change with {name}", max(row[number] for row in changes.values()), ROUND_OFF)
    page.at_most("staggered heights: change with each cell turned differently", max(by_columns), STAGGERED)
    largest = max(max(row[2:]) for row in changes.values())
    page.text(
        f"Largest change of all: {shown(largest, 2)}. Every element is invariant to numbering, rotation and units."
        if largest <= ROUND_OFF
        else f"Not all elements are invariant: the largest change is {shown(largest, 2)}."
    )
    more = max(abs(count - row[0]) for row in iterations.values() for count in row)
    page.at_most("all elements: largest difference of iterations", more, 0.0)
    page.shape("shape", Shape.displaced(sheet(variant.cell), u), f"Deformed sheet, {variant.label}")


CASE = Case(
    name="invariance",
    title="Invariance",
    problem=f"""
A distorted and warped sheet of 2 x 2 elements, {LENGTH:g} x {WIDTH:g} x {HEIGHT:g} mm, is clamped at one end. A dead
force of {FORCE.tolist()} N on the other bends it into the plastic range in four increments (J2, kappa = 175000, mu =
80770, yield stress 160 + 2000 eqps MPa, large displacements). Compared: other numberings of the nodes of cells, a
rotated model, other units.
""",
    reference="""
The problem itself: all answers must be equal up to round-off. Tying points and enhanced modes are symmetric in the
local axes, and enhanced strains are mapped as tensors. All columns of points have the same heights here (12 graded
points). Staggered heights belong to the numbering of a cell: another one changes the answer by the error of the rule.
""",
    run=run,
    cost=5.0,
)

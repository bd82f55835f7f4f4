"""Ironing: a rounded block is pressed into an elastic slab, and slides along it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import umform as uf
from umform.analysis.run import Result
from umform.analysis.steps import Move
from umform.mesh import Mesh
from umform.surfaces import Arc, Line
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.contact.hertz_line import EIGHT
from umform_book.page import Page

Floats = NDArray[np.float64]

E, RATIO, NU, FRICTION = 689.6, 10.0, 0.32, 0.3
#: Slab; block: half of its width, radius and depth of its round face, height; gap at the start, place of its middle.
LENGTH, HEIGHT = 12.0, 4.0
HALF, RADIUS, RISE, BLOCK, GAP, MIDDLE = 0.6, 0.75, 0.3, 1.2, 0.2, 0.8
PRESS, SLIDE = 1.0, 10.0
#: Fewest layers of a solid body.
LAYERS = 5


@dataclass(frozen=True)
class Ironed:
    """History of a run: time as in the references, vertical and horizontal force, and what checks it."""

    time: Floats
    vertical: Floats
    horizontal: Floats
    result: Result
    balance: float

    def at(self, time: float) -> tuple[float, float]:
        """Vertical and horizontal force at a time."""
        return float(np.interp(time, self.time, self.vertical)), float(np.interp(time, self.time, self.horizontal))


def bodies(elements: int) -> Mesh:
    """Slab and block, with so many elements over a length of 1."""
    slab = uf.mesh.grid(
        np.linspace(0.0, LENGTH, round(LENGTH * elements) + 1), [0.0, 1.0],
        uf.mesh.graded(HEIGHT, max(LAYERS, round(1.5 * elements)), 1.0 / 5.0) - HEIGHT,
    )  # fmt: skip
    left, right = (-HALF, RISE), (HALF, RISE)
    outline = uf.Profile(
        [Line((-HALF, BLOCK), left), Arc(left, right, (0.0, RADIUS)), Line(right, (HALF, BLOCK))], closed=False
    )
    place = (MIDDLE, 0.0, GAP)
    block = uf.Extruded(outline, place).elastic_body(
        (left, right), ((-HALF, BLOCK), (HALF, BLOCK)), size=1.0 / elements, layers=max(LAYERS, elements), turn=90.0
    )
    return uf.mesh.together(slab=slab, block=block)


def iron(page: Page, elements: int, friction: float, increments: tuple[int, int], *, frames: int = 0) -> Ironed:
    """Press the block down, then slide it."""
    mesh = bodies(elements)
    soft, stiff = (uf.NeoHooke(E=modulus, nu=NU) for modulus in (E, RATIO * E))
    model = uf.Model(
        mesh,
        bodies=[
            uf.Body(EIGHT.element, material=soft, cells="slab", name="slab"),
            uf.Body(EIGHT.element, material=stiff, cells="block", name="block"),
        ],
    )
    model.sheet_contact("upper of slab", "upper of block", name="faces", cells=3, friction=friction)
    model.fix(np.arange(len(mesh.points)), "y")
    model.fix("lower of slab", "xz")
    down = model.prescribe("lower of block", "z", "down")
    along = model.prescribe("lower of block", "x", "along")
    steps = [Move(down, -PRESS, steps=increments[0]), Move(along, SLIDE, steps=increments[1])]
    name = f"{elements} elements over 1, friction {friction:g}, {increments[0]} and {increments[1]} increments"
    result = page.solve(name, model, steps, frames=frames)
    force = {axis: result[f"faces_f{axis}"] for axis in "xz"}
    applied = {"x": result["along_force"], "z": result["down_force"]}
    difference = max(float(np.abs(np.abs(force[axis]) - np.abs(applied[axis])).max()) for axis in "xz")
    return Ironed(
        -result["down"] / PRESS + result["along"] / SLIDE,
        np.abs(force["z"]), result["along_force"], result, difference / float(np.abs(force["z"]).max()),
    )  # fmt: skip


@dataclass(frozen=True)
class Published:
    """Vertical and horizontal force at the end of the press and halfway of the slide, per unit of width, and source."""

    source: str
    vertical: tuple[float, float]
    horizontal: tuple[float, float]


#: Read from the figures by the authors of the last one; all with friction, on meshes of about 5 elements over 1.
PUBLISHED = (
    Published("Fischer, Wriggers [FischerWriggers2006]", (297.9, 365.1), (62.1, 188.8)),
    Published("Hartmann et al. [HartmannEtAl2009]", (319.5, 408.4), (67.2, 160.2)),
    Published("Poulios, Renard [PouliosRenard2015]", (267.9, 337.4), (55.3, 102.1)),
    Published("Code_Aster SSNP153 [CodeAster2020]", (332.0, 421.0), (71.0, 143.3)),
    Published("solids4foam, finite volumes [BatisticEtAl2022]", (316.4, 395.1), (55.0, 122.7)),
)
#: Forces of the test of Code_Aster while it presses [CodeAster2020]: time, vertical, horizontal.
PRESSING = ((0.5, 94.54, 18.36), (0.6, 134.56, 26.68), (0.7, 178.40, 35.99), (0.8, 225.57, 46.08), (0.9, 275.55, 56.89),
            (1.0, 329.90, 69.02))  # fmt: skip
MESHES = ((3, (8, 70)), (5, (12, 120)))


def spread(page: Page, what: str, found: float, values: list[float]) -> None:
    """Check that a number lies among the published ones."""
    low, high = min(values), max(values)
    page.check(
        f"{what}: middle of the published ones", found, 0.5 * (low + high), 0.5 * (high - low) / (0.5 * (low + high))
    )


def run(page: Page) -> None:
    """With friction on some meshes, without it on one."""
    rows: list[tuple[str, float, float, float, float, float]] = [
        (one.source, *one.vertical, *one.horizontal, one.horizontal[1] / one.vertical[1]) for one in PUBLISHED
    ]
    curves = []
    for elements, increments in page.pick(MESHES, MESHES[:1]):
        ironed = iron(page, elements, FRICTION, increments)
        label = f"{elements} elements over 1"
        (v, h), (vm, hm) = ironed.at(1.0), ironed.at(1.5)
        rows.append((f"here, {label}", v, vm, h, hm, hm / vm))
        for k, (what, pair) in enumerate((("pressed", (v, h)), ("slid halfway", (vm, hm)))):
            spread(page, f"{label}, {what}: vertical force", pair[0], [one.vertical[k] for one in PUBLISHED])
            spread(page, f"{label}, {what}: horizontal force", pair[1], [one.horizontal[k] for one in PUBLISHED])
        page.at_most(f"{label}: forces of the faces less those of the supports, relative", ironed.balance, 1e-3)
        page.at_most(f"{label}: work and energies, relative", abs(float(ironed.result.balance().drift[-1])), 0.01)
        curves += [
            Curve(f"vertical, {label}", ironed.time, ironed.vertical, "-"),
            Curve(f"horizontal, {label}", ironed.time, ironed.horizontal, "--"),
        ]
    at = np.array([row[0] for row in PRESSING])
    curves += [
        Curve(f"Code_Aster, {what}", at, [row[k] for row in PRESSING], "o")
        for k, what in ((1, "vertical"), (2, "horizontal"))
    ]
    page.table(
        "Forces with friction 0.3",
        ("source", "vertical, t = 1", "t = 1.5", "horizontal, t = 1", "t = 1.5", "horizontal over vertical, t = 1.5"),
        rows,
    )
    page.figure("forces", plot(curves, "time: pressed up to 1, slid from 1 to 2", "force per width"), "Forces")
    elements, increments = page.pick(MESHES, MESHES[:1])[-1]
    free = iron(page, elements, 0.0, increments)
    middle = 1.0 + (0.5 * LENGTH - MIDDLE) / SLIDE
    (v, h), way = free.at(middle), 0.1
    (before, pull), (after, push) = free.at(middle - way), free.at(middle + way)
    page.at_most("without friction, middle of the slab: horizontal over vertical force", abs(h) / v, 0.01)
    page.check("without friction, 1 before and after the middle: vertical force", before, after, 0.01)
    page.at_most(
        "without friction, 1 before and after the middle: sum of the horizontal forces over vertical",
        abs(pull + push) / v,
        0.01,
    )
    page.at_most("without friction: work and energies, relative", abs(float(free.result.balance().drift[-1])), 0.01)


CASE = Case(
    name="touch-ironing",
    title="Ironing with a deformable block",
    problem="A block of 1.2 x 1.2 with a round face of radius 0.75 is pressed by 1 (of which 0.2 are a gap) into a "
    "slab of 12 x 4 on a fixed base, and slides by 10 along it. Plane strain, neo-Hooke, E = 689.6 of the slab"
    " and ten times as much of the block, Poisson's ratio 0.32, friction 0.3; default penalty, 3 x 3 cells. "
    "Only the round face touches.",
    reference="Published curves differ by a quarter in the vertical and by a half in the horizontal force "
    "[FischerWriggers2006], [HartmannEtAl2009], [PouliosRenard2015], [BatisticEtAl2022]. The authors of the "
    "last one read the forces of the others from figures. Limits: within this spread. Dots are forces of the "
    "test of Code_Aster [CodeAster2020]. Without friction the block slides over the middle of the slab without a "
    "horizontal force, and the forces are symmetric about it.",
    run=run,
    cost=20.0,
)

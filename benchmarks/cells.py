"""Contact over cells beside contact at points: how smooth the force of a bent strip is, and what it costs.

A strip of 60 x 10 x 1 is bent over a cylinder of radius 20, with nodes, Gauss points and cells on the same mesh. All
are measured against 20 x 20 cells a face. The page gets the tables, and a picture.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

import record
import umform as uf
from umform import materials as mt
from umform import mesh as meshes
from umform.elements import element
from umform.plotting import house_style

Floats = NDArray[np.float64]

PAGE, FIGURE = Path("docs/cells.md"), Path("docs/images/cells.png")
STROKE, FINEST = 15.0, 20

#: Where the law is asked, by what it is called in the tables.
RULES: dict[str, dict[str, Any]] = {
    "nodes": {"points": "nodes"},
    **{f"Gauss {n}": {"points": n} for n in (2, 5, 10)},
    **{f"cells {n}": {"cells": n} for n in (2, 3, 5)},
}


@dataclass(frozen=True)
class Strip:
    """A strip and how stiff the contact is.

    Attributes
    ----------
    element : str
        Name in the catalogue.
    cells : tuple of int
        Elements along x and y.
    penalty : float
        Pressure per penetration.
    distorted : bool
        Whether the elements are no rectangles, and differ in size by a factor of two.
    friction : float, optional
        Coefficient of friction.
    """

    element: str
    cells: tuple[int, int]
    penalty: float
    distorted: bool = False
    friction: float | None = None

    @property
    def name(self) -> str:
        """As in the tables."""
        shape = ", distorted" if self.distorted else ""
        rough = "" if self.friction is None else f", friction {self.friction}"
        return f"{self.element} {self.cells[0]}x{self.cells[1]}{shape}, {self.penalty:g}{rough}"

    def mesh(self) -> meshes.Mesh:
        """The half strip, symmetric about x = 0."""
        mesh = meshes.strip(60.0, 10.0, 1.0, self.cells, cell=element(self.element).cell)
        if self.distorted:
            x, y = mesh.points[:, 0].copy(), mesh.points[:, 1].copy()
            inside = np.sin(np.pi * x / 60.0)
            mesh.points[:, 0] += inside * (0.8 * np.sin(2.1 * x) + 0.6 * np.sin(0.6 * y + 0.9 * x))
            mesh.points[:, 1] += 0.12 * y * (10.0 - y) * np.sin(1.3 * x)
        return mesh

    def bend(self, rule: dict[str, Any], steps: int) -> Bent:
        """Push its lower edge at x = 0 down."""
        law = mt.J2(kappa=175000.0, mu=80770.0, hardening=mt.Perfect(160.0))
        mesh = self.mesh()
        model = uf.Model(mesh, self.element, material=law, thickness_order=1, thickness_points=5)
        model.symmetry("x0", normal="x")
        punch = model.prescribe("x0_lower", "z", name="punch")
        model.fix(np.intersect1d(mesh.nodes("x0_lower"), mesh.nodes("y0_lower")), "y")
        tool = uf.Cylinder(centre=(25, 0, -20.5), axis="y", radius=20)
        model.contact("lower", tool, penalty=self.penalty, friction=self.friction, name="tool", **rule)
        start = time.process_time()
        result = uf.solve(model, uf.Move(punch, to=-STROKE, steps=steps))
        seconds = time.process_time() - start
        drift = float(np.abs(result.balance().drift).max())
        return Bent(
            -result["punch"], -result["punch_force"], int(result["iterations"].sum()), seconds, drift,
            float(result["tool_penetration"].max()),
        )  # fmt: skip


@dataclass(frozen=True)
class Bent:
    """Way and force of the punch, iterations, CPU seconds, drift of the balance and largest penetration."""

    way: Floats
    force: Floats
    iterations: int
    seconds: float
    drift: float
    penetration: float

    def deviation(self, reference: Bent) -> float:
        """Root of the mean square of the difference of the forces, over that of the force."""
        force = np.interp(reference.way, self.way, self.force)
        return float(np.sqrt(np.mean((force - reference.force) ** 2) / np.mean(reference.force**2)))

    def ripple(self, reference: Bent) -> float:
        """The same without what changes slowly: the difference less the cubic polynomial in the way next to it."""
        difference = np.interp(reference.way, self.way, self.force) - reference.force
        smooth = np.polynomial.Polynomial.fit(reference.way, difference, 3)(reference.way)
        return float(np.sqrt(np.mean((difference - smooth) ** 2) / np.mean(reference.force**2)))

    def jump(self) -> float:
        """Largest change of slope from one increment to the next, over the largest force, per length."""
        slope = np.diff(self.force) / np.diff(self.way)
        late = self.way[1:-1] > 0.2 * STROKE  # behind the first yield
        return float(np.abs(np.diff(slope))[late].max() / np.abs(self.force).max())


def table(strip: Strip, runs: dict[str, Bent], finest: Bent) -> str:
    """Table of a strip."""
    lines = [
        f"### {strip.name}\n",
        "| rule | deviation % | ripple % | jump of slope %/mm | penetration | iterations | CPU s | drift |",
        "|---|---:|---:|---:|---:|---:|---:|---:|",
    ]
    for name, run in {**runs, f"cells {FINEST}": finest}.items():
        apart = " | " if run is finest else f"{100 * run.deviation(finest):.2g} | {100 * run.ripple(finest):.2g}"
        lines.append(
            f"| {name} | {apart} | {100 * run.jump():.3g} | {run.penetration:.2g} | {run.iterations} "
            f"| {run.seconds:.1f} | {run.drift:.1e} |"
        )
    return "\n".join(lines)


def draw(strip: Strip, runs: dict[str, Bent], finest: Bent) -> None:
    """Force over way, and its difference from that of the finest cells."""
    with house_style():
        figure = Figure(figsize=(7.5, 5.2), layout="constrained")
        above, below = figure.subplots(2, 1, sharex=True)
        for name in ("Gauss 2", "Gauss 5", "cells 3"):
            run = runs[name]
            above.plot(run.way, run.force, label=name)
            below.plot(run.way, 100 * (run.force - np.interp(run.way, finest.way, finest.force)) / finest.force.max())
        above.plot(finest.way, finest.force, "k:", label=f"cells {FINEST}")
        above.set(ylabel="force N", title=strip.name, ylim=(0.75 * finest.force.max(), None))
        below.set(xlabel="way mm", ylabel="difference %", ylim=(-4, 4))
        above.legend()
        figure.savefig(FIGURE, dpi=120)


STRIPS = [
    Strip(name, cells, penalty, distorted)
    for name, cells, distorted in (
        ("ANS3DEAS", (24, 1), False),
        ("MI9K3DEAS", (12, 1), False),
        ("ANS3DEAS", (24, 3), True),
    )
    for penalty in (100.0, 1e4)
]
STRIPS.append(Strip("ANS3DEAS", (24, 1), 1e4, friction=0.1))


def main() -> None:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--steps", type=int, default=300, help="increments of each run")
    parser.add_argument("--strip", type=int, action="append", choices=range(len(STRIPS)), help="default: all")
    parser.add_argument("--page", action="store_true", help=f"put tables into {PAGE} and the picture beside it")
    record.add_option(parser)
    arguments = parser.parse_args()
    numbers: dict[str, float] = {}
    tables: list[str] = []
    for strip in [STRIPS[number] for number in arguments.strip or range(len(STRIPS))]:
        finest = strip.bend({"cells": FINEST}, arguments.steps)
        runs = {name: strip.bend(rule, arguments.steps) for name, rule in RULES.items()}
        tables.append(table(strip, runs, finest))
        print(tables[-1], flush=True)
        numbers |= {f"{strip.name}, {name}, deviation": run.deviation(finest) for name, run in runs.items()}
        if arguments.page and strip == STRIPS[1]:
            draw(strip, runs, finest)
    if arguments.page:
        record.put(PAGE, "tables", "\n\n".join(tables))
    record.write(arguments.json, "cells", numbers)


if __name__ == "__main__":
    main()

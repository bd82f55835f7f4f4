"""Continuum meshes of the same strips in CalculiX: quadratic elements C3D20R, several layers, plane strain.

Where the environment variable UMFORM_CALCULIX is set and ``ccx`` is found the cases run them again, which takes
minutes; else they take the forces that are stored. ``python -m umform_book.sharp_bends.calculix FOLDER`` makes
the stored files again.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from umform.errors import SolveError
from umform_book.calculix import EDGES, FIRST, Ring, contact_with_ring, element, metal, node_set, totals
from umform_book.references import table
from umform_book.sharp_bends.candidates import KAPPA, MU, YIELD_STRESS

Floats = NDArray[np.float64]
Point = tuple[float, float, float]

VARIABLE = "UMFORM_CALCULIX"
THICKNESS = 1.0
#: All forces are for this width; the mesh is as wide as 1.
WIDTH = 10.0


@dataclass(frozen=True)
class Continuum:
    """A strip of continuum elements.

    Attributes
    ----------
    over : {"supports", "cylinder", "fold"}
        Three-point bending without contact, the paper's strip over its cylinder, or a strip folded over a cylinder at
        x = 0.
    hardening : float
        Hardening modulus.
    layers : int
        Elements through the thickness.
    size, fine : float
        Length of the elements next to the punch, and as far as they are so small; beyond, they grow.
    stroke : float
        Displacement of the punch, or of the end.
    radius : float
        Of the cylinder.
    friction : float
        Coefficient on the cylinder.
    """

    over: str
    hardening: float
    layers: int
    size: float
    fine: float
    stroke: float
    radius: float = 20.0
    friction: float = 0.0

    @property
    def file(self) -> str:
        """Name of the file with the stored forces."""
        where = f"fold_R{self.radius:g}" if self.over == "fold" else self.over
        rough = f"_mu{self.friction:g}" if self.friction else ""
        return f"calculix_{where}_H{self.hardening:g}{rough}_{self.layers}_layers.csv"

    @property
    def length(self) -> float:
        """Half length of the strip."""
        return {"supports": 25.0, "cylinder": 60.0, "fold": 20.0}[self.over]

    @property
    def pushes(self) -> tuple[float, ...]:
        """Displacements at the ends of the steps."""
        return (self.stroke,) if self.over == "supports" else (FIRST, self.stroke)

    @property
    def driven(self) -> float:
        """Section whose lower edge is pushed."""
        return self.length if self.over == "fold" else 0.0


#: The meshes whose forces are stored.
STORED = (
    Continuum("supports", 500.0, 4, 0.25, 5.0, 15.0),
    Continuum("supports", 500.0, 6, 0.16666667, 4.0, 20.0),
    Continuum("supports", 100.0, 4, 0.25, 5.0, 20.0),
    Continuum("supports", 100.0, 6, 0.16666667, 4.0, 20.0),
    Continuum("supports", 0.0, 2, 0.5, 6.0, 15.0),
    Continuum("supports", 0.0, 4, 0.25, 5.0, 15.0),
    Continuum("cylinder", 500.0, 4, 0.25, 5.0, 15.0),
    Continuum("cylinder", 500.0, 6, 0.16666666, 4.0, 15.0),
    Continuum("fold", 500.0, 4, 0.5, 20.0, 12.0, 10.0),
    Continuum("cylinder", 500.0, 4, 0.25, 5.0, 15.0, friction=0.1),
    Continuum("cylinder", 500.0, 4, 0.25, 5.0, 15.0, friction=0.3),
)


def forces(mesh: Continuum) -> tuple[Floats, Floats, str]:
    """Displacements and forces of the punch, and where they come from: run now, or stored."""
    if os.environ.get(VARIABLE) and shutil.which("ccx"):
        with tempfile.TemporaryDirectory() as folder:
            u, force = run(mesh, Path(folder))
        return u, force, "run with this page"
    columns = table(mesh.file)
    return columns["u"], columns["force"], "stored"


def run(mesh: Continuum, folder: Path) -> tuple[Floats, Floats]:
    """Run CalculiX in a folder; displacements and forces of the punch.

    Raises
    ------
    SolveError
        If it does not reach the end.
    """
    (folder / "strip.inp").write_text(deck(mesh), encoding="ascii")
    log = subprocess.run(["ccx", "strip"], cwd=folder, capture_output=True, text=True, check=False)
    u, force = read_forces((folder / "strip.dat").read_text(encoding="ascii"), mesh.pushes)
    if u[-1] < mesh.stroke * (1 - 1e-9):
        raise SolveError("CalculiX did not reach the end", where=mesh.file, value=u[-1], cause=log.stdout[-500:])
    return u, force


def read_forces(printed: str, pushes: Sequence[float]) -> tuple[Floats, Floats]:
    """Displacements and forces from the totals that CalculiX prints for each increment; a step lasts for 1."""
    time, force = totals(printed)
    u = np.interp(np.append(0.0, time), np.arange(len(pushes) + 1.0), [0.0, *pushes])
    return u, np.append(0.0, -force[:, 2]) * WIDTH


def stations(mesh: Continuum, growth: float = 1.2, largest: float = 1.25) -> Floats:
    """Stations along the strip: equal elements near the punch, then growing ones."""
    x = list(np.arange(0.0, mesh.fine + 1e-9, mesh.size))
    equal, step = len(x), mesh.size
    while x[-1] < mesh.length:
        step = min(step * growth, largest)
        x.append(x[-1] + step)
    grid = np.array(x)
    last = grid[equal - 1]
    grid[equal:] = last + (grid[equal:] - last) * (mesh.length - last) / (grid[-1] - last)
    return grid


class _Deck:
    """Lines of a deck, with its nodes and elements."""

    def __init__(self, mesh: Continuum) -> None:
        self.ids: dict[Point, int] = {}
        self.elements: list[list[int]] = []
        self.lower: list[int] = []  # elements of the lowest layer
        x = stations(mesh)
        z = np.linspace(-0.5 * THICKNESS, 0.5 * THICKNESS, mesh.layers + 1)
        for i in range(len(x) - 1):
            for k in range(mesh.layers):
                around = ((0, 0), (1, 0), (1, 1), (0, 1))
                corners = [(x[i + a], float(b), z[k + c]) for c in (0, 1) for a, b in around]
                points = np.array(corners + [0.5 * np.add(corners[a], corners[b]) for a, b in EDGES])
                self.elements.append([self._node(point) for point in points])
                if k == 0:
                    self.lower.append(len(self.elements))
        self.lines = ["*NODE,NSET=NALL", *(f"{n},{p[0]:.9g},{p[1]:.9g},{p[2]:.9g}" for p, n in self.ids.items())]
        self.lines.append("*ELEMENT,TYPE=C3D20R,ELSET=STRIP")
        for number, nodes in enumerate(self.elements, 1):
            self.lines += element(number, nodes)

    def _node(self, point: Floats) -> int:
        key: Point = tuple(float(c) for c in np.round(point, 9))  # type: ignore[assignment]
        return self.ids.setdefault(key, len(self.ids) + 1)

    def material(self, hardening: float) -> None:
        """The steel."""
        young, nu = 9 * KAPPA * MU / (3 * KAPPA + MU), (3 * KAPPA - 2 * MU) / (2 * (3 * KAPPA + MU))
        self.lines += metal(young, nu, (YIELD_STRESS, hardening), "STRIP")

    def node_set(self, name: str, x: float, lower: bool) -> None:
        """Nodes of the section x, or of its lower edge."""
        z = -0.5 * THICKNESS
        chosen = [n for p, n in self.ids.items() if abs(p[0] - x) < 1e-6 and (not lower or p[2] == z)]
        self.lines += node_set(name, chosen)

    def step(self, largest: float = 0.02) -> None:
        """One step of large deformation with increments up to a part of it."""
        self.lines += ["*STEP,NLGEOM,INC=100000", "*STATIC", f"{largest / 10},1.,1e-9,{largest}"]

    def push(self, to: float) -> None:
        """Displacement of the punch at the end of the step, and printed output."""
        self.lines += ["*BOUNDARY", f"PUNCH,3,3,{-to}", "*NODE PRINT,NSET=PUNCH,TOTALS=ONLY", "RF", "*END STEP"]


def deck(mesh: Continuum) -> str:
    """Input of CalculiX."""
    made = _Deck(mesh)
    made.node_set("X0", 0.0, lower=False)
    made.node_set("PUNCH", mesh.driven, lower=True)
    supports = mesh.over == "supports"
    if supports:
        made.material(mesh.hardening)
        made.node_set("SUPPORT", mesh.length, lower=True)
        made.lines += ["*BOUNDARY", "X0,1,1", "NALL,2,2", "SUPPORT,3,3"]
    else:
        fold = mesh.over == "fold"
        x, between = (0.0, (20.0, 100.0)) if fold else (25.0, (45.0, 145.0))
        tool, held = Ring(mesh.radius, x, -0.5 * THICKNESS - mesh.radius, between).lines(
            len(made.ids), len(made.elements)
        )
        made.lines += tool
        made.material(mesh.hardening)
        made.lines += contact_with_ring(made.lower, 5000.0 if fold else 100.0, mesh.friction)
        made.lines += ["*BOUNDARY", "X0,1,1", "NALL,2,2", *(f"{node},1,3" for node in held)]
    for to in mesh.pushes:
        made.step()
        if supports:
            made.lines += ["*CONTROLS,PARAMETERS=FIELD", "1e-4,1e-2"]
        made.push(to)
    return "\n".join(made.lines) + "\n"


def csv_text(mesh: Continuum, u: Floats, force: Floats) -> str:
    """A file of stored forces."""
    lines = [
        f"# CalculiX 2.20, C3D20R, {mesh.layers} layers, elements of {mesh.size:.3g} in the hinge, H = "
        f"{mesh.hardening:g}, mu = {mesh.friction:g}, plane strain, {mesh.over}; force for a width of {WIDTH:g}.",
        "# Made by `python -m umform_book.sharp_bends.calculix FOLDER`; increments as CalculiX chose them.",
        "u,force",
        *(f"{a:.6g},{b:.6g}" for a, b in zip(u, force, strict=True)),
    ]
    return "\n".join(lines) + "\n"


def _make_files(folder: Path) -> None:
    for mesh in STORED:
        with tempfile.TemporaryDirectory() as scratch:
            text = csv_text(mesh, *run(mesh, Path(scratch)))
        (folder / mesh.file).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    _make_files(Path(sys.argv[1]))

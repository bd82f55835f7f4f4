"""Continuum meshes of the same strips in CalculiX: quadratic elements C3D20R, several layers, plane strain.

Where the environment variable UMFORM_CALCULIX is set and ``ccx`` is found the cases run them anew, which takes
minutes; else they take the forces that are stored. ``python -m umform.verification.sharp_bends.calculix FOLDER`` makes
the stored files anew.
"""

from __future__ import annotations

import os
import re
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
from umform.verification.references import table
from umform.verification.sharp_bends.candidates import KAPPA, MU, YIELD_STRESS

Floats = NDArray[np.float64]
Point = tuple[float, float, float]

VARIABLE = "UMFORM_CALCULIX"
THICKNESS = 1.0
#: CalculiX takes what it finds as penetration at the beginning of the first step for one of the mesh, and removes it in
#: proportion to the time of each step. A first step as short as this leaves nothing to remove: without it the force at
#: a displacement depends on the stroke of the step.
FIRST = 0.01
#: All forces are for this width; the mesh is as wide as 1.
WIDTH = 10.0
#: Edges of a hexahedron in the order of its mid-side nodes.
_EDGES = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))


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
    """

    over: str
    hardening: float
    layers: int
    size: float
    fine: float
    stroke: float
    radius: float = 20.0

    @property
    def file(self) -> str:
        """Name of the file with the stored forces."""
        where = f"fold_R{self.radius:g}" if self.over == "fold" else self.over
        return f"calculix_{where}_H{self.hardening:g}_{self.layers}_layers.csv"

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
    found = re.findall(r"total force.*time\s+(\S+)\s+\S+\s+\S+\s+(\S+)", printed)
    time, fz = (np.array([0.0, *(float(row[k]) for row in found)]) for k in (0, 1))
    return np.interp(time, np.arange(len(pushes) + 1.0), [0.0, *pushes]), -fz * WIDTH


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
                points = np.array(corners + [0.5 * np.add(corners[a], corners[b]) for a, b in _EDGES])
                self.elements.append([self._node(point) for point in points])
                if k == 0:
                    self.lower.append(len(self.elements))
        self.lines = ["*NODE,NSET=NALL", *(f"{n},{p[0]:.9g},{p[1]:.9g},{p[2]:.9g}" for p, n in self.ids.items())]
        self.lines.append("*ELEMENT,TYPE=C3D20R,ELSET=STRIP")
        for number, nodes in enumerate(self.elements, 1):
            self.lines += [",".join(map(str, [number, *nodes[:15]])) + ",", ",".join(map(str, nodes[15:]))]

    def _node(self, point: Floats) -> int:
        key: Point = tuple(float(c) for c in np.round(point, 9))  # type: ignore[assignment]
        return self.ids.setdefault(key, len(self.ids) + 1)

    def material(self, hardening: float) -> None:
        """The steel; its hardening is given up to a plastic strain of 5."""
        young, nu = 9 * KAPPA * MU / (3 * KAPPA + MU), (3 * KAPPA - 2 * MU) / (2 * (3 * KAPPA + MU))
        flow = [f"{YIELD_STRESS},0.", f"{YIELD_STRESS + 5 * hardening + 1e-6},5."]
        self.lines += ["*MATERIAL,NAME=STEEL", "*ELASTIC", f"{young:.9g},{nu:.9g}", "*PLASTIC", *flow]
        self.lines.append("*SOLID SECTION,ELSET=STRIP,MATERIAL=STEEL")

    def node_set(self, name: str, x: float, lower: bool) -> None:
        """Nodes of the section x, or of its lower edge."""
        z = -0.5 * THICKNESS
        chosen = [n for p, n in self.ids.items() if abs(p[0] - x) < 1e-6 and (not lower or p[2] == z)]
        self.lines.append(f"*NSET,NSET={name}")
        self.lines += [",".join(map(str, chosen[i : i + 10])) for i in range(0, len(chosen), 10)]

    def step(self, largest: float = 0.02) -> None:
        """One step of large deformation with increments up to a part of it."""
        self.lines += ["*STEP,NLGEOM,INC=100000", "*STATIC", f"{largest / 10},1.,1e-9,{largest}"]

    def push(self, to: float) -> None:
        """The displacement of the punch at the end of the step, and what is printed."""
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
        held = _cylinder(made, mesh.radius, 0.0, (20.0, 100.0)) if fold else _cylinder(made, mesh.radius)
        made.material(mesh.hardening)
        _contact(made, 5000.0 if fold else 100.0)
        made.lines += ["*BOUNDARY", "X0,1,1", "NALL,2,2", *(f"{node},1,3" for node in held)]
    for to in mesh.pushes:
        made.step()
        if supports:
            made.lines += ["*CONTROLS,PARAMETERS=FIELD", "1e-4,1e-2"]
        made.push(to)
    return "\n".join(made.lines) + "\n"


def _cylinder(
    made: _Deck,
    radius: float,
    centre: float = 25.0,
    between: tuple[float, float] = (45.0, 145.0),
    facets: int = 400,
) -> tuple[int, int]:
    """The tool: a ring of facets in a rigid body between two angles in degrees; returns its reference nodes."""
    z = -0.5 * THICKNESS - radius
    first = node = len(made.ids)
    made.lines.append("*NODE,NSET=NTOOL")
    for angle in np.radians(np.linspace(*between, facets + 1)):
        for r, y in ((radius, -0.1), (radius, 1.1), (0.8 * radius, -0.1), (0.8 * radius, 1.1)):
            node += 1
            made.lines.append(f"{node},{centre + r * np.cos(angle):.9g},{y:.9g},{z + r * np.sin(angle):.9g}")
    held = node + 1, node + 2
    made.lines += ["*NODE", *(f"{n},{centre},0,{z}" for n in held), "*ELEMENT,TYPE=C3D8,ELSET=TOOL"]
    for i in range(facets):
        a = first + 4 * i
        b = a + 4
        nodes = (a + 3, a + 4, b + 4, b + 3, a + 1, a + 2, b + 2, b + 1)
        made.lines.append(",".join(map(str, [len(made.elements) + 1 + i, *nodes])))
    made.lines.append(f"*RIGID BODY,NSET=NTOOL,REF NODE={held[0]},ROT NODE={held[1]}")
    return held


def _contact(made: _Deck, penalty: float) -> None:
    """Surface to surface, the pressure linear in the penetration."""
    made.lines += ["*SURFACE,NAME=SLOWER", *(f"{number},S1" for number in made.lower), "*SURFACE,NAME=STOOL", "TOOL,S2"]
    made.lines += ["*MATERIAL,NAME=TOOL", "*ELASTIC", "210000,.3", "*SOLID SECTION,ELSET=TOOL,MATERIAL=TOOL"]
    made.lines += ["*SURFACE INTERACTION,NAME=PENALTY", "*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR"]
    made.lines += [f"{penalty},0.,0.01", "*CONTACT PAIR,INTERACTION=PENALTY,TYPE=SURFACE TO SURFACE", "SLOWER,STOOL"]


def csv_text(mesh: Continuum, u: Floats, force: Floats) -> str:
    """A file of stored forces."""
    lines = [
        f"# CalculiX 2.20, C3D20R, {mesh.layers} layers, elements of {mesh.size:.3g} in the hinge, H = "
        f"{mesh.hardening:g}, plane strain, {mesh.over}; force for a width of {WIDTH:g}.",
        "# Made by `python -m umform.verification.sharp_bends.calculix FOLDER`; increments as CalculiX chose them.",
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

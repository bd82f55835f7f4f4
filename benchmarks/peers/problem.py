"""A problem as plain data, which every code is given: mesh, material, supports, loads, rigid cylinder, measures.

This file needs numpy alone: codes that live in an environment of their own read it too.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from json import dumps, loads
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]

#: Cell by the number of its nodes.
CELLS = {4: "quad4", 8: "hex8", 18: "hex18", 20: "hex20"}


@dataclass(frozen=True)
class Tool:
    """Rigid cylinder along y under the sheet.

    Attributes
    ----------
    x, z, radius : float
        Axis and radius.
    penalty : float
        Pressure per penetration.
    facets : int
        Flat facets of its arc, in codes that know no cylinder.
    """

    x: float
    z: float
    radius: float
    penalty: float
    facets: int


@dataclass(frozen=True)
class Problem:
    """A static problem.

    Attributes
    ----------
    points : ndarray, shape (n, 3)
        Nodes.
    cells : ndarray, shape (m, k)
        Nodes of the cells, numbered as in CalculiX and Kratos (hex18: as in umform).
    young, poisson : float
        Elastic constants.
    fixed : ndarray, shape (k, 2)
        Held displacements: node and axis.
    forces : ndarray, shape (n, 3)
        Nodal forces at full load.
    levels : int
        Equal load levels.
    large : bool
        Large displacements; else one linear step.
    probes : dict of str to ndarray
        Nodes whose mean displacement at full load is measured.
    flow : tuple of float, optional
        Yield stress and linear hardening modulus.
    pushed : ndarray, optional
        Nodes whose z is moved by ``stroke``; their reaction is measured at every level.
    tool : Tool, optional
        What the lower faces of the cells ``touching`` may touch.
    thickness : float
        Of the sheet, for codes with shell elements.
    """

    points: Floats
    cells: Ids
    young: float
    poisson: float
    fixed: Ids
    probes: dict[str, Ids]
    forces: Floats | None = None
    levels: int = 1
    large: bool = True
    flow: tuple[float, float] | None = None
    pushed: Ids = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    stroke: float = 0.0
    tool: Tool | None = None
    touching: Ids = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    thickness: float = 1.0

    @property
    def cell(self) -> str:
        """Kind of the cells."""
        return CELLS[self.cells.shape[1]]

    @property
    def unknowns(self) -> int:
        """Displacements that are not held."""
        per_node = 6 if self.cell == "quad4" else 3
        return per_node * len(self.points) - len(self.fixed) - len(self.pushed)

    def save(self, path: Path) -> None:
        """Write it to a file."""
        arrays = {name: getattr(self, name) for name in ("points", "cells", "fixed", "pushed", "touching")}
        if self.forces is not None:
            arrays["forces"] = self.forces
        arrays |= {f"probe_{name}": ids for name, ids in self.probes.items()}
        plain = {name: getattr(self, name) for name in ("young", "poisson", "levels", "large", "flow", "stroke")}
        plain["thickness"] = self.thickness
        plain["tool"] = None if self.tool is None else asdict(self.tool)
        np.savez(path, plain=np.array(dumps(plain)), **arrays)

    @classmethod
    def load(cls, path: Path) -> Problem:
        """Read it from a file."""
        with np.load(path) as file:
            arrays = dict(file)
        plain = loads(str(arrays.pop("plain")))
        plain["tool"] = None if plain["tool"] is None else Tool(**plain["tool"])
        plain["flow"] = None if plain["flow"] is None else tuple(plain["flow"])
        probes = {name.removeprefix("probe_"): arrays.pop(name) for name in list(arrays) if name.startswith("probe_")}
        return cls(**arrays, **plain, probes=probes)

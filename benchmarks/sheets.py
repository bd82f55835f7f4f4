"""The sheet that the kernels are measured on: every element with every law, stretched and sheared so that it flows."""

from __future__ import annotations

from typing import Any

import numpy as np

import umform as uf

STEEL = {"E": 210e3, "nu": 0.3}
LAWS = {
    "SVK": uf.SVK(**STEEL),
    "NeoHooke": uf.NeoHooke(**STEEL),
    "NeoHookePower": uf.NeoHookePower(**STEEL),
    "J2 elastic": uf.J2(**STEEL, hardening=uf.Linear(yield_stress=1e6, modulus=500.0)),
    "J2 plastic": uf.J2(**STEEL, hardening=uf.Linear(yield_stress=160.0, modulus=500.0)),
    "J2 Voce": uf.J2(**STEEL, hardening=uf.Voce(160.0, 320.0, 15.0)),
}


def through(name: str) -> dict[str, Any]:
    """Points and order through the thickness of a plastic sheet: those of the literature, and what sharp bends need."""
    if name.startswith("BEND"):
        return {"thickness_order": 4, "thickness_points": 12, "thickness_rule": "split"}
    return {"thickness_points": 5} | ({} if name in ("DISP3D", "DISP9K3D") else {"thickness_order": 1})


def stretched(mesh: uf.Mesh, side: float) -> np.ndarray:
    """Displacements that stretch and shear it beyond a yield stress of 160."""
    x, y, z = mesh.points.T
    return np.stack([4e-3 * x + 1e-3 * y, -1e-3 * y, -2e-3 * z + 1e-3 / side * x * y], axis=1).ravel()


def sheet(name: str, law: str, cells: tuple[int, int], side: float = 100.0) -> tuple[uf.Model, np.ndarray]:
    """A square sheet of 1 mm, and displacements that stretch and shear it beyond a yield stress of 160."""
    mesh = uf.mesh.strip(length=side, width=side, thickness=1.0, cells=cells, cell=uf.elements.element(name).cell)
    model = uf.Model(mesh, name, material=LAWS[law], **(through(name) if law.startswith("J2") else {}))
    model.fix("x0")
    return model, stretched(mesh, side)

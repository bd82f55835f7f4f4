"""Builders of the verification cases that more than one test takes."""

from __future__ import annotations

import numpy as np

import umform as uf
from umform_book.references import table

__all__ = ["table"]

#: The steel of the free bending example: N, mm, MPa, perfect plasticity.
STEEL = uf.J2(kappa=175000, mu=80770, hardening=uf.Perfect(160.0))


def free_bending(
    cells: tuple[int, int], element: str | uf.Element, points: int | str, **options
) -> tuple[uf.Model, object]:
    """The free bending example (reference/free_bending.csv says what is known of it): model, control of the punch."""
    cell = element.cell if isinstance(element, uf.Element) else uf.elements.element(element).cell
    mesh = uf.mesh.strip(60, 10, 1, cells, cell=cell)
    model = uf.Model(mesh, element, material=STEEL, **{"thickness_points": 5, **options})
    model.symmetry("x0", "x")
    model.fix(np.intersect1d(mesh.nodes("x0_lower"), mesh.nodes("y0")), "y")
    punch = model.prescribe("x0_lower", "z", "punch")
    model.contact("lower", uf.Cylinder((25, 0, -20.5), "y", 20.0), penalty=100.0, points=points, name="cylinder")
    return model, punch

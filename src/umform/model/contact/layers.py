"""Layers of clad metal behind faces in contact."""

from __future__ import annotations

import numpy as np

from umform.mesh import Ids
from umform.mesh.part import stacks
from umform.model.bodies.bodies import Bodies
from umform.model.contact.encounter import Layer, cells_thickness


def layers_behind(bodies: Bodies, cells: Ids) -> list[Layer]:
    """Layers of the sheet behind some cells at its face, that of the face first."""
    first = bodies.of(cells)
    if len(bodies) == 1:
        return [Layer(first.material)]
    stack = stacks(first.mesh)
    behind = np.isin(stack, stack[np.intersect1d(cells, first.cells)])
    parts = [(body, body.cells[behind[body.cells]]) for body in [first, *(one for one in bodies if one is not first)]]
    found = [Layer(body.material, cells_thickness(body.mesh, part)) for body, part in parts if len(part)]
    return found if len(found) > 1 else [Layer(first.material)]

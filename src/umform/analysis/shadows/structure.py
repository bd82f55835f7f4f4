"""What a shadow must share with its run: elements, controls, contacts, kinds of steps."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from umform.analysis.steps import Step
from umform.mesh import Ids
from umform.model import Model
from umform.model.contact.sheets import SheetContact


def other_structure(model: Model, steps: Sequence[Step], other: Model, other_steps: Sequence[Step]) -> str:
    """How the structure of another model differs; empty if it does not."""
    one, two = model.mesh, other.mesh
    if not np.array_equal(one.connectivity, two.connectivity) or len(one.points) != len(two.points):
        return f"{len(two.connectivity)} elements in place of {len(one.connectivity)}"
    if [type(step) for step in steps] != [type(step) for step in other_steps]:
        return f"{len(other_steps)} steps in place of {len(steps)}"
    names, other_names = ([control.name for control in each.controls] for each in (model, other))
    if names != other_names:
        return f"controls {', '.join(other_names)} in place of {', '.join(names)}"
    pairs, other_pairs = _facets(model), _facets(other)
    for name in {**pairs, **other_pairs}:
        faces, other_faces = pairs.get(name, np.empty(0)), other_pairs.get(name, np.empty(0))
        if not np.array_equal(faces, other_faces):
            return f"contact {name} with {len(other_faces)} faces in place of {len(faces)}"
    return ""


def _facets(model: Model) -> dict[str, Ids]:
    """Nodes of the facets of each contact; of sheets those of one side after the other."""
    return {
        pair.name: np.concatenate(pair.facets) if isinstance(pair, SheetContact) else pair.facets
        for pair in model.system.penalised
    }

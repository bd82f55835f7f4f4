"""What a shadow must share with its run: elements, controls, contacts, kinds of steps; how far its tools are off."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from umform.analysis.steps import Step
from umform.mesh import Ids
from umform.model import Model
from umform.model.contact import Contact
from umform.model.contact.encounter import sheet_thickness
from umform.model.contact.sheets import SheetContact


def other_structure(model: Model, steps: Sequence[Step], other: Model, other_steps: Sequence[Step]) -> str:
    """Difference between the structures of two models as text; empty if there is none."""
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


def relative_motion(model: Model, other: Model) -> float:
    """How far tools and sheet, or sheets in contact, of another model of this structure are off, in thicknesses."""
    places, other_places = (each.mesh.points + each.u.reshape(-1, 3) for each in (model, other))
    moved = other_places - places
    found = [np.ptp(moved[_nodes(pair)], axis=0) for pair in model.system.sheet_contacts]
    for pair, another in zip(model.contacts, other.contacts, strict=True):
        nodes = _nodes(pair)
        with np.errstate(invalid="ignore"):  # a tool without a distance there
            found.append(another.gap(other_places[nodes]) - pair.gap(places[nodes]))
    most = max((float(np.abs(each[np.isfinite(each)]).max(initial=0.0)) for each in found), default=0.0)
    return most / sheet_thickness(model.mesh) if most else 0.0


def _nodes(pair: Contact | SheetContact) -> Ids:
    return np.unique(np.concatenate(pair.facets) if isinstance(pair, SheetContact) else pair.facets)


def _facets(model: Model) -> dict[str, Ids]:
    """Nodes of the facets of each contact; of sheets those of one side after the other."""
    return {
        pair.name: np.concatenate(pair.facets) if isinstance(pair, SheetContact) else pair.facets
        for pair in model.system.penalised
    }

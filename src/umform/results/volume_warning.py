"""Warning of elements that are too coarse for their strains: metal keeps its volume, their mesh does not."""

from __future__ import annotations

from umform.materials.j2 import Plastic
from umform.model import Model
from umform.results.history import History
from umform.results.volume import volume_change

#: Volume that the mesh of a sheet may gain or lose, relative to the whole one.
_LIMIT = 0.03


def warn_of_volume(model: Model, result: History) -> None:
    """Warn if the mesh has gained or lost more volume than metal can; its strains by themselves keep it."""
    if model.system.ranks.size > 1 or not all(isinstance(body.material, Plastic) for body in model.bodies):
        return  # a rank has a part of the sheet only; laws of users may change the volume
    change = volume_change(model)
    gained = change.mesh - change.elastic
    if abs(gained) > _LIMIT:
        message = (
            f"the mesh has {'gained' if gained > 0.0 else 'lost'} {100.0 * abs(gained):.2g} % of its volume, which "
            "metal keeps: elements are too coarse for their strains, and thickness and forces are wrong there; "
            "smaller elements where the sheet is bent or has thinned most"
        )
        if message not in result.warnings:  # a run that was taken up at its end
            result.warn(message)

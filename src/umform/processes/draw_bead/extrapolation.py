"""Numbers of a bead, extrapolated to zero element size."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from umform.processes.extrapolation import FINER, ORDER, Limit

if TYPE_CHECKING:
    from umform.processes.draw_bead.measures import Drawn

#: Orders of convergence; the thinning of BEND8 converges with the length of the elements.
ORDERS = {"restraint": ORDER, "uplift": ORDER, "closing_force": ORDER, "thinning": 1.0}


def of_three(meshes: Sequence[Drawn]) -> dict[str, Limit]:
    """Limits with their errors, of three meshes each :data:`FINER` than the one before."""
    numbers = {name: [getattr(mesh, name) for mesh in meshes] for name in ORDERS}
    return {name: Limit.of_three(numbers[name], FINER, order) for name, order in ORDERS.items()}


def of_two(coarse: Drawn, fine: Drawn) -> dict[str, Limit]:
    """Limits without an error, of two meshes."""
    refined = fine.case.elements / coarse.case.elements
    numbers = {name: (getattr(coarse, name), getattr(fine, name)) for name in ORDERS}
    return {name: Limit.of(*numbers[name], refined, order) for name, order in ORDERS.items()}

"""A run on all ranks: the model is shared, the steps are those of the share, and the result is that of the whole."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from umform.arc import Arc
from umform.boundary import Control, Load
from umform.distributed.mpi_ranks import MpiRanks, world
from umform.distributed.partition import partition
from umform.distributed.share import Share
from umform.distributed.solver import Petsc
from umform.distributed.together import together
from umform.errors import InvalidValue
from umform.fingerprint import digest
from umform.model import Model
from umform.model_checks import check_nodes
from umform.move import Move
from umform.release import Release
from umform.results import Result
from umform.solvers import register
from umform.whole import not_here

Step = Move | Release | Arc


def on_ranks(model: Model, steps: Sequence[Step], work: Callable[[Model, Sequence[Step]], Result]) -> Result:
    """Share a model among all ranks and run steps on it.

    Parameters
    ----------
    model : Model
        The whole model, which all ranks have built alike.
    steps : sequence of Step
        What happens to it.
    work : callable
        Runs steps on a model: here on the share of each rank, with its controls.

    Returns
    -------
    Result
        On all ranks the history, on the first one also the frames; only the first one writes files.

    Raises
    ------
    InvalidValue
        If a step cannot be run on ranks.
    """
    ranks = world()
    with together(ranks):
        share, own = _shared(model, steps, ranks)
    try:
        with together(ranks):
            result = work(share, own)
    except BaseException as error:  # all ranks have come here
        _give_back(share, getattr(error, "result", None))
        raise
    _give_back(share, result)
    return result


def _shared(model: Model, steps: Sequence[Step], ranks: MpiRanks) -> tuple[Share, list[Step]]:
    """The share of this rank, and the steps with its controls."""
    for number, step in enumerate(steps, start=1):
        if isinstance(step, Arc):
            raise InvalidValue(
                "an arc cannot be followed with the solver petsc",
                where=f"step {number}",
                cause="the load is one more unknown, and critical points are looked for in the whole tangent",
                remedy="another solver in one process, or Move and Release",
            )
    if ranks.rank > 0:
        logging.getLogger("umform").setLevel(logging.CRITICAL + 1)  # the first rank talks
    if model.elsewhere:
        raise not_here("the history of the elements")
    check_nodes(model.mesh)
    _check_alike(model, ranks)
    register(Petsc.name, Petsc)
    share = Share(model, partition(model.mesh, ranks), ranks)
    return share, [_own_step(step, share) for step in steps]


def _own_step(step: Step, share: Share) -> Step:
    """The same step of the controls of a share."""
    moved = step.control
    own: Any = share.twin[moved] if isinstance(moved, Control) else [share.twin[control] for control in moved]
    return replace(step, control=own)


def _check_alike(model: Model, ranks: MpiRanks) -> None:
    """Refuse models that are not the same on all ranks."""
    mesh, loads = model.mesh, [load.vector for load in model.of_kind(Load)]
    facets = [contact.facets for contact in model.contacts]
    mine = digest(mesh.points, mesh.connectivity, model.constrained(), *loads, *facets)
    first = ranks.comm.bcast(mine)
    if ranks.any(mine != first):
        raise InvalidValue(
            "the ranks have built different models",
            cause="random numbers, or files that are not the same on all machines",
            remedy="build the same mesh, supports, loads and contacts on all ranks",
        )


def _give_back(share: Share, result: Result | None) -> None:
    """Leave the whole model at the last converged state: its displacement on the first rank, NaN on the others."""
    whole = share.whole
    u = share.gathering.displacement(share.u)
    whole.u = np.broadcast_to(np.nan, whole.u.shape) if u is None else u
    whole.time = share.time
    for control, own in share.twin.items():
        control.value = own.value
    whole.elsewhere = True
    vars(whole).pop("block", None)
    for contact, part in zip(whole.contacts, share.contacts, strict=True):
        contact.elsewhere = True
        for made in ("block", "multipliers"):
            vars(contact).pop(made, None)
        contact.put(part.pose)
    if result is not None:
        result.model = whole

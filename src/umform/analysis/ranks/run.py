"""A run on all ranks: each has a share of the model and its steps; the result is that of the whole model."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from umform.analysis.ranks.outline import Outline
from umform.analysis.ranks.share import Share
from umform.analysis.steps import Arc, Step
from umform.digest import digest
from umform.errors import InvalidValue, UmformError
from umform.model import Model, Tool
from umform.model.changes.removal import put_supports, states_of_supports
from umform.model.equations.checks import check_nodes
from umform.model.terms.dead_load import Load
from umform.model.terms.elsewhere import not_here
from umform.parallel.cutting import Cutting
from umform.parallel.mpi_ranks import MpiRanks, world
from umform.parallel.partition import partition
from umform.parallel.solver import Petsc
from umform.parallel.together import together
from umform.results.history import History
from umform.solvers import register

Floats = NDArray[np.float64]
_H = TypeVar("_H", bound=History)


def on_ranks(
    model: Model | None, steps: Callable[[], Sequence[Step]], work: Callable[[Model, Sequence[Step]], _H]
) -> _H:
    """Share a model among all ranks and run steps on it.

    Parameters
    ----------
    model : Model or None
        The whole model; None on all ranks but the first, or else all have built it alike.
    steps : callable
        Returns the steps for the model of this rank, or refuses it.
    work : callable
        Runs steps on a model: on the share of each rank, with its controls.

    Returns
    -------
    History or a class derived from it
        On all ranks the history, on the first one also the frames; only the first one writes files.

    Raises
    ------
    InvalidValue
        If a step cannot be run on ranks, or the first one has no model.
    """
    ranks = world()
    with together(ranks):
        share, own = _shared(model, steps, ranks)
    try:
        with together(ranks):
            result = work(share, own)
    except BaseException as error:  # all ranks have arrived
        _give_back(share, getattr(error, "result", None))
        raise
    _give_back(share, result)
    return result


def _shared(model: Model | None, steps: Callable[[], Sequence[Step]], ranks: MpiRanks) -> tuple[Share, Sequence[Step]]:
    """The share of this rank, and the steps with its controls."""
    if ranks.rank > 0:
        logging.getLogger("umform").setLevel(logging.CRITICAL + 1)  # the first rank prints
    outline = problem = None
    try:
        outline = None if model is None else _outline(model, steps(), ranks)
    except UmformError as error:
        problem = error
    ranks.agree(problem)
    if ranks.any(model is None):
        outline = Outline.from_first(outline, ranks)
    elif model is not None:
        _check_alike(model, ranks)
    assert outline is not None
    register(Petsc.name, Petsc)
    return hand_out(outline, model, ranks), outline.steps


def _outline(model: Model, steps: Sequence[Step], ranks: MpiRanks) -> Outline:
    """The outline of a model that can be distributed."""
    for number, step in enumerate(steps, start=1):
        if isinstance(step, Arc):
            raise InvalidValue(
                "an arc cannot be followed with the solver petsc",
                where=f"step {number}",
                cause="the load is one more unknown, and critical points are looked for in the whole tangent",
                remedy="another solver in one process, or Move and Release",
            )
    asked_by = {part.by for part in model.supports.rows} | {
        str(holder) for holder in model.supports.holders if len(holder.rows)
    }
    if asked_by:
        raise InvalidValue(
            "supports in local axes do not work with the solver petsc",
            where="supports",
            value=", ".join(sorted(asked_by)),
            cause="ranks share out single degrees of freedom and pairs of them",
            remedy="another solver in one process, or supports along x, y and z",
        )
    _refuse_what_cannot_be_cut(model)
    if model.system.whole.elsewhere:
        raise not_here("the history of the elements")
    if ranks.rank == 0:
        check_nodes(model.mesh)
    return Outline.of(model, steps)


def _refuse_what_cannot_be_cut(model: Model) -> None:
    """Reject terms that cannot be distributed."""
    if model.system.sheet_contacts:
        raise InvalidValue(
            "sheets that touch cannot be shared with the solver petsc",
            where=", ".join(f"contact {contact.name}" for contact in model.system.sheet_contacts),
            cause="a rank has the points of its part of the mesh, and not the faces that they may meet",
            remedy="another solver in one process",
        )
    for term in model.system.others:
        if not term.shareable:
            raise InvalidValue(
                "a term cannot be shared with the solver petsc",
                where=f"term {type(term).__name__} {term.name!r}",
                cause="it does not say what each rank gets of it",
                remedy="derive it from NodalTerm, or give it strip(), piece() and fill(); or another solver",
            )


def _check_alike(model: Model, ranks: MpiRanks) -> None:
    """Reject models that differ between the ranks."""
    mesh, loads = model.mesh, [load.vector for load in model.controls.of_kind(Load)]
    facets = [contact.facets for contact in model.contacts]
    coupled = [part.ids for term in model.system.others for part in term.couples()]
    mine = digest(mesh.points, mesh.connectivity, model.supports.constrained(), *loads, *facets, *coupled)
    first = ranks.comm.bcast(mine)
    if ranks.any(mine != first):
        raise InvalidValue(
            "the ranks have built different models",
            cause="random numbers, or files that are not the same on all machines",
            remedy="build the same mesh, supports, loads and contacts on all ranks, or all on the first one alone",
        )


def hand_out(outline: Outline, model: Model | None, ranks: MpiRanks) -> Share:
    """The share of this rank in the model that the first rank has."""
    if ranks.rank > 0:
        partition(None, ranks)
        return Share(outline, ranks.comm.recv(source=0), ranks, model)
    assert model is not None
    part = partition(model.mesh, ranks)
    assert part is not None
    cutting = Cutting(model, part, ranks.size)
    for rank in range(1, ranks.size):
        ranks.comm.send(cutting.parcel(rank), dest=rank)
    return Share(outline, cutting.parcel(0), ranks, model)


def _give_back(share: Share, result: History | None) -> None:
    """Leave the whole model at the last converged state: nodal data on the first rank, NaN on the others."""
    gathering, whole = share.system.gathering, share.whole
    u, supports = gathering.displacement(share.u), gathering.supports(states_of_supports(share.system))
    loads = [None if tool.load is None else gathering.displacement(tool.load.vector) for tool in share.tools]
    if whole is None:
        return
    system = whole.system
    system.u, system.time = np.full_like(system.u, np.nan) if u is None else u, share.system.time
    for control, own in zip(whole.controls, share.controls, strict=True):
        control.value = own.value
    for tool, own_tool, vector in zip(whole.tools, share.tools, loads, strict=True):
        _give_back_tool(tool, own_tool, vector)
    put_supports(system, supports)
    for unknown, own_unknown in zip(system.unknowns, share.system.unknowns, strict=True):
        unknown.value = own_unknown.value
    system.whole.elsewhere = True
    for thing in (*whole.bodies, *whole.contacts, *system.others):
        thing.elsewhere = True
        for made in ("block", "_areas", "_no_multipliers"):
            vars(thing).pop(made, None)
    if result is not None:
        result.model = whole


def _give_back_tool(tool: Tool, own: Tool, vector: Floats | None) -> None:
    """Set the pose of a tool of the whole model, and whether it is open, from the share."""
    tool.open = own.open
    if tool.load is not None and vector is not None:
        tool.load.vector = vector
    for press, own_press in zip(tool.presses, own.presses, strict=True):
        press.unknown.value, press.held = own_press.unknown.value, own_press.held

"""Remove supports and tools from a model; their forces become a dead load, which can then decrease to zero.

The load is the residual r of the model without the removed object over the new unknowns, T T^T r; the columns of T are
orthonormal, so the present state is in equilibrium at the factor 1. eq. (5.45)
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.model.contact import Contact
from umform.model.equations.evaluated import Evaluated
from umform.model.supports.support import Support
from umform.model.terms.dead_load import Load

#: Displacement that counts as zero when an operation begins, relative to the extent of the sheet.
_AT_REST = 1e-9


def remove(model: Evaluated, thing: Support | Contact) -> Load:
    """Remove a support or a contact; its forces remain as a load of factor 1.

    Parameters
    ----------
    model : Model
        The model at a converged state.
    thing : Support or Contact
        The object to remove.

    Returns
    -------
    Load
        The control of the forces.

    Raises
    ------
    InvalidValue
        If the model does not have it.
    """
    if isinstance(thing, Contact):
        return _remove_contact(model, thing)
    if thing not in model.supports:
        raise InvalidValue(
            "the model has no such support",
            where="remove()",
            value=thing,
            cause="it has been removed already, or belongs to another model",
            remedy="take what fix(), symmetry(), hinge() or hold_director() of this model returned",
        )
    load = fading(model, thing)
    before, value = load.vector, load.value
    load.value, thing.removed = 0.0, True
    try:
        model.supports.hold_again()
        load.vector = unbalanced(model)
    except BaseException:
        load.vector, load.value, thing.removed = before, value, False
        model.supports.hold_again()
        raise
    load.value = 1.0
    return load


def put_back(model: Evaluated, support: Support, *, here: bool = True) -> None:
    """Restore a removed support, with its nodes in their present or undeformed positions.

    Raises
    ------
    InvalidValue
        If it is active, or contradicts a support that was added since.
    """
    if support not in model.supports.all or not support.removed:
        raise InvalidValue(
            "the support has not been removed",
            where="put_back()",
            value=support,
            cause="it acts, or belongs to another model",
            remedy="put back what remove() or a step Free has taken away",
        )
    model.supports.refuse_taken(support)
    before = support.base
    support.hold_at(model.u.copy() if here else None)
    support.removed = False
    try:
        model.supports.hold_again()
    except BaseException:
        support.hold_at(before)
        support.removed = True
        raise
    if support.load is not None:
        support.load.value = 0.0


def fading(model: Evaluated, support: Support) -> Load:
    """The control of the forces that replace a support after its removal; zero before."""
    if support.load is None:
        zero = np.zeros_like(model.u)
        support.load = model.controls.add(Load(model.controls.free_name(support.name), vector=zero))
    return support.load


def states_of_supports(model: Evaluated) -> dict[str, Any]:
    """State of the supports: whether removed, base displacement, and replacing forces of those that have had any."""
    return {
        support.name: {
            "removed": support.removed,
            "base": None if support.base is None else support.base.copy(),
            "vector": None if support.load is None else support.load.vector.copy(),
        }
        for support in model.supports.all
    }


def put_supports(model: Evaluated, states: Mapping[str, Any]) -> None:
    """Restore the supports to a state from :func:`states_of_supports`."""
    changed = False
    for support in model.supports.all:
        if support.name not in states:
            continue
        state = states[support.name]
        base, removed = state["base"], bool(state["removed"])
        if support.load is not None:
            unknown = np.nan if removed else 0.0  # known on the first rank only, or of a step that was yet to come
            vector = state["vector"]
            support.load.vector = np.full_like(model.u, unknown) if vector is None else np.array(vector)
        if support.removed == removed and _same(support.base, base):
            continue
        changed, support.removed = True, removed
        support.hold_at(base)
    if model.ranks.any(changed):
        model.supports.hold_again()


def _same(one: NDArray[np.float64] | None, other: NDArray[np.float64] | None) -> bool:
    return one is other if one is None or other is None else np.array_equal(one, other)


def _remove_contact(model: Evaluated, contact: Contact) -> Load:
    if contact not in model.pairs_of_tools():
        raise InvalidValue(
            "the model has no such contact",
            where="remove()",
            value=contact.name,
            cause="it has been removed already, or belongs to another model",
            remedy="take what contact() of this model returned",
        )
    lists: list[list[Any]] = [model.contacts, model.others, model.tools, model.controls]
    before, tool = [list(one) for one in lists], contact.tool
    load = Load(model.controls.free_name(contact.name), vector=np.zeros_like(model.u))
    model.contacts[:] = [other for other in model.contacts if other is not contact]
    model.others[:] = [other for other in model.others if other is not contact]
    tool.pairs.remove(contact)
    if not tool.pairs:
        gone = [*tool.ways, *(press.force for press in tool.presses)]
        model.tools[:] = [other for other in model.tools if other is not tool]
        model.controls[:] = [control for control in model.controls if control not in gone]
    model.now.restructured()
    try:
        load.vector = unbalanced(model)
        load = model.controls.add(load)
    except BaseException:
        for one, had in zip(lists, before, strict=True):
            one[:] = had
        tool.pairs.append(contact)
        model.now.restructured()
        raise
    load.value = 1.0
    return load


def balancing(model: Evaluated, name: str) -> Load:
    """A load of factor 1 of the unbalanced forces of a model at its present state. eq. (5.45)

    Raises
    ------
    InvalidValue
        If supports hold nodes away from their present positions, or the name is taken.
    """
    refuse_elsewhere(model, "unbalanced()")
    load = model.controls.add(Load(name, vector=np.zeros_like(model.u)))
    load.vector = unbalanced(model)
    load.value = 1.0
    return load


def refuse_elsewhere(model: Evaluated, where: str) -> None:
    """Refuse supports and prescribed displacements that hold nodes away from their present positions.

    Raises
    ------
    InvalidValue
    """
    prescribed = np.concatenate([model.supports.prescribed() - model.u, np.zeros(len(model.unknowns))])
    away = (prescribed - model.extend(model.coefficients(prescribed)))[: model.u.size]
    if np.abs(away).max() > _AT_REST * model.extent:
        node = int(np.abs(away).argmax()) // 3
        raise InvalidValue(
            "a support holds a node elsewhere than it is",
            where=f"{where}, node {node}",
            value=f"{np.linalg.norm(away.reshape(-1, 3)[node]):.4g} away",
            cause="a support or a displacement that begins where nodes were in the undeformed mesh",
            remedy="tools or loads where nodes are to be moved; a part stays in its planes of symmetry; where a "
            'placement has moved these, kind = "fix" holds nodes where they are; in Python here=True in fix(), hinge() '
            "or hold_director()",
        )


def unbalanced(model: Evaluated) -> NDArray[np.float64]:
    """Unbalanced forces on the unknowns at the present state."""
    residual: NDArray[np.float64] = model.extend(model.restrict(model.evaluate(model.x).residual))
    forces = np.zeros((model.u.size // 3, 3))
    forces[model.whole.owned] = residual[: model.u.size].reshape(-1, 3)[model.whole.owned]  # a shared node counts once
    return forces.ravel()

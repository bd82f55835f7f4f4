"""Multipliers that take the penetration away which a penalty leaves: the loop of Uzawa around Newton's method."""

from __future__ import annotations

import logging
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from umform.errors import InvalidValue
from umform.newton import Converged, Newton

if TYPE_CHECKING:
    from umform.contact.pair import Contact
    from umform.model import Model
    from umform.results import Result

log = logging.getLogger("umform.contact")

#: Passes after which an increment is taken as it is; the history has the penetration that is left.
_PASSES = 10


def augmented(model: Model, newton: Newton, converged: Converged) -> Converged:
    """Hand the pressure over to the multipliers and iterate on, until no point is further off than allowed. eq. (4.34)

    Parameters
    ----------
    model : Model
        At ``converged``, not yet committed.
    newton : Newton
        The method that has converged.
    converged : Converged
        Equilibrium with the present multipliers.

    Raises
    ------
    Failed
        If a pass does not converge; the model is reverted, with its multipliers.
    """
    for number in range(1, _PASSES + 1):
        pairs = [
            contact for contact in model.contacts if contact.augmented and _anywhere(model, contact.active().any())
        ]
        if not pairs or (number > 1 and not _anywhere(model, any(contact.loose() for contact in pairs))):
            break
        change = np.zeros_like(converged.u)
        for contact in pairs:
            contact.augment(change)
        again = newton.go_on(converged, change)
        converged = replace(again, iterations=converged.iterations, passes=converged.passes + again.iterations)
        log.debug("    pass %d of the multipliers, %d iterations", number, len(again.iterations))
    return converged


def _anywhere(model: Model, flag: bool | np.bool_) -> bool:
    return model.ranks.any(bool(flag))


def refuse_on_an_arc(model: Model, where: str) -> None:
    """Refuse multipliers where the load is an unknown: they are found at fixed loads.

    Raises
    ------
    InvalidValue
        If a contact has them.
    """
    for contact in model.contacts:
        if contact.augmented:
            raise InvalidValue(
                "an arc cannot be followed with multipliers of contact",
                where=where,
                value=f"contact {contact.name}",
                cause="they are found at fixed loads, which a limit point does not have",
                remedy="augmented=False and the penetration that you allow",
            )


def penetrations(model: Model, result: Result) -> dict[str, str]:
    """Of each contact the largest penetration of a run, what was allowed, and the penalty and points that did it."""
    return {contact.name: _said(contact, _deepest(result, contact)) for contact in model.contacts}


def _deepest(result: Result, contact: Contact) -> float:
    return float(np.max(result[f"{contact.name}_penetration"])) if len(result) else 0.0


def _said(contact: Contact, deepest: float) -> str:
    allowed = "" if contact.allowed is None else f", {contact.allowed:.3g} allowed"
    rule = "at the nodes" if contact.points == "nodes" else f"{contact.points} x {contact.points} points a facet"
    return f"penetration up to {deepest:.3g}{allowed}; penalty {contact.penalty:.3g}, {rule}"


def warn_of_penetration(model: Model, result: Result) -> None:
    """Say once for each contact that the penetration has exceeded the allowed one, and what to do. eq. (4.30)"""
    for contact in model.contacts:
        deepest = _deepest(result, contact)
        if contact.allowed is None or deepest <= 1.01 * contact.allowed:
            continue
        stiffer = (deepest / contact.allowed) ** 1.5
        remedy = f"a penalty of {stiffer * contact.penalty:.3g}, {stiffer:.2g} times the present one"
        if not contact.augmented:
            remedy += ", or augmented=True"
        excess = f"the penetration of {deepest:.3g} exceeds the {contact.allowed:.3g} allowed"
        message = f"contact {contact.name}: {excess}; {remedy}"
        if message not in result.warnings:  # a run that was taken up at its end
            result.warn(message)

"""How far a run let the sheet into its tools, and whether that is more than was allowed."""

from __future__ import annotations

import numpy as np

from umform.model import Model
from umform.model.contact import Contact
from umform.results.history import History


def penetrations(model: Model, result: History) -> dict[str, str]:
    """Of each contact the largest penetration of a run, what was allowed, and the penalty and points that did it."""
    return {contact.name: _said(contact, _deepest(result, contact)) for contact in model.contacts}


def _deepest(result: History, contact: Contact) -> float:
    return float(np.max(result[f"{contact.name}_penetration"])) if len(result) else 0.0


def _said(contact: Contact, deepest: float) -> str:
    allowed = "" if contact.allowed is None else f", {contact.allowed:.3g} allowed"
    rule = (
        "at the nodes"
        if contact.points == "nodes"
        else f"{contact.points} x {contact.points} contact points on each facet"
    )
    return f"penetration up to {deepest:.3g}{allowed}; penalty {contact.penalty:.3g}, {rule}"


def warn_of_contact(model: Model, result: History) -> None:
    """Warn once for each contact whose penetration has exceeded the allowed one, with a remedy. eq. (4.30)"""
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

"""How far a run let the sheet into its tools, and whether that is more than was allowed."""

from __future__ import annotations

import numpy as np

from umform.model import Model
from umform.model.contact import Contact
from umform.model.contact.encounter import sheet_thickness
from umform.results.history import History

#: Penetration relative to the thickness that is reported, and that of a sufficient penalty.
_DEEP, _SHALLOW = 0.1, 0.02


def penetrations(model: Model, result: History) -> dict[str, str]:
    """Of each contact the largest penetration of a run, what was allowed, and the penalty and points that did it."""
    return {contact.name: _said(contact, _deepest(result, contact)) for contact in model.contacts}


def _deepest(result: History, contact: Contact, first: int = 0) -> float:
    """Largest penetration from a row of the history on."""
    return float(np.max(result[f"{contact.name}_penetration"][first:], initial=0.0)) if len(result) else 0.0


def _said(contact: Contact, deepest: float) -> str:
    allowed = "" if contact.allowed is None else f", {contact.allowed:.3g} allowed"
    rule = "at the nodes" if contact.points == "nodes" else "{} x {} contact points on each facet".format(*contact.rule)
    return f"penetration up to {deepest:.3g}{allowed}; penalty {contact.penalty:.3g}, {rule}"


def warn_of_contact(model: Model, result: History) -> None:
    """Warn once for each contact whose penetration exceeds the allowed one, or a tenth of the thickness."""
    thickness = sheet_thickness(model.mesh)
    for contact in model.contacts:
        found = _excess(contact, _deepest(result, contact))
        found = found or _deep(contact, _deepest(result, contact, first=1), thickness)  # not that of a run before
        message = f"contact {contact.name}: {found}"
        if found and message not in result.warnings:  # a run that was taken up at its end
            result.warn(message)


def _excess(contact: Contact, deepest: float) -> str:
    """Penetration beyond the allowed one, with a remedy; empty without. eq. (4.30)"""
    if contact.allowed is None or deepest <= 1.01 * contact.allowed:
        return ""
    stiffer = (deepest / contact.allowed) ** 1.5
    remedy = f"a penalty of {stiffer * contact.penalty:.3g}, {stiffer:.2g} times the present one"
    if not contact.augmented:
        remedy += ", or augmented=True"
    return f"the penetration of {deepest:.3g} exceeds the {contact.allowed:.3g} allowed; {remedy}"


def _deep(contact: Contact, deepest: float, thickness: float) -> str:
    """Penetration of a tenth of the thickness or more, with a remedy; empty without."""
    share = deepest / thickness
    if not share > _DEEP:
        return ""
    stiffer = share / _SHALLOW * contact.penalty
    text = f"the penetration of {deepest:.3g} is {100.0 * share:.3g} % of the thickness {thickness:.4g}"
    remedy = f"a penalty of {stiffer:.3g} or more, or none: it then follows from the allowed penetration"
    if contact.allowed is not None:
        remedy = f"allow less, such as {_SHALLOW * thickness:.3g}"
    return f"{text}: so much of the stroke is lost, or a force is too large; {remedy}"

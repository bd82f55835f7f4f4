"""Largest penetration of each contact of a run, the allowed one, and the estimated error of the forces."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import NDArray

from umform.model import Model
from umform.model.contact import Contact
from umform.model.contact.encounter import sheet_thickness
from umform.model.contact.settings import ALLOWED
from umform.model.contact.sheets import SheetContact
from umform.results.history import History
from umform.results.quantity import Quantity

#: Penetration relative to the thickness that is reported, and that of a sufficient penalty.
_DEEP, _SHALLOW = 0.1, 0.02
#: Columns of a contact that the error of the forces follows from.
_OF_ERROR = ("penetration_energy", "penalty", "active")
#: Tolerance of the check, relative to the allowed penetration.
_ROUND_OFF = 1e-3


@dataclass(frozen=True)
class Reached:
    """The largest penetration of a contact in a run.

    Attributes
    ----------
    contact : str
        Name of the contact.
    reached : float
        The largest penetration in any state of the run.
    allowed : float, optional
        The allowed one: that of the contact, or the default; infinite if any is; None of a law of one's own, unless it
        is given.
    penalty, initial : float
        Penalty at the end and at the start.
    rule : str
        Where the contact is measured.
    force_error : float
        Estimated error of the tool forces by the penetration of this contact, relative. eq. (4.202) Zero of a contact
        with a law of its own, whose penetration is no error.
    """

    contact: str
    reached: float
    allowed: float | None
    penalty: float
    initial: float
    rule: str
    force_error: float

    @property
    def kept(self) -> bool:
        """Whether every state of the run kept the allowed penetration."""
        return not self.quantity.missed

    @property
    def quantity(self) -> Quantity:
        """The largest penetration with its limit."""
        label = f"penetration of {self.contact}"
        return Quantity(label, value=self.reached, limit=self._limit, slack=_ROUND_OFF, digits=3)

    @property
    def _limit(self) -> float | None:
        return None if self.allowed == math.inf else self.allowed

    def record(self) -> dict[str, object]:
        """All of it as JSON data; no allowed one if any is."""
        return {**asdict(self), "allowed": self._limit, "kept": self.kept}

    @property
    def text(self) -> str:
        """All of it as a line."""
        if self.allowed is None:
            return f"penetration up to {self.reached:.3g} by a contact law of its own, {self.rule}"
        kept = "" if self.kept else f": {self.quantity.verdict}"
        grown = "" if self.penalty == self.initial else f", {self.initial:.3g} at the start"
        force = f"; it changes the forces by about {100.0 * self.force_error:.2g} %"
        allowed = "any" if self._limit is None else f"{self.allowed:.3g}"
        return (
            f"penetration up to {self.reached:.3g}, {allowed} allowed{kept}{force}; "
            f"penalty {self.penalty:.3g}{grown}, {self.rule}"
        )


def penetrations(model: Model, result: History) -> dict[str, Reached]:
    """The largest penetration of each contact by its name."""
    return {contact.name: _reached(model, result, contact) for contact in model.system.penalised}


def stage_penetrations(stages: Mapping[str, History]) -> dict[str, dict[str, Reached]]:
    """The same of each run of a process by its name.

    Contacts that a later run does not touch or only unloads are left out of it.
    """
    found = {stage: penetrations(result.model, result) for stage, result in stages.items()}
    first = next(iter(stages), "")
    return {
        stage: {
            name: reached
            for name, reached in rows.items()
            if stage == first or reached.reached > stages[stage][f"{name}_penetration"][0]
        }
        for stage, rows in found.items()
    }


def contact_record(stages: Mapping[str, History]) -> dict[str, object]:
    """The same as JSON data."""
    return {
        stage: {name: reached.record() for name, reached in rows.items()}
        for stage, rows in stage_penetrations(stages).items()
    }


def force_error(result: History) -> float:
    """Estimated relative error of the tool forces by the penetration of all contacts. eq. (4.202)"""
    return sum(_force_error(result, contact.name) for contact in result.model.system.penalised if contact.law is None)


def _reached(model: Model, result: History, contact: Contact | SheetContact) -> Reached:
    kind = "contact points" if contact.cells is None else "cells"
    rule = "at the nodes" if contact.points == "nodes" else "{} x {} {} on each facet".format(*contact.rule, kind)
    return Reached(
        contact.name,
        _deepest(result, contact),
        _allowed(model, contact),
        contact.penalty,
        contact.initial_penalty,
        rule,
        0.0 if contact.law is not None else _force_error(result, contact.name),
    )


def _allowed(model: Model, contact: Contact | SheetContact) -> float | None:
    if contact.allowed is None and contact.law is None:
        return ALLOWED * sheet_thickness(model.mesh, contact.faces)
    return contact.allowed


def _deepest(result: History, contact: Contact | SheetContact) -> float:
    """Largest penetration of the increments; that of the start is of a run before."""
    return float(np.max(result[f"{contact.name}_penetration"][1:], initial=0.0)) if len(result) else 0.0


def _force_error(result: History, name: str) -> float:
    """Change of the energy of penetration at a fixed penalty over the work in the same increment. eq. (4.202)"""
    if len(result) < 2:
        return 0.0
    energy, penalty, active, work = (
        result[column] for column in (*(f"{name}_{part}" for part in _OF_ERROR), "external_work")
    )
    way = np.abs(np.diff(work)).sum()
    changes: NDArray[np.float64] = energy[1:] - energy[:-1] * penalty[:-1] / penalty[1:]
    return float(np.abs(changes[active[1:] > 0]).sum() / way) if way > 0.0 else 0.0


def warn_of_contact(model: Model, result: History) -> None:
    """Warn once for each contact whose penetration exceeds the allowed one, or a tenth of the thickness."""
    thickness = sheet_thickness(model.mesh)
    for contact in model.system.penalised:
        for found in _findings(contact, _deepest(result, contact), thickness):
            message = f"contact {contact.name}: {found}"
            if message not in result.warnings:  # a run that was taken up at its end
                result.warn(message)


def _findings(contact: Contact | SheetContact, deepest: float, thickness: float) -> Iterator[str]:
    """At most one finding: penetration beyond the allowed one, or a tenth of the thickness or more."""
    if contact.allowed is not None and deepest > (1.0 + _ROUND_OFF) * contact.allowed:
        yield f"the penetration of {deepest:.3g} exceeds the {contact.allowed:.3g} allowed; {_remedy(contact, deepest)}"
    elif deepest > _DEEP * thickness and contact.law is None:
        stiffer = deepest / (_SHALLOW * thickness) * contact.penalty
        yield (
            f"the penetration of {deepest:.3g} is {100.0 * deepest / thickness:.3g} % of the thickness "
            f"{thickness:.4g}: so much of the stroke is lost, or a force is too large; "
            + (
                f"a penalty of {stiffer:.3g} or more, or none: it then follows from the allowed penetration"
                if contact.allowed is None
                else f"allow less, such as {_SHALLOW * thickness:.3g}"
            )
        )


def _remedy(contact: Contact | SheetContact, deepest: float) -> str:
    """What helps against a penetration beyond the allowed one. eq. (4.30)"""
    assert contact.allowed is not None
    if contact.law is not None:
        return "a stiffer contact law, or none: a penalty then grows in the run until the penetration is kept"
    if contact.adapts and contact.penalty >= contact.largest_penalty:
        return (
            f"the penalty {contact.penalty:.3g} is the largest one that follows from the stiffness of the bodies; "
            f"smaller elements at the faces, or allow more, such as {1.1 * deepest:.3g}"
        )
    if contact.adapts:
        return (
            f"the penalty had grown to {contact.penalty:.3g}, and Newton's method did not converge with a larger one; "
            "smaller increments, or more elements on the radii of the tools"
        )
    stiffer = (deepest / contact.allowed) ** 1.5
    remedy = f"a penalty of {stiffer * contact.penalty:.3g}, {stiffer:.2g} times the present one"
    return remedy if contact.augmented else f"{remedy}, or none: it then grows in the run until the penetration is kept"

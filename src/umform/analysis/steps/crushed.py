"""Diagnosis of a failed increment: tools deep in the sheet, which a force in another unit presses there."""

from __future__ import annotations

import numpy as np

from umform.analysis.steps.run_state import Run
from umform.materials.j2 import Plastic
from umform.model.contact import Contact, ContactFound
from umform.model.contact.encounter import sheet_thickness

#: Penetration relative to the thickness above which a force is probably wrong.
_CRUSHED = 0.2


def crushed(run: Run) -> list[str]:
    """Contacts deep in the sheet at the last converged state, with the mean pressure and the yield stress, as text."""
    ranks, words = run.model.system.ranks, []
    for contact in run.model.contacts:
        thickness = sheet_thickness(run.model.mesh, contact.faces)
        found = run.evaluation.found[contact]
        deepest = ranks.max(found.penetration)
        pressure = _mean_pressure(run, contact, found)
        if not deepest > _CRUSHED * thickness:
            continue
        share = 100.0 * deepest / thickness
        words.append(
            f"contact {contact.name} is {deepest:.3g} deep, {share:.3g} % of the thickness {thickness:.4g}, at a mean "
            f"pressure of {pressure:.3g}{_against_yield(run, contact, pressure)}"
        )
    return words


def _mean_pressure(run: Run, contact: Contact, found: ContactFound) -> float:
    """Force over area of the held points."""
    held, ranks = found.held, run.model.system.ranks
    areas = found.area[held.points]
    force = ranks.sum(float(np.reshape(held.pressure, -1) @ areas))
    return force / max(ranks.sum(float(areas.sum())), 1e-300)


def _against_yield(run: Run, contact: Contact, pressure: float) -> str:
    material: object = run.model.bodies.of(contact.faces[:, 0]).material
    if not isinstance(material, Plastic):
        return ""
    first = material.hardening.curve()(0.0)[0]
    return f", {pressure / first:.2g} times the yield stress {first:.4g}"

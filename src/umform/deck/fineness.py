"""Whether increments and contact points are fine enough to follow a sheet that slides over tools.

Rules of thumb: contact may be jumped over by an increment of more than half a thickness; a facet with fewer contact
points than its order asks for lets the force climb in stairs (docs/theory, section 4.5).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from umform.deck.controls import Displacement, Drive, MidLine
from umform.deck.deck import Deck
from umform.deck.findings import Finding, ok, warning
from umform.deck.problem import Problem
from umform.deck.steps import Move
from umform.model.contact.encounter import sheet_thickness

#: Way in an increment, in thicknesses.
_WAY = 0.5
#: Contact points per direction of a facet with 4 and with 9 nodes.
_LEAST = {4: 2, 9: 3}


def look(deck: Deck, problem: Problem) -> Iterator[Finding]:
    """Contact points of all contacts, and the ways of all steps."""
    for name, contact in problem.contacts.items():
        least = _LEAST[contact.facets.shape[1]]
        if isinstance(contact.points, str) or contact.points < least:
            said = "at the nodes only" if isinstance(contact.points, str) else f"{contact.points} x {contact.points}"
            text = f"contact points {said}: the force climbs in stairs where the sheet slides"
            yield warning(f"contact {name}", text, f"points = {least} or more, or auto")
    yield from ways(deck, problem)


def ways(deck: Deck, problem: Problem) -> Iterator[Finding]:
    """How far the controls that are lengths go, in all and in one increment."""
    mesh = problem.model.mesh
    thickness, span = sheet_thickness(mesh), float(np.ptp(mesh.points, axis=0).max())
    stands = dict.fromkeys(deck.contents.controls, 0.0)
    for number, step in enumerate(deck.contents.steps):
        about = f"step {number + 1}"
        if not isinstance(step, Move):  # where it ends is not known
            for name in [step.control] if step.kind == "release" else step.to:
                stands[name] = np.nan
            continue
        for name, to in step.to.items():
            way, stands[name] = abs(to - stands[name]), to
            if not isinstance(deck.contents.controls[name], Displacement | MidLine | Drive) or not np.isfinite(way):
                continue
            part = way / step.increments
            text = f"{name} moves by {way:.4g}, {part:.3g} in an increment"
            if way > span:
                yield warning(about, f"{text}: farther than the sheet is long", "look at the units, and at the target")
            elif problem.contacts and part > _WAY * thickness:
                least = int(np.ceil(way / (_WAY * thickness)))
                yield warning(about, f"{text}: {part / thickness:.3g} thicknesses", f"increments = {least} or more")
            else:
                yield ok(about, text)

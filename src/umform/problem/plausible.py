"""Plausibility checks of any model: mesh, gaps, units, r-values, sheets that tip; they need no deck."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from umform.analysis.run.tipping import tipping
from umform.analysis.steps import Step
from umform.errors import ModelError
from umform.mesh.quality import jacobians
from umform.model import Model
from umform.model.contact import Contact, ContactFound
from umform.model.contact.encounter import sheet_thickness
from umform.problem.findings import Finding, Level, error, ok, warning
from umform.problem.r_values import r_values
from umform.problem.sizes import sheet_length
from umform.problem.units import units
from umform.surfaces.directions import coordinates

#: (name of a contact, shift of its tool) -> the key that does it.
Placing = Callable[[str, NDArray[np.float64]], str]

#: Overlaps relative to the thickness at the start: beyond the first one the sheet gets a jolt; beyond the second one,
#: the tool is misplaced.
_OVERLAP, _DEEP = 0.02, 0.2
#: Smallest ratio of the Jacobians of a cell.
_DISTORTED = 0.2
#: Cosine between the normals of a tool and of a face from which the face looks away.
_AWAY = 0.5


def of_model(
    model: Model, steps: Sequence[Step] = (), *, millimetres: bool = False, place: Placing | None = None
) -> Iterator[Finding]:
    """Mesh, gaps, units and r-values of any model, and whether its steps tip the sheet over.

    Parameters
    ----------
    model : Model
        The model, which is unchanged.
    steps : sequence of Step
        Steps of the run.
    millimetres : bool
        Units are known to be mm, N and MPa.
    place : callable, optional
        Key of the input that shifts the tool of a contact, for the remedy.
    """
    yield mesh(model)
    yield from gaps(model, place)
    yield from units(model, millimetres=millimetres)
    yield from r_values(model)
    yield from tips(model, steps)


def mesh(model: Model) -> Finding:
    """Size of the model, and its most distorted cell."""
    points, cells = model.mesh.points, model.mesh.connectivity
    text = f"{len(cells)} {model.mesh.cell}, {len(points)} nodes, {model.supports.unknown_count} unknowns"
    J = jacobians(points, cells)
    ratios = J.min(axis=1) / J.max(axis=1)
    worst = int(np.argmin(ratios))
    if ratios[worst] >= _DISTORTED:
        return ok("mesh", text)
    text += f"; in cell {worst} the Jacobian falls to {ratios[worst]:.2g} of its largest value"
    return warning("mesh", text, "cells nearer to parallelograms, mid-side nodes nearer to the middle")


def gaps(model: Model, place: Placing | None = None) -> Iterator[Finding]:
    """Gap or overlap of each contact pair at the start."""
    thickness, size = sheet_thickness(model.mesh), sheet_length(model)
    for contact in model.contacts:
        at = contact.locate(model.u, contact.pose)
        gap = at.gap
        about = f"contact {contact.name}"
        if not np.isfinite(gap).all():
            remedy = "move the tool so that it just touches the sheet"
            yield error(about, "a contact point lies on the axis or the centre of the tool", remedy)
            continue
        deepest, inside = float(gap.min()), int((gap <= 0.0).sum())
        if _looks_away(contact, model.positions, at):
            remedy = "the faces of the other side; in a mesh of your own the order of the nodes says which is upper"
            yield warning(about, "its nearest face looks away from the tool, which comes through the sheet", remedy)
        text = (
            f"gap {deepest:.4g}" if deepest > 0 else f"{inside} of {gap.size} points touch, overlap {abs(deepest):.4g}"
        )
        if deepest < -_OVERLAP * thickness and not contact.has_begun:  # a tool that stays has its penetration
            found = error if deepest < -_DEEP * thickness else warning
            remedy = "move the tool out of the sheet; an overlap is pressed out in the first increment"
            if place is not None:
                key = place(contact.name, deepest * at.normal[int(np.argmin(gap))])
                remedy = f"{key}: places of tools do not follow the thickness; {remedy}"
            yield found(about, f"{text}: {-100 * deepest / thickness:.3g} % of the thickness", remedy)
        elif deepest > size:
            remedy = "check the place of the tool and the units"
            yield warning(about, f"{text}: farther away than the sheet is long", remedy)
        else:
            yield ok(about, text)


def _looks_away(contact: Contact, places: NDArray[np.float64], at: ContactFound) -> bool:
    """Whether the outward normal of the face nearest to a tool points away from it."""
    nearest = int(np.argmin(at.gap))
    corners = places[contact.facets[nearest * len(contact.facets) // at.gap.size, :4]]
    normal = np.cross(corners[2] - corners[0], corners[3] - corners[1])
    return bool(normal @ at.normal[nearest] > _AWAY * np.linalg.norm(normal))


def tips(model: Model, steps: Sequence[Step]) -> Iterator[Finding]:
    """A tool that pushes the sheet where nothing balances it. eq. (4.261)"""
    try:
        found = tipping(model, steps)
    except ModelError:  # the check of supports reports the details
        return
    if found is None:
        return
    carriers = " and ".join(f"{name} at {coordinates(x)}" for name, x in found.carriers.items()) or "no tool"
    text = (
        f"in step {found.step} it pushes the sheet at {coordinates(found.place)}; apart from supports only {carriers} "
        "carries it: nothing balances the push, and the sheet tips over"
    )
    remedy = "lay the sheet where tools balance the push, tilted for instance; or a pad, a holder or a support"
    cause = "the sheet lies loosely on one side of the tool"
    yield Finding(Level.ERROR, f"tool {found.tool}", text, remedy, cause)

"""Coarser variants of a deck, one source of error at a time: what its error budget runs."""

from __future__ import annotations

from collections import ChainMap
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from typing import Any

from umform.analysis.steps import Pace
from umform.errors import UmformError
from umform.model.contact import Contact
from umform.model.contact.sheets import SheetContact
from umform.problem.mesh import Disc, Grid, Ring, Strip, Together
from umform.problem.outline import Outlined
from umform.problem.prepared import Prepared
from umform.problem.problem import Problem
from umform.problem.steps import Free, Move, Release

#: Values by the paths of a deck.
Changes = dict[str, Any]
#: Sizes, increments and allowed penetrations of a coarser variant over those of the deck.
TIMES = 2
#: Fewer points through the thickness.
_FEWER = 2
#: Contact points per direction and facet that are not made fewer, but more by one.
_FEW_CONTACTS = 2
#: Tolerances of a coarser variant over those of the deck, and the tolerance of the residual below which they are tight.
_LOOSER, _TIGHT = 10.0, 1e-6
#: Largest angle that an element of a blank with an outline may turn.
_MOST_TURN = 90.0
#: Limits of a pace that are those of one increment.
OF_PACE = ("first", "largest", "turn", "strain", "contact")


def mesh(deck: Problem) -> Changes:
    """A mesh whose elements are twice as long; none if one of its sheets is from a file, or of the operation before."""
    part = deck.contents.mesh
    if deck.before is not None or deck.start is not None:
        return {}
    if not isinstance(part, Together):
        return _twice_as_long(part, "mesh")
    sheets = [_twice_as_long(sheet.mesh, f"mesh.sheets.{name}.mesh") for name, sheet in part.sheets.items()]
    found = dict(ChainMap(*sheets)) if all(sheets) else {}
    return {} if part.bonds and not _fits(deck, found) else found


def _twice_as_long(part: object, path: str) -> Changes:
    """Changes of a generated mesh; none if it cannot be made coarser."""
    if isinstance(part, Outlined):
        turn = {} if part.turn is None else {f"{path}.turn": min(TIMES * part.turn, _MOST_TURN)}
        return {f"{path}.size": TIMES * part.size, **turn}
    if isinstance(part, Grid):
        lines = {name: list(part.of_spec()[name]) for name in ("x", "y")}
        return {f"{path}.{name}": _every_second(of) for name, of in lines.items() if len(of) > TIMES}
    if isinstance(part, Strip | Disc | Ring):
        cells = list(part.of_spec()["cells"])
        halves = [_half(count) for count in cells]
        return {f"{path}.cells": halves} if halves != cells else {}
    return {}


def _fits(deck: Problem, changes: Changes) -> bool:
    """Whether bonded sheets still have nodes at the same places."""
    try:
        deck.with_(changes).sheet()
    except UmformError:
        return False
    return True


def _half(count: int) -> int:
    return -(-count // TIMES)


def _every_second(lines: Sequence[float]) -> list[float]:
    """Every second line, and the last one."""
    return [*lines[:-1:TIMES], lines[-1]]


def increments(deck: Problem, problem: Prepared) -> Changes:
    """Increments twice as large; those of arcs, closing tools and releases without a number stay."""
    found: Changes = {}
    for number, step in enumerate(deck.contents.steps):
        path = f"steps.{number}"
        if isinstance(step, Move) and step.increments is None:
            pace = asdict(step.pace or Pace())
            shares = {name: min(TIMES * pace[name], 1.0) for name in ("first", "largest")}
            found |= {f"{path}.pace.{name}": shares.get(name, TIMES * pace[name]) for name in OF_PACE}
        else:
            count = step.increments if isinstance(step, Move) else None
            if isinstance(step, Free | Release):
                count = step.of_spec()["steps"]
            if count is not None and count > 1:
                found[f"{path}.increments"] = _half(count)
    return found


def thickness_points(deck: Problem, problem: Prepared) -> Changes:
    """Two points through the thickness less, for a law with a history."""
    bodies = [body for body in problem.model.bodies if len(body.material.law().initial())]
    if deck.before is not None or deck.start is not None or not bodies:
        return {}
    given = deck.contents.element.of_spec()["thickness_order"]
    most = max(bodies, key=lambda body: body.thickness_points)
    fewer, least = most.thickness_points - _FEWER, max(2, 0 if given is None else given + 1)
    return {"element.thickness_points": fewer, "element.thickness_rule": most.thickness_rule} if fewer >= least else {}


def contact_points(deck: Problem, problem: Prepared) -> Changes:
    """One contact point, or cell, per direction and facet less; one more where there are two.

    Contacts that keep the friction of the operation before keep their points.
    """
    found: Changes = {}
    before = deck.contents.before
    for group, contacts in _contacts(problem).items():
        for name, contact in contacts.items():
            kind = "points" if contact.cells is None else "cells"
            count = getattr(contact, kind)
            if not isinstance(count, str) and (before is None or name not in before.keep):
                found[f"{group}.{name}.{kind}"] = count - 1 if count > _FEW_CONTACTS else count + 1
    return found


def penalty(deck: Problem, problem: Prepared) -> Changes:
    """Half of each penalty, or twice the allowed penetration from which it follows; of sheets that with which they end.

    Multipliers follow the allowed penetration, too.
    """
    found: Changes = {}
    for name, part in deck.contents.contacts.items():
        given = part.of_spec()
        if given["penalty"] is not None:
            found[f"contacts.{name}.penalty"] = given["penalty"] / TIMES
        depth = given["penetration"]
        if given["penalty"] is None and depth is None:
            depth = problem.contacts[name].allowed
        if depth is not None and (given["penalty"] is None or given["penetration"] is not None):
            found[f"contacts.{name}.penetration"] = TIMES * depth
    for contact in problem.model.system.sheet_contacts:
        path = f"sheet_contacts.{contact.name}"
        found[f"{path}.penalty"] = contact.penalty / TIMES
        found |= {f"{path}.penetration": TIMES * contact.allowed} if contact.augmented else {}
    return found


def _contacts(problem: Prepared) -> dict[str, Mapping[str, Contact | SheetContact]]:
    """Contacts by their names, and by the names of their tables."""
    sheets = {contact.name: contact for contact in problem.model.system.sheet_contacts}
    return {"contacts": problem.contacts, "sheet_contacts": sheets}


def tolerance(deck: Problem, problem: Prepared) -> Changes:
    """Looser tolerances; none where they are tight."""
    if problem.options.residual < _TIGHT:
        return {}
    return {f"solution.{name}": _LOOSER * getattr(problem.options, name) for name in ("residual", "increment")}


#: Names of the variants, beginning with that of the mesh; the changes by the others hardly depend on it.
MESH = "mesh*2"
_OTHERS: dict[str, Callable[[Problem, Prepared], Changes]] = {
    "step*2": increments,
    "t-pts-2": thickness_points,
    "c-pts-1": contact_points,
    "depth*2": penalty,
    "tol*10": tolerance,
}
#: Names of all variants.
VARIANTS = (MESH, *_OTHERS)


def coarser(deck: Problem, problem: Prepared) -> dict[str, Changes]:
    """Changes of a deck by the names of its coarser variants; what it has not is left out.

    All but the mesh are varied on the coarser mesh, where there is one.

    Parameters
    ----------
    deck : Problem
        The deck.
    problem : Prepared
        What it builds.
    """
    found = {name: change(deck, problem) for name, change in _OTHERS.items()}
    coarse = mesh(deck)
    return ({MESH: coarse} if coarse else {}) | {name: coarse | change for name, change in found.items() if change}

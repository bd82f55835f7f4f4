"""Coarser variants of a deck, one source of error at a time: what its error budget runs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict
from typing import Any

from umform.analysis.steps import Pace
from umform.problem.mesh import Disc, Grid, Ring, Strip
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
    """A mesh whose elements are twice as long; none for a mesh of a file, or of the operation before."""
    part = deck.contents.mesh
    if deck.before is not None or deck.start is not None:
        return {}
    if isinstance(part, Outlined):
        turn = {} if part.turn is None else {"mesh.turn": min(TIMES * part.turn, _MOST_TURN)}
        return {"mesh.size": TIMES * part.size, **turn}
    if isinstance(part, Grid):
        lines = {name: list(part.of_spec()[name]) for name in ("x", "y")}
        return {f"mesh.{name}": _every_second(of) for name, of in lines.items() if len(of) > TIMES}
    if isinstance(part, Strip | Disc | Ring):
        cells = list(part.of_spec()["cells"])
        halves = [_half(count) for count in cells]
        return {"mesh.cells": halves} if halves != cells else {}
    return {}


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
    body, given = problem.model.bodies.only, deck.contents.element.of_spec()["thickness_order"]
    fewer, least = body.thickness_points - _FEWER, max(2, 0 if given is None else given + 1)
    if deck.before is not None or deck.start is not None or not len(body.material.law().initial()) or fewer < least:
        return {}
    return {"element.thickness_points": fewer, "element.thickness_rule": body.thickness_rule}


def contact_points(deck: Problem, problem: Prepared) -> Changes:
    """One contact point, or cell, per direction and facet less; one more where there are two."""
    found: Changes = {}
    for name, contact in problem.contacts.items():
        kind = "points" if contact.cells is None else "cells"
        count = getattr(contact, kind)
        if not isinstance(count, str):
            found[f"contacts.{name}.{kind}"] = count - 1 if count > _FEW_CONTACTS else count + 1
    return found


def penalty(deck: Problem, problem: Prepared) -> Changes:
    """Half of each penalty, or twice the allowed penetration from which it follows."""
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
    for name, sheets in deck.contents.sheet_contacts.items():
        given = sheets.of_spec()
        found |= {f"sheet_contacts.{name}.penalty": given["penalty"] / TIMES} if given["penalty"] is not None else {}
    return found


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

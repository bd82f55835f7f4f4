"""The deck of a case of free bending."""

from __future__ import annotations

from collections.abc import Iterator

from umform.problem.keys import law_keys
from umform.problem.written import Entry, deck_text
from umform.processes.bending.case import law_of
from umform.processes.bending.spec import RECONSTRUCTION, FreeBending


def deck_of(case: FreeBending) -> str:
    """Deck of a case of free bending; what it builds gives the same numbers as `free_bending`, to the last bit."""
    about = f"Free bending of a strip over a cylinder, {case.name}. Units: mm, N, MPa."
    return deck_text("Free bending of a strip over a cylinder", [about, RECONSTRUCTION], _entries(case))


def _entries(case: FreeBending) -> Iterator[Entry]:
    size = {"length": case.length, "width": case.width, "thickness": case.thickness}
    yield "[mesh]", {"generator": "strip", **size, "cells": case.mesh}
    yield (
        "[element]",
        {
            "name": case.element,
            "thickness_order": case.thickness_order,
            "tie_E33": case.tie_E33,
            "thickness_points": case.thickness_points,
            "thickness_rule": case.thickness_rule,
        },
    )
    yield "[material]", law_keys(law_of(case))
    yield "[tools.cylinder]", {"shape": "Cylinder", "centre": case.centre, "axis": "y", "radius": case.radius}
    touch = {"tool": "cylinder", "faces": "lower", "penalty": case.penalty, "points": case.contact}
    yield "[contacts.cylinder]", touch
    yield "[[supports]]", {"kind": "symmetry", "nodes": "x0", "normal": "x"}
    corner = {"intersection": ["x0_lower", "y0_lower"]}
    yield "[[supports]]", {"kind": "fix", "nodes": corner, "directions": "y"}
    yield "[controls.punch]", {"kind": "displacement", "nodes": "x0_lower", "direction": "z"}
    yield "[[steps]]", {"kind": "move", "to": {"punch": -case.stroke}, "increments": case.steps}
    if case.unload:
        yield "[[steps]]", {"kind": "release", "control": "punch"}
    yield "[solution]", {"solver": case.solver, "line_search": case.line_search}

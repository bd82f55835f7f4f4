"""What all jobs of forming share: laws, thicknesses, units, friction, contact, increments, and what is judged."""

from __future__ import annotations

import math
from typing import Any

import umform as uf
from balances import LIMITS, measured
from corpus.answers import Answer
from corpus.sections import Sheet
from imbalance import COARSE, DEEP, DRIFTS, ENERGIES, FORCES, MISSED, MISSED_FORCES
from jobs.drawing import Drawing
from jobs.lot import Done
from umform import sheet_metals

THICKNESSES = (0.1, 0.2, 0.3, 0.5, 0.7, 0.8, 1.0, 1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 6.0, 8.0, 12.0)
FRICTIONS = (None, 0.02, 0.05, 0.1, 0.1, 0.15, 0.2)
#: Units in a millimetre and in a megapascal.
UNITS = {"mm": (1.0, 1.0), "inch": (1.0 / 25.4, 145.038), "m": (1e-3, 1e6)}
#: Laws that are known in any unit.
_PLAIN = ("linear", "swift", "swift", "voce", "voce", "chaboche", "hill", "perfect", "rate")
#: What of an answer is judged beside forces, moments and energies, and the largest deviation: those of the corpus of
#: balances, but for the meshes here, which are coarser.
_JUDGED = {
    **{name: LIMITS[name].most for name in ("volume of the law", "penetration", "tools", "work of tools")},
    "volume of the mesh": 0.03,
    "symmetry": 5e-3,
}
#: Largest resultant of all forces over the tolerance of the residual.
_OF_RESIDUAL = 10.0


def draw_law(drawing: Drawing) -> dict[str, Any]:
    """A law and the units: a sheet metal in mm, or a law without a name in any unit."""
    if drawing.chance(0.5):
        return {"law": drawing.one_of(sheet_metals.names()), "units": "mm"}
    return {"law": drawing.one_of(_PLAIN), "units": drawing.one_of(("mm", "mm", "mm", "inch", "inch", "m"))}


def draw_rule(drawing: Drawing, nodes: int = 8) -> dict[str, Any]:
    """Points, cells, allowed penetration in thicknesses, multipliers: mostly what umform chooses."""
    if nodes == 8 and drawing.chance(0.1):
        return {"cells": 3}
    rule: dict[str, Any] = {"points": drawing.one_of((2, 2, 3, 4, "auto") if nodes == 8 else (3, 4, "auto"))}
    if drawing.chance(0.2):
        rule["penetration"] = 1.0 / drawing.one_of((50, 100, 500))
    return rule | ({"augmented": True} if drawing.chance(0.1) else {})


def draw_increments(drawing: Drawing) -> dict[str, Any]:
    """A part of the pace that umform chooses, or a number of increments."""
    if drawing.chance(0.8):
        return {"pace": drawing.one_of((1.0, 2.0))}
    return {"steps": drawing.one_of((20, 30, 50))}


def draw_sheet(drawing: Drawing, *, elements: tuple[str, ...] = ("BEND8", "BEND8", "BEND18")) -> dict[str, Any]:
    """A strip in plane strain; lengths of tools are in thicknesses, or the sheet is slender."""
    element = drawing.one_of(elements)
    return {
        **draw_law(drawing),
        **draw_increments(drawing),
        "thickness": drawing.one_of(THICKNESSES),
        "element": element,
        "friction": drawing.one_of(FRICTIONS),
        "rule": draw_rule(drawing, 18 if element == "BEND18" else 8),
        "mirrored": drawing.chance(0.3),
    }


def increments(keys: dict[str, Any]) -> int | uf.Pace:
    """Number of increments or their pace."""
    if "steps" in keys:
        return int(keys["steps"])
    part, usual = keys["pace"], uf.Pace()
    return uf.Pace(
        first=part * usual.first,
        largest=min(1.0, part * usual.largest),
        turn=part * usual.turn,
        strain=part * usual.strain,
        contact=part * usual.contact,
    )


def sheet_of(keys: dict[str, Any], *, slender: float = 1.0, layers: int = 1, size: float = 1.0) -> Sheet:
    """The strip: ``slender`` is its thickness in the lengths of the tools, ``size`` the length of an element there."""
    length, stress = UNITS[keys["units"]]
    rule = dict(keys["rule"])
    if "penetration" in rule:
        rule["penetration"] *= slender
    return Sheet(
        law=keys["law"],
        element=keys["element"],
        thickness=slender,
        size=size,
        friction=keys["friction"],
        rule=rule,
        layers=layers,
        steps=increments(keys),
        mirrored=keys["mirrored"],
        length=length * keys["thickness"] / slender,
        stress=stress,
    )


def judged(answer: Answer, residual: float = 0.0) -> Done:
    """The runs of an answer, and what of it is judged; ``residual`` is a tolerance of Newton's method above the usual.

    Penetrations, drifts and volumes of which the run warns are not judged: the numbers are marked. A residual of which
    it warns may leave the resultants of the drawing processes.
    """
    warnings = " ".join(warning for result in answer.results for warning in result.warnings)
    found, forces = measured(answer), max(FORCES, _OF_RESIDUAL * residual, MISSED_FORCES if MISSED in warnings else 0.0)
    most = _JUDGED | {"tools": max(_JUDGED["tools"], forces)}
    for mark, name in ((DEEP, "penetration"), (COARSE, "volume of the mesh")):
        if mark in warnings:
            del most[name]
    deviations = {name: (found[name], limit) for name, limit in most.items() if name in found}
    return Done(answer.results, deviations, forces, math.inf if DRIFTS in warnings else ENERGIES)

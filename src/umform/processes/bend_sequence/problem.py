"""The problem of one bend of a part: what a deck of it holds."""

from __future__ import annotations

import math

import numpy as np

from umform import mesh
from umform.analysis.run import Result
from umform.elements import element
from umform.mesh import Mesh
from umform.model.transfer.rigid_motion import RigidMotion
from umform.problem.previous_operation import Placement
from umform.problem.problem import Problem
from umform.processes.air_bending.problem import problem_of as single_bend
from umform.processes.air_bending.problem import touching
from umform.processes.bend_sequence.spec import Bend, BendSequence
from umform.processes.bend_sequence.strip import strip_lines


def problem_of_bend(
    sequence: BendSequence, bend: Bend, stroke: float, flat: Mesh, lying: RigidMotion, before: Result | None
) -> Problem:
    """The whole strip in the tools of a bend: down by a stroke, and back to zero force.

    Parameters
    ----------
    sequence, bend
        The part, and its bend.
    stroke : float
        Stroke of the punch.
    flat : Mesh
        Mesh of the flat strip.
    lying : RigidMotion
        Motion of the part into the tools.
    before : Result, optional
        Run of the bend before; None for the flat strip.
    """
    case = sequence.case(bend)
    single = single_bend(case, stroke)
    tables = dict(single.source.data)
    tables["title"] = f"Bend at {bend.position:g} of a part"
    tables["mesh"] = {"generator": "grid", **strip_mesh(sequence)}
    tables["placement"] = Placement.table(lying)
    faces = dict(zip(("die", "punch"), ("upper", "lower") if bend.over else ("lower", "upper"), strict=True))
    # Those of a single bend with undeformed sheet: an estimate needs a sheet that lies as its mesh.
    known = {name: {"penalty": how.penalty, "points": how.points} for name, how in touching(case).items()}
    rubs = {"friction": case.friction} if case.friction else {}
    tables["contacts"] = {
        name: {"tool": name, "faces": {"ids": _near(sequence, bend, flat, side)}, **known[name], **rubs}
        for name, side in faces.items()
    }
    tables["supports"] = [
        {"kind": "fix", "nodes": {"min": [-math.inf] * 3}, "directions": "y"},
        {"kind": "fix", "name": "stop", "nodes": {"ids": _under_the_tip(sequence, bend, flat)}, "directions": "x"},
    ]
    if before is not None:  # a bent strip is not flat enough to touch both shoulders at first
        tables["solution"] = {**tables["solution"], "rest": "on"}
    tables["output"] = {"state": True}
    about = f"One bend of a part, {stroke:.6g} mm down, and back to zero force; in plane strain. Units: mm, N, MPa."
    return Problem.of(tables, [about], before)


def flat_strip(sequence: BendSequence) -> Mesh:
    """Mesh of the flat strip."""
    lines = strip_mesh(sequence)
    return mesh.grid(lines["x"], lines["y"], lines["z"], element(sequence.sheet.element).cell)


def strip_mesh(sequence: BendSequence) -> dict[str, list[float]]:
    """Element borders of the whole strip: x from its left end, one element wide, z from 0 to the thickness."""
    sheet = sequence.sheet
    through = mesh.graded(sheet.thickness, sheet.layers)
    return {"x": strip_lines(sequence).tolist(), "y": [0.0, sheet.thickness], "z": through.tolist()}


def _near(sequence: BendSequence, bend: Bend, flat: Mesh, side: str) -> list[list[int]]:
    """Faces of the strip about the bend line."""
    rows = flat.face_set(side)
    centres = flat.points[flat.facets_of(rows)].mean(axis=1)
    near: list[list[int]] = rows[np.abs(centres[:, 0] - bend.position) <= sequence.zone(bend)].tolist()
    return near


def _under_the_tip(sequence: BendSequence, bend: Bend, flat: Mesh) -> list[int]:
    """Nodes of the bend line on the face that the punch touches: friction on its tip holds the strip."""
    height = 0.0 if bend.over else sequence.sheet.thickness
    close = 1e-6 * sequence.sheet.thickness
    x = flat.points
    found: list[int] = np.flatnonzero(
        (np.abs(x[:, 0] - bend.position) < close) & (np.abs(x[:, 2] - height) < close)
    ).tolist()
    return found

"""The problem of a case of free bending: what a deck of it holds."""

from __future__ import annotations

from umform.materials import J2, Linear, Perfect
from umform.problem.material_keys import law_keys
from umform.problem.problem import Problem
from umform.processes.bending.spec import RECONSTRUCTION, FreeBending


def problem_of(case: FreeBending) -> Problem:
    """Half of the strip over the cylinder: pushed down, and released; the history is that of `free_bending`."""
    release = [{"kind": "release", "control": "punch"}] if case.unload else []
    tables = {
        "title": "Free bending of a strip over a cylinder",
        "mesh": {
            "generator": "strip",
            "length": case.length,
            "width": case.width,
            "thickness": case.thickness,
            "cells": case.mesh,
        },
        "element": {
            "name": case.element,
            "thickness_order": case.thickness_order,
            "tie_E33": case.tie_E33,
            "thickness_points": case.thickness_points,
            "thickness_rule": case.thickness_rule,
        },
        "material": law_keys(law_of(case)),
        "tools": {"cylinder": {"shape": "Cylinder", "centre": case.centre, "axis": "y", "radius": case.radius}},
        "contacts": {
            "cylinder": {"tool": "cylinder", "faces": "lower", "penalty": case.penalty, "points": case.contact}
        },
        "supports": [
            {"kind": "symmetry", "nodes": "x0", "normal": "x"},
            {"kind": "fix", "nodes": {"intersection": ["x0_lower", "y0_lower"]}, "directions": "y"},
        ],
        "controls": {"punch": {"kind": "displacement", "nodes": "x0_lower", "direction": "z"}},
        "steps": [{"kind": "move", "to": {"punch": -case.stroke}, "increments": case.steps}, *release],
        "solution": {"solver": case.solver, "line_search": case.line_search},
    }
    about = f"Free bending of a strip over a cylinder, {case.name}. Units: mm, N, MPa."
    return Problem.of(tables, [about, RECONSTRUCTION])


def law_of(case: FreeBending) -> J2:
    """Law of the strip."""
    curve = Linear(case.yield_stress, case.hardening) if case.hardening else Perfect(case.yield_stress)
    return J2(kappa=case.kappa, mu=case.mu, hardening=curve)

"""The problem of a draw bead: what a deck of it holds."""

from __future__ import annotations

import math
from dataclasses import asdict

from umform.problem.keys import law_keys
from umform.problem.problem import Problem
from umform.problem.profiles import profile_table
from umform.processes.draw_bead.spec import DrawBead
from umform.processes.solution import solution_keys


def problem_of(case: DrawBead) -> Problem:
    """A strip between bead and groove: the upper tool closes while the right end is held, then this end is drawn.

    The sheet flows in from the left, where its end is free.
    """
    left, right = case.ends
    rule = {
        "points": case.contact_points,
        "friction": case.friction,
        "penalty": case.penalty,
        "allowed": case.allowed,
    }
    rolling = None if case.rolling is None else {"angle": float(case.rolling)}
    tables = {
        "title": "A draw bead",
        "mesh": {
            "generator": "strip",
            "length": right - left,
            "width": 1.0,
            "thickness": case.thickness,
            "cells": (round((right - left) / case.size), 1),
            "shift": (left, 0.0, 0.5 * case.thickness),
        },
        "element": {"name": case.element, "plane_strain": case.plane_strain},
        "material": law_keys(case.material, rolling),
        "tools": {
            "lower_tool": {
                "shape": "UDie",
                "opening": case.width,
                "depth": case.height + 5.0 * case.thickness,
                "shoulder_radius": case.groove_radius,
                "shared": True,
            },
            "upper_tool": {
                "shape": "Extruded",
                "profile": profile_table(case.profile),
                "origin": (0.0, 0.0, case.thickness + case.height),
                "shared": True,
            },
        },
        "contacts": {
            "below": {"tool": "lower_tool", "faces": "lower", **rule},
            "above": {"tool": "upper_tool", "faces": "upper", **rule},
        },
        "supports": [{"kind": "fix", "nodes": {"min": [-math.inf] * 3}, "directions": "y"}],
        "controls": {
            "way": {"kind": "displacement", "nodes": "x1", "direction": "x"},
            "closing": {"kind": "tool", "contact": "above", "direction": "-z"},
        },
        "solution": solution_keys(case.newton),
        "steps": [
            {"kind": "move", "to": {name: end}, "pace": asdict(case.pace)}
            for name, end in (("closing", case.closing), ("way", case.way))
        ],
    }
    return Problem.of(tables, ["A strip of 1 mm width, drawn through a bead. Units: mm, N, MPa."])

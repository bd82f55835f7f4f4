"""The deck of a ready process: what its parameters mean, written out."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping
from typing import Any

from umform.processes.bending.parameters import RECONSTRUCTION, FreeBending


def deck_of(case: FreeBending) -> str:
    """Deck of a case of free bending.

    Parameters
    ----------
    case : FreeBending
        The case.

    Returns
    -------
    str
        TOML; what it builds gives the same numbers as :func:`umform.processes.free_bending`.
    """
    lines = [
        f"# Free bending of a strip over a cylinder, {case.name}. Units: mm, N, MPa.",
        *textwrap.wrap(RECONSTRUCTION, 118, initial_indent="# ", subsequent_indent="# "),
        "",
        'title = "Free bending of a strip over a cylinder"',
    ]
    for header, values in _tables(case):
        lines += ["", header, *(f"{key} = {_toml(value)}" for key, value in values.items())]
    return "\n".join(lines) + "\n"


def _tables(case: FreeBending) -> Iterator[tuple[str, Mapping[str, Any]]]:
    hardening = (
        {"curve": "Linear", "yield_stress": case.yield_stress, "modulus": case.hardening}
        if case.hardening
        else {"curve": "Perfect", "yield_stress": case.yield_stress}
    )
    yield (
        "[mesh]",
        {
            "generator": "strip",
            "length": case.length,
            "width": case.width,
            "thickness": case.thickness,
            "cells": case.mesh,
        },
    )
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
    yield "[material]", {"law": "J2", "kappa": case.kappa, "mu": case.mu, "hardening": hardening}
    yield "[tools.cylinder]", {"shape": "Cylinder", "centre": case.centre, "axis": "y", "radius": case.radius}
    yield (
        "[contacts.cylinder]",
        {
            "tool": "cylinder",
            "faces": "lower",
            "penalty": case.penalty,
            "points": case.contact,
        },
    )
    yield "[[supports]]", {"kind": "symmetry", "nodes": "x0", "normal": "x"}
    corner = {"intersection": ["x0_lower", "y0_lower"]}
    yield "[[supports]]", {"kind": "fix", "nodes": corner, "directions": "y"}
    yield "[controls.punch]", {"kind": "displacement", "nodes": "x0_lower", "direction": "z"}
    yield "[[steps]]", {"kind": "move", "to": {"punch": -case.stroke}, "increments": case.steps}
    if case.unload:
        yield "[[steps]]", {"kind": "release", "control": "punch"}
    yield "[solution]", {"solver": case.solver, "line_search": case.line_search}


def _toml(value: Any) -> str:
    """A value as TOML has it."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {_toml(entry)}" for key, entry in value.items()) + " }"
    if isinstance(value, tuple | list):
        return "[" + ", ".join(_toml(entry) for entry in value) + "]"
    return repr(value)

"""Names that a model had before its parts had their own; version 0.3 removes them."""

from __future__ import annotations

import warnings
from typing import Any

_PARTS = {
    "bodies.only": "block body element material thickness_points thickness_rule",
    "controls": "add_load free_name of_kind",
    "loads": "body_force",
    "supports": "all_supports constrained groups hold_again holders pairs rows ties unknown_count wait",
    "tools": "press_of",
    "system.whole": "described elsewhere node_number owned sum_at_nodes",
    "system": "begin check coefficients commit elastic extend extent follow free largest_entry mechanism now "
    "others pairs_of_tools pattern prepare ranks recover repeat restore restrict resultants revert shorten smooth "
    "snapshot stand state_at terms thickness time timing too_deep unknowns with_term x",
}
_RENAMED = {
    "body": "bodies.only",
    "add_load": "controls.add",
    "all_supports": "supports.all",
    "displacement_of_supports": "supports.displacement",
    "prescribed_displacement": "supports.prescribed",
}

#: The new name of each old one.
MOVED = {name: f"{part}.{name}" for part, names in _PARTS.items() for name in names.split()} | _RENAMED


def moved(model: Any, name: str) -> tuple[Any, str]:
    """The object that now has an attribute of a model, and its name there; with a warning.

    Raises
    ------
    AttributeError
        If a model never had the attribute.
    """
    if name not in MOVED:
        raise AttributeError(f"{type(model).__name__!r} object has no attribute {name!r}")
    text = f"model.{name} is now called model.{MOVED[name]}; version 0.3 removes the old name"
    warnings.warn(text, DeprecationWarning, stacklevel=3)
    *parts, last = MOVED[name].split(".")
    for part in parts:
        model = getattr(model, part)
    return model, last

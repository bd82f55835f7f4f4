"""Detect tools that were moved or pressed but never touched the sheet."""

from __future__ import annotations

import numpy as np

from umform.model import Model
from umform.results.history import History


def warn_of_untouched(model: Model, result: History) -> None:
    """Warn of each tool that steps have moved or pressed and that no point of the sheet has touched."""
    if len(result) < 2:
        return
    for tool in model.tools:
        if not tool.pairs or any(result[f"{pair.name}_active"].any() for pair in tool.pairs):
            continue
        ways = [control for control in model.controls if tool in getattr(control, "tools", ())]
        moved = [control.name for control in ways if np.ptp(result[control.name]) > 0.0]
        if not moved:
            continue
        names = " and ".join(f"contact {pair.name}" for pair in tool.pairs)
        message = (
            f"{names} never touched the sheet, although {' and '.join(moved)} moved the tool {tool.name}: it "
            "moves away from the sheet, or the stroke is too short; another sign or direction, or a longer stroke"
        )
        if message not in result.warnings:
            result.warn(message)

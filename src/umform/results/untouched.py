"""Detect tools that never touched the sheet: a warning of those that moved or were pressed, a note of fixed ones."""

from __future__ import annotations

import numpy as np

from umform.model import Model
from umform.results.history import History


def warn_of_untouched(model: Model, result: History) -> None:
    """Name each tool that no point of the sheet has touched; a fixed one may be a stop, and is no reason to warn."""
    if len(result) < 2:
        return
    for tool in model.tools:
        if not tool.pairs or any(result[f"{pair.name}_active"].any() for pair in tool.pairs):
            continue
        ways = [control for control in model.controls if tool in getattr(control, "tools", ())]
        moved = [control.name for control in ways if np.ptp(result[control.name]) > 0.0]
        names = " and ".join(f"contact {pair.name}" for pair in tool.pairs)
        stopped = any(stop.reached(press.way.value) for press in tool.presses for stop in press.stops)
        if stopped or not moved:
            rests = "on its stops" if stopped else "at rest" if ways else "fixed"
            note = (
                f"{names} never touched the sheet: the tool {tool.name} is {rests}, and no part of the sheet reached it"
            )
            if tool.motion is None and note not in result.events:
                result.note(note)
            continue
        message = (
            f"{names} never touched the sheet, although {' and '.join(moved)} moved the tool {tool.name}: it "
            "moves away from the sheet, or the stroke is too short; another sign or direction, or a longer stroke"
        )
        if message not in result.warnings:
            result.warn(message)

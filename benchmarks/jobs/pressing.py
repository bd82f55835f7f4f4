"""A tool that goes down in some increments, and is taken back."""

from __future__ import annotations

from typing import Any

import umform as uf
from jobs.drawing import Drawing
from umform.model.terms.control import Control


def increments(drawing: Drawing, stroke: float, thickness: float) -> int:
    """How many increments somebody takes: by the thickness of the sheet, or just a round number."""
    if drawing.chance(0.3):
        return drawing.one_of((5, 10, 10, 20, 40))
    return min(400, max(10, round(stroke / (thickness * drawing.ratio(0.03, 0.5)))))


def pressed(
    model: uf.Model, punch: Control, keys: dict[str, Any], sign: int = 1
) -> tuple[list[uf.Result], dict[str, tuple[float, float]]]:
    """Take a tool down in increments, and back until its force is zero."""
    steps: list[uf.Move | uf.Release] = [uf.Move(punch, to=sign * keys["stroke"], steps=keys["steps"])]
    if keys["unload"]:
        steps.append(uf.Release(punch))
    options = uf.NewtonOptions(line_search=keys["line_search"])
    return [uf.solve(model, steps, options=options, frames=0, progress=False)], {}

"""A tool that goes down and is taken back."""

from __future__ import annotations

from typing import Any

import umform as uf
from umform.model.control import Control


def pressed(
    model: uf.Model, punch: Control, keys: dict[str, Any]
) -> tuple[list[uf.Result], dict[str, tuple[float, float]]]:
    """Take a tool down in increments, and back until its force is zero."""
    steps: list[uf.Move | uf.Release] = [
        uf.Move(punch, to=keys["stroke"], steps=max(1, round(keys["stroke"] / keys["increment"])))
    ]
    if keys["unload"]:
        steps.append(uf.Release(punch))
    options = uf.NewtonOptions(line_search=keys["line_search"])
    return [uf.solve(model, steps, options=options, frames=0, progress=False)], {}

"""Detect bottoming: the force of a tool jumps because the sheet is squeezed between tools."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.model import Model
from umform.model.tool_controls import ToolMotion
from umform.results.history import History

Floats = NDArray[np.float64]

#: Growth of the force within a part of the travel, after contact over another part of it and in some rows.
_GROWTH, _WITHIN, _AFTER, _ROWS = 4.0, 0.05, 0.1, 4


@dataclass(frozen=True)
class Bottoming:
    """Where a tool bottoms.

    Attributes
    ----------
    at : float
        Value of its control.
    before, largest : float
        Largest force up to that value, and up to the end of the step.
    """

    at: float
    before: float
    largest: float


def bottoming(way: Floats, force: Floats) -> Bottoming | None:
    """Where the force of a tool jumps along its travel; None if it does not.

    The tool bottoms where the force exceeds four times its previous maximum within a twentieth of the travel and stays
    there to the end. First contact does not count: the tool must have touched over a tenth of the travel and in four
    rows. A tool that stands still or moves back does not bottom: other tools change its force.

    Parameters
    ----------
    way, force : ndarray, shape (n,)
        Control value and force in the rows of a step.
    """
    run, size = np.abs(way - way[:1]), np.abs(force)
    touching = np.flatnonzero(size > 1e-6 * size.max(initial=0.0))
    goes = len(run) > 0 and run[-1] > 0.0 and bool((np.diff(run) >= 0.0).all())
    if not goes or len(touching) <= _ROWS:
        return None
    so_far = np.maximum.accumulate(size)
    first = touching[0]
    for k in range(first + _ROWS - 1, len(run) - 1):
        near = max(int(np.searchsorted(run, run[k] + _WITHIN * run[-1], side="right")) - 1, k + 1)
        enough = run[k] - run[first] >= _AFTER * run[-1]
        if enough and so_far[near] > _GROWTH * so_far[k] and size[-1] > _GROWTH * so_far[k]:
            return Bottoming(float(way[k]), float(so_far[k]), float(so_far[-1]))
    return None


def warn_of_bottoming(model: Model, result: History) -> None:
    """Report for each moving tool whether it has bottomed."""
    steps = result["step"] if len(result) else np.empty(0)
    for control in model.controls:
        if not isinstance(control, ToolMotion):
            continue
        for step in np.unique(steps):
            rows = np.flatnonzero(steps == step)
            rows = rows if rows[0] == 0 else np.concatenate([[rows[0] - 1], rows])
            found = bottoming(result[control.name][rows], result[f"{control.name}_force"][rows])
            if found is None:
                continue
            text = (
                f"the tool {control.tool.name} bottoms at {control.name} = {found.at:.4g}: its force rises from "
                f"{found.before:.4g} to {found.largest:.4g}; a shorter stroke, or more clearance between the tools"
            )
            if text not in result.warnings:
                result.warn(text)

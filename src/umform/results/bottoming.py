"""Detect bottoming: the force of a tool jumps because the sheet is squeezed between tools."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.model import Model
from umform.model.contact.encounter import sheet_thickness
from umform.model.tools.tool_controls import ToolMotion
from umform.results.history import History

Floats = NDArray[np.float64]

#: Growth of the force within a part of the travel, after contact over another part of it and in some rows.
_GROWTH, _WITHIN, _AFTER, _ROWS = 4.0, 0.05, 0.1, 4
#: Part of the force of a tool that other tools answer across the sheet where it bottoms, and how far across and beside
#: it the points which they hold may lie, in thicknesses.
_SQUEEZED, _ACROSS, _BESIDE = 0.5, (0.3, 1.5), 0.5


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


def squeezed(model: Model, tool: Any, found: Mapping[Any, Any]) -> float:
    """Part of the force of a tool at places where another tool holds the sheet on its other side.

    It tells a tool that bottoms from one that touches the sheet a second time, where the force jumps as well.

    Parameters
    ----------
    model : Model
        The model.
    tool : Tool
        One of its tools.
    found : mapping of Contact to ContactFound
        What was found at a converged state.
    """
    from scipy.spatial import cKDTree  # slow to import

    mine = [found[pair] for pair in model.contacts if pair in tool.pairs]
    others = [found[pair].held.x for pair in model.contacts if pair not in tool.pairs]
    x, normal, force = (np.concatenate(parts) for parts in zip(*(_held(one) for one in mine), strict=True))
    opposite, answered = np.concatenate([np.empty((0, 3)), *(x for x in others if len(x))]), 0.0
    if len(x) and len(opposite):
        thickness = sheet_thickness(model.mesh)
        beside = max(thickness, *(float(np.sqrt(one.area.max())) for one in mine))
        tree = cKDTree(opposite)
        far, near = tree.query(x + thickness * normal, distance_upper_bound=_BESIDE * (thickness + beside))
        there = np.flatnonzero(np.isfinite(far))
        across = np.einsum("ni,ni->n", opposite[near[there]] - x[there], normal[there]) / thickness
        answered = float(force[there[(across > _ACROSS[0]) & (across < _ACROSS[1])]].sum())
    return float(model.system.ranks.sum(answered) / max(model.system.ranks.sum(float(force.sum())), 1e-300))


def bottoms(model: Model, tool: Any, found: Mapping[Any, Any]) -> bool:
    """Whether other tools answer most of the force of a tool across the sheet, see :func:`squeezed`."""
    return squeezed(model, tool, found) >= _SQUEEZED


def _held(found: Any) -> tuple[Floats, Floats, Floats]:
    """Positions, normals and forces of the points that a tool holds."""
    held = found.held
    force = np.asarray(held.pressure) * found.area[held.points]
    return np.reshape(held.x, (-1, 3)), np.reshape(held.normal, (-1, 3)), np.reshape(force, -1)


def warn_of_bottoming(model: Model, result: History, step: int, found: Mapping[Any, Any]) -> None:
    """Say for each tool that a step has moved whether it has bottomed; found is what holds at the end of the step.

    The travel of a tool that is closed by a force is no stroke: the step ends where the sheet answers with this force.
    """
    steps = result["step"] if len(result) else np.empty(0)
    rows = np.flatnonzero(steps == step)
    if len(rows) == 0:
        return
    rows = rows if rows[0] == 0 else np.concatenate([[rows[0] - 1], rows])
    for control in model.controls:
        if not isinstance(control, ToolMotion) or control.tool.may_bottom:
            continue
        if any(press.way is control for press in control.tool.presses):
            continue
        at = bottoming(result[control.name][rows], result[f"{control.name}_force"][rows])
        if at is None or not bottoms(model, control.tool, found):
            continue
        text = (
            f"the tool {control.tool.name} bottoms at {control.name} = {at.at:.4g}: its force rises from "
            f"{at.before:.4g} to {at.largest:.4g}; a shorter stroke, or more clearance between the tools"
        )
        if text not in result.warnings:
            result.warn(text)

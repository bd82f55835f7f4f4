"""Open tools: their forces become a dead load, which can decrease to zero without contact. eq. (4.65)

An opened tool keeps its position and its history columns. It holds no point, its travel is prescribed, and its points
lose their friction history. docs/theory, 4.18
"""

from __future__ import annotations

import numpy as np

from umform.errors import InvalidValue
from umform.model.changes.removal import unbalanced
from umform.model.equations.evaluated import Evaluated
from umform.model.terms.dead_load import Load
from umform.model.tools.tool import Tool


def fading_tool(model: Evaluated, tool: Tool) -> Load:
    """The control of the forces that replace a tool once it is open; zero before."""
    if tool.load is None:
        name = model.controls.free_name(f"{tool.name}_left")
        tool.load = model.controls.add(Load(name, vector=np.zeros_like(model.u)))
    return tool.load


def open_tool(model: Evaluated, tool: Tool) -> Load:
    """Open a tool; its forces remain as a load of factor 1.

    Raises
    ------
    InvalidValue
        If the model does not have it, or it is already open.
    """
    if tool not in model.tools or tool.open:
        raise InvalidValue(
            "the model has no such tool that touches",
            where="remove()",
            value=tool.name,
            cause="it has been opened already, or belongs to another model",
            remedy="open a tool once; put_back() lets it touch again",
        )
    load = fading_tool(model, tool)
    load.value = 0.0
    tool.stay_open(True)
    try:
        load.vector = unbalanced(model)
    except BaseException:
        tool.stay_open(False)
        raise
    load.value = 1.0
    for press in tool.presses:
        press.force.value = 0.0
    return load


def put_tool_back(model: Evaluated, tool: Tool) -> None:
    """Close an opened tool again in its present pose; the friction history is lost.

    Raises
    ------
    InvalidValue
        If it is not open, its forces are not zero, or the sheet overlaps the tool.
    """
    if tool not in model.tools or not tool.open:
        raise InvalidValue(
            "the tool is not open",
            where="put_back()",
            value=tool.name,
            cause="it touches already, or belongs to another model",
            remedy="put back what a step Free has opened",
        )
    assert tool.load is not None
    deepest = max((-float(pair.gap_now(model.u).min(initial=0.0)) for pair in tool.pairs), default=0.0)
    if tool.load.value != 0.0 or model.ranks.max(deepest) > 0.0:
        raise InvalidValue(
            "a tool can touch again once its forces have faded and the sheet is clear of it",
            where=f"tool {tool.name}",
            value=f"{tool.load.name} = {tool.load.value:.6g}, the sheet is {deepest:.6g} inside",
            cause="the step that opens it has not come to its end, or the sheet has sprung to where it stands",
            remedy="finish the step; move the tool away from the sheet first",
        )
    for pair in tool.pairs:
        pair.forget_multipliers()
    tool.stay_open(False)

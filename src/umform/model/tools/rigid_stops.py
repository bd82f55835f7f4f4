"""Rigid stops of pressed tools: if one is active, its equation replaces the balance of the press.

Each iteration chooses the active stops from the signs; eqs. (4.140), (4.141).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from umform.model.terms.into import At, Into
from umform.model.terms.term import Found
from umform.model.tools.press import Press
from umform.model.tools.tool_controls import ToolWay


@dataclass(frozen=True)
class ToolFound(Found):
    """Result of the evaluation of a tool.

    Attributes
    ----------
    borne : dict of str to float
        Force of its rigid stop along the travel, by the name of the control of its press.
    """

    borne: Mapping[str, float] = field(default_factory=dict)


def bear(press: Press, at: At, into: Into) -> float | None:
    """Replace the balance of a press by the equation of a rigid stop, if one is active.

    Parameters
    ----------
    press : Press
        A press with rigid stops.
    at : At
        State of the evaluation.
    into : Into
        Its residual of the press is the sum of the other forces.

    Returns
    -------
    float or None
        Force of the stop on the tool along the travel.
    """
    border = into.border
    k, way = border.number(press.unknown), press.way
    rest = float(border.residual[k])
    measure = into.ranks.sum(sum(_stiffness(way, tool, at, into.found) for tool in way.tools)) or 1.0
    stop = press.bearing(at.values[way], rest, measure)
    if stop is None:
        return None
    border.residual[k], border.corner[k, k] = measure * (at.values[way] - stop), measure
    return rest


def _stiffness(way: ToolWay, tool: Any, at: At, found: Mapping[Any, Any]) -> float:
    """Stiffness of a tool that all points of this rank resist with their penalty."""
    share = 0.0
    for pair in tool.pairs:
        velocity = way.velocity(found[pair].x, tool, at)
        share += pair.penalty * float(found[pair].area @ (velocity**2).sum(axis=1))
    return share

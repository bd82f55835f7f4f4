"""Rigid stop that keeps a gap between a pressed tool and another one. eq. (4.142)"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

import numpy as np
from annotated_types import Gt
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.model.equations.evaluated import Evaluated
from umform.model.tools.press import Press
from umform.model.tools.tool import Tool
from umform.model.tools.tool_controls import ToolMotion
from umform.spec import About

Floats = NDArray[np.float64]

#: Distance of two tools.
Gap = Annotated[float, Gt(0.0), About(cause="a sign", remedy="the height of blocks")]
#: Smallest cosine between normals and travel for which two tools face each other.
_FACING = 0.999


def stop_at_gap(model: Evaluated, press: Press, to: Tool, gap: float) -> tuple[float, bool]:
    """Travel at which a pressed tool reaches a gap to another one, and whether it is a lower bound.

    Parameters
    ----------
    model : Model
        The model, with the tools in their present poses.
    press : Press
        The press of the moving tool along a direction.
    to : Tool
        The other tool.
    gap : float
        Smallest distance between both surfaces, over the sheet.

    Raises
    ------
    InvalidValue
        If no part of the sheet lies between them, they are already nearer, or one moves without the other.
    """
    where = _where(press, to)
    _check_together(press, to, where)
    ways = np.concatenate([np.empty((0, 2)), *_facing(model, press, to)])
    if len(ways) == 0:
        raise InvalidValue(
            "two tools that keep a gap face each other across the sheet, along the travel of the pressed one",
            where=where,
            value="no contact point of either has both tools on opposite sides",
            cause="another tool than the one behind the sheet, or a way that is not normal to it",
            remedy="stop(force, at=...) with its way at the stop",
        )
    distance, sense = ways[np.argmin(ways[:, 0])]
    if distance < gap:
        raise InvalidValue(
            "the tools are nearer to each other than the gap that they must keep",
            where=where,
            value=f"distance {distance:.6g}, gap {gap:.6g}",
            cause="the gap, or where a tool stands",
            remedy="a smaller gap, or a tool that starts farther away",
        )
    return press.way.value + sense * (distance - gap), sense < 0.0


def check_kept_gaps(model: Evaluated) -> None:
    """Refuse tools that keep a gap to another tool whose later motion they do not follow.

    Raises
    ------
    InvalidValue
        If there are such tools: the stop would not move with the other tool.
    """
    for press in (press for tool in model.tools for press in tool.presses):
        for to in press.gaps:
            _check_together(press, to, _where(press, to))


def _where(press: Press, to: Tool) -> str:
    return f"keep_gap, tool {press.way.tool.name} to {to.name}"


def _check_together(press: Press, to: Tool, where: str) -> None:
    own = press.way.tool
    alone = [way.name for way in to.ways if way not in own.ways] + (["a motion in time"] if to.motion else [])
    if not alone and own.motion is None and isinstance(press.way, ToolMotion):
        return
    raise InvalidValue(
        "a gap is kept along a direction, between tools that move together but for the press",
        where=where,
        value=", ".join(alone) or press.way.name,
        cause="the other tool has a way that this one does not follow, one moves in time, or a moment turns it",
        remedy=f"attach({own.name}, way) to the ways of tool {to.name} before keep_gap; a tool that is pressed along a "
        "direction",
    )


def _facing(model: Evaluated, press: Press, to: Tool) -> Iterator[Floats]:
    """Distance (k,) between both tools at points of the sheet, and the sign of the travel that closes it."""
    own = press.way.tool
    direction = np.asarray(press.way.direction)  # type: ignore[attr-defined]
    for pair in [*own.pairs, *to.pairs]:
        x = np.asarray(pair.locate(model.u, pair.pose).x)
        (gap, normal), (other_gap, other_normal) = _seen_from(own, x), _seen_from(to, x)
        along = normal @ direction
        facing = (np.einsum("nk,nk->n", normal, other_normal) < -_FACING) & (np.abs(along) > _FACING)
        distance = (gap + other_gap)[facing] / np.abs(along[facing])
        yield np.stack([distance, np.sign(along[facing])], axis=1)


def _seen_from(tool: Tool, x: Floats) -> tuple[Floats, Floats]:
    """Distance of points from a tool in its present pose, and the normals there."""
    rotation, shift = tool.pose_now
    gap, normal, _ = tool.kernel.gap(np.ascontiguousarray((x - shift) @ rotation))
    return gap, normal @ rotation.T

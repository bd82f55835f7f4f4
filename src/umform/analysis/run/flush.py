"""Pressed tools that stand flush with the sheet at the start of a run, but for the round-off of their coordinates."""

from __future__ import annotations

from umform.errors import ModelError
from umform.model import Model
from umform.model.tools.press import Press
from umform.model.tools.tool_controls import ToolMotion

#: Gap that is round-off of a drawing, and the overlap in its place, relative to the thickness of the sheet.
_FLUSH, _OVERLAP = 1e-6, 1e-9
#: Cosine between the travel and the normal of the tool, below which the tool slides along the sheet: 60 degrees.
_FACES = 0.5


def touch_flush_sheet(model: Model) -> None:
    """Move pressed tools onto the sheet where the gap is round-off. eq. (4.241)

    Without a single point in contact nothing answers the force, and the travel is undetermined. In some units the gap
    of a tool at the height of the sheet is zero, in others the last bit of a coordinate.
    """
    for press in (press for tool in model.tools for press in tool.presses):
        if not press.held and isinstance(press.way, ToolMotion):
            way = _way(model, press, press.way)
            press.unknown.value += way
            press.way.value += way


def _way(model: Model, press: Press, way: ToolMotion) -> float:
    """Travel that makes the nearest point overlap; zero if a tool touches, or is farther away."""
    nearest = (float("inf"), 0.0)
    for pair in (pair for tool in press.way.tools for pair in tool.pairs if len(pair.facets) > 0):
        try:
            at = pair.locate(model.u, pair.pose)
        except ModelError:  # the check of the model reports the details
            return 0.0
        if at.active.any():
            return 0.0
        point = int(at.gap.argmin())
        nearest = min(nearest, (float(at.gap[point]), float(at.normal[point] @ way.direction)))
    gap, along = nearest
    if not gap <= _FLUSH * model.system.thickness or abs(along) < _FACES:
        return 0.0
    return (gap + _OVERLAP * model.system.thickness) / along

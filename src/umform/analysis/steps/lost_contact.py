"""Messages about force-driven or sprung tools that lost contact with the sheet in an increment."""

from __future__ import annotations

from collections.abc import Mapping

from umform.model import Model
from umform.model.tools.press import Press

#: A row of the history.
Row = Mapping[str, float]


def lost_tools(model: Model, before: Row, now: Row) -> list[tuple[bool, str]]:
    """Messages about the tools that touched the sheet in one row of the history and do not in the next one.

    Parameters
    ----------
    model : Model
        The model at the state of the second row.
    before, now : mapping of str to float
        Two successive rows.

    Returns
    -------
    list of (bool, str)
        Whether a stop or a spring holds the tool as planned, and the message.
    """
    presses = [press for tool in model.tools for press in tool.presses if not press.held]
    lost = [press for press in presses if _points(press, before) > 0.0 == _points(press, now)]
    return [(bool(press.stiffness or press.stops), _message(press)) for press in lost]


def _points(press: Press, row: Row) -> float:
    """Points at which the tools of a press touch."""
    return sum(row[f"{pair.name}_active"] for tool in press.way.tools for pair in tool.pairs)


def _message(press: Press) -> str:
    what = f"{press.force.name} = {press.force.value:.6g}"
    held = "a spring holds it" if press.stiffness else "a stop holds it" if press.stops else "nothing else holds it"
    caught = press.stiffness or press.stops
    remedy = "" if caught else ": more force, a stop or a spring that follows the sheet, or Close() to bring it back"
    return (
        f"tool {press.way.tool.name}, pressed with {what}, has lost the sheet; {held} at {press.way.name} = "
        f"{press.way.value:.6g}{remedy}"
    )

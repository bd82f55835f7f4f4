"""Tools of a press brake from drawings or by name, as options of the command line."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from umform.cli.options import is_typed
from umform.errors import InvalidValue
from umform.processes.air_bending.spec import sizes_of

if TYPE_CHECKING:
    from umform.processes.air_bending.drawn_tools import DrawnDie, DrawnPunch


def drawn_tools(
    context: typer.Context, punch: Path | None, punch_layer: str | None, die: Path | None, die_layer: str | None
) -> dict[str, Any]:
    """Punch and die from drawings, as parameters of air bending.

    Parameters
    ----------
    context : typer.Context
        Tells which options were given by hand.
    punch, die : Path or None
        DXF drawings.
    punch_layer, die_layer : str or None
        The layers with the sections.

    Raises
    ------
    InvalidValue
        If a number is given beside the drawing that it follows from, or a layer without a drawing.
    FileProblem, OpenSection
        If a drawing cannot be read, or has no such tool.
    """
    for name, path, layer in (("punch_dxf", punch, punch_layer), ("die_dxf", die, die_layer)):
        _refuse_both(context, name, path, layer)
    found: dict[str, DrawnPunch | DrawnDie] = {}
    if punch is None and die is None:
        return found
    from umform.processes.air_bending.drawn_tools import read_die, read_punch

    if punch is not None:
        found["punch_section"] = read_punch(punch, punch_layer)
    if die is not None:
        found["die_section"] = read_die(die, die_layer)
    return found


def named_tools(context: typer.Context, given: dict[str, Any], punch: str | None, die: str | None) -> dict[str, Any]:
    """The given values with the sizes of usual tools.

    Parameters
    ----------
    context : typer.Context
        Tells which options were given by hand.
    given : dict of str to object
        Values of the options.
    punch, die : str or None
        Names of `umform tools`.

    Raises
    ------
    InvalidValue
        If no tool has the name, or a size is given beside it.
    """
    found = dict(given)
    for kind, name in (("punch", punch), ("die", die)):
        if name is None:
            continue
        from umform.processes.air_bending.usual_tools import usual_tool

        try:
            sizes = usual_tool(kind, name).sizes
        except InvalidValue as error:
            error.where = f"--{kind}"
            raise
        _refuse_beside(context, (*sizes, f"{kind}_dxf"), "this size follows from the name of the tool", f"--{kind}")
        found |= sizes
    return found


def _refuse_both(context: typer.Context, name: str, path: Path | None, layer: str | None) -> None:
    flag = "--" + name.replace("_", "-")
    if path is None and layer is not None:
        raise InvalidValue(
            "a layer without its drawing",
            where="umform bend",
            value=layer,
            cause=f"{flag} is missing",
            remedy=f"{flag} FILE",
        )
    if path is not None:
        others = sizes_of(name.partition("_")[0]).values()
        _refuse_beside(context, others, "this number follows from the drawing of the tool", flag)


def _refuse_beside(context: typer.Context, others: Iterable[str], what: str, flag: str) -> None:
    """Refuse options on the command line that follow from another one."""
    for other in others:
        if is_typed(context, other):
            raise InvalidValue(
                what,
                where=f"--{other.replace('_', '-')}",
                value=context.params[other],
                cause=f"it is given beside {flag}",
                remedy="leave one of them out",
            )

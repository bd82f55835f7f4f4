"""Tools of a press brake from drawings, as options of the command line."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

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
    for other in sizes_of(name.partition("_")[0]).values() if path is not None else ():
        source = context.get_parameter_source(other)
        if source is not None and source.name == "COMMANDLINE":
            raise InvalidValue(
                "this number follows from the drawing of the tool",
                where=f"--{other.replace('_', '-')}",
                value=context.params[other],
                cause=f"it is given beside {flag}",
                remedy="leave one of them out",
            )

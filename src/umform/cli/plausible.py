"""Plausibility of the sheet of a process before its runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from umform.model import Model
    from umform.processes.air_bending.spec import AirBending


def refuse_implausible(model: Model, *, force: bool | None = None) -> None:
    """Refuse numbers that are certainly wrong, and warn of unusual ones.

    Parameters
    ----------
    model : Model
        The sheet in its tools.
    force : bool, optional
        Warn only; None where no option --force does it.

    Raises
    ------
    DeckError
        With what to change.
    """
    from umform.problem.findings import accept
    from umform.problem.plausible import of_model

    for warning in accept(of_model(model, millimetres=True), force=force):
        typer.echo(f"umform: {warning}", err=True)


def refuse_implausible_bend(case: AirBending, *, force: bool | None = None) -> None:
    """The same of the sheet in the tools of a bend."""
    from umform.processes.air_bending.problem import build

    refuse_implausible(build(case)[0], force=force)

"""Options of several commands, and their panels in the help."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from umform.errors import InvalidValue

#: Panels.
SHEET, SOLUTION = "Sheet", "Solution"


def option(help_text: str, panel: str, *names: str) -> Any:
    """An option with its panel in the help."""
    return typer.Option(*names, help=help_text, rich_help_panel=panel)


def is_typed(context: typer.Context, name: str) -> bool:
    """Whether an option stands on the command line."""
    source = context.get_parameter_source(name)
    return source is not None and source.name == "COMMANDLINE"


def check_idle(context: typer.Context, **needed: tuple[bool, str]) -> None:
    """Refuse options on the command line that do nothing, because what they belong to is missing.

    Parameters
    ----------
    context : typer.Context
        Tells which options were given by hand.
    **needed : tuple of bool and str
        For an option, whether what it belongs to is given, and its name.
    """
    for one in context.command.params:
        if one.name in needed and not needed[one.name][0] and is_typed(context, one.name):
            owner = needed[one.name][1]
            raise InvalidValue(
                f"the option does nothing without {owner}",
                where=one.opts[0],
                value=context.params[one.name],
                cause=f"{owner} is missing",
                remedy=f"{owner} beside it, or leave it out",
            )


All = Annotated[
    bool,
    typer.Option("--all", help="Print all numbers, the source of the metal, penetrations and balance of the run."),
]
PrintDeck = Annotated[
    bool, typer.Option("--print-deck", help="Print the problem as a deck for `umform run`, and run nothing else.")
]


def print_deck(case: Any) -> None:
    """Print the problem of a case as a deck."""
    from umform.processes.problems import problem_of

    typer.echo(problem_of(case).toml(), nl=False)

"""Options of several commands, and their panels in the help."""

from __future__ import annotations

from typing import Annotated, Any

import typer

#: Panels.
SHEET, SOLUTION = "Sheet", "Solution"


def option(help_text: str, panel: str, *names: str) -> Any:
    """An option with its panel in the help."""
    return typer.Option(*names, help=help_text, rich_help_panel=panel)


def is_typed(context: typer.Context, name: str) -> bool:
    """Whether an option stands on the command line."""
    source = context.get_parameter_source(name)
    return source is not None and source.name == "COMMANDLINE"


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

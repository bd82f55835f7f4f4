"""Options of the command line: their panels in the help, and the options of the sheet."""

from __future__ import annotations

from pathlib import Path
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


Material = Annotated[
    str | None,
    option(
        "Name in the library of sheet metals (`umform metal list`), or a file such as fit/metal.toml.",
        SHEET,
        "--material",
        "-m",
    ),
]
Young = Annotated[float | None, option("Young's modulus in MPa.", SHEET)]
Poisson = Annotated[float | None, option("Poisson's ratio.", SHEET)]
Yield = Annotated[float | None, option("Yield stress in MPa, for linear hardening.", SHEET)]
Modulus = Annotated[float | None, option("Hardening modulus in MPa; default 0.", SHEET)]
Curve = Annotated[
    str | None,
    option(
        "Hardening curve, such as Swift,520,0.004,0.22 or Voce,180,330,14, in MPa; numbers alone are those of Swift.",
        SHEET,
        "--curve",
        "--swift",
    ),
]
FlowCurve = Annotated[Path | None, option("Measured hardening: a CSV file of plastic strain and true stress.", SHEET)]
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
